"""``muster bench track --perturbed``: does anything blow up silently?

Every trial is tracked once as recorded and once with each perturbation.  A result is right
when its error is at most three times the one as recorded (or a decimetre).  Otherwise the
tracker must say so: by the quality of its rows, or by an ellipse that holds the truth.  A
result that is wrong and does not say so is silent.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.progress import track as progress_bar
from rich.table import Table

from edge.sources.recording import RecordedTruth, RecordingSource, read_truth
from edge.tracker.interface import Quality, TrackBatch
from edge.tracker.registry import make_tracker
from edge.tracker.track_rows import join_rows
from tests.bench.tracker.perturbations import PERTURBATIONS, Perturbation
from tests.bench.tracker.scoring import CHI2_95_2DOF, Score, horizontal_nees, score_track

RIGHT_RATIO = 3.0
RIGHT_M = 0.1
FLAGGED_SHARE = 0.05  # of the rows
HELD_SHARE = 0.8  # of the reference points in the stated 95 % ellipse
MOVED_M = 0.1  # a closed walk that lost more than this of its beginning does not close


@dataclass(frozen=True, slots=True)
class Outcome:
    """One trial under one perturbation."""

    perturbation: str
    dataset: str
    trial: str
    error_m: float  # ATE, or the closure of a closed walk
    right: bool
    flagged: bool  # by the quality, or the truth is in the stated ellipse

    @property
    def silent(self) -> bool:
        return not self.right and not self.flagged


def score_perturbed(trials: Sequence[Path], tracker: str) -> list[Outcome]:
    """Track every trial folder with every perturbation."""
    outcomes: list[Outcome] = []
    for path in progress_bar(
        trials, description="Perturbing", console=Console(stderr=True), transient=True
    ):
        outcomes.extend(_outcomes(path, tracker))
    return outcomes


def _outcomes(path: Path, tracker: str) -> Iterator[Outcome]:
    source, truth = RecordingSource(path), read_truth(path)
    closed_loop = source.trial.truth_kind == "closed_loop"
    clean_m = 0.0
    whole: TrackBatch | None = None
    for perturbation in PERTURBATIONS:
        rows, seen = _track(source, truth, perturbation, tracker)
        if whole is None:
            whole = rows
        elif truth is None and _moved_before_m(whole, int(rows.t_ns[0])) > MOVED_M:
            continue
        score = score_track(rows, seen, closed_loop=closed_loop)
        error_m = score.closure_horizontal_m if score.ate_m is None else score.ate_m
        if whole is rows:
            clean_m = error_m
        yield Outcome(
            perturbation=perturbation.name,
            dataset=source.trial.dataset or path.parent.name,
            trial=source.trial.trial or path.name,
            error_m=error_m,
            right=error_m <= max(RIGHT_RATIO * clean_m, RIGHT_M),
            flagged=_is_flagged(rows, score),
        )


def _track(
    source: RecordingSource,
    truth: RecordedTruth | None,
    perturbation: Perturbation,
    tracker: str,
) -> tuple[TrackBatch, RecordedTruth | None]:
    """Return the rows of the perturbed samples, and the truth as far as it has samples."""
    rng = np.random.default_rng(zlib.crc32(f"{perturbation.name} {source.trial.trial}".encode()))
    description, imu = perturbation.apply(source.description, source.imu, rng)
    tracking = make_tracker(tracker, description)
    rows = join_rows([tracking.push(imu), tracking.finish()])
    if truth is None:
        return rows, None
    known = truth.t_s >= rows.t_ns[0] * 1e-9
    return rows, RecordedTruth(truth.t_s[known], truth.position_n_m[known])


def _moved_before_m(rows: TrackBatch, t_ns: int) -> float:
    at = int(np.searchsorted(rows.t_ns, t_ns))
    return float(np.linalg.norm(rows.position_n_m[min(at, len(rows) - 1), :2]))


def _is_flagged(rows: TrackBatch, score: Score) -> bool:
    if np.mean(rows.quality != Quality.GOOD) >= FLAGGED_SHARE:
        return True
    if score.coverage_95_from_start is not None:
        return score.coverage_95_from_start >= HELD_SHARE
    ends = rows.position_n_m[[0, -1]]
    nees = horizontal_nees(ends[1:], ends[:1], rows.position_cov_m2[-1:])
    return bool(nees[0] <= CHI2_95_2DOF)


def perturbed_table(outcomes: Sequence[Outcome]) -> Table:
    """Mean error by dataset, and how many trials are right, wrong and flagged, wrong and silent."""
    datasets = list(dict.fromkeys(outcome.dataset for outcome in outcomes))
    table = Table(title="Perturbed: mean error, m; trials right / flagged / silent")
    table.add_column("perturbation")
    for title in (*datasets, "right", "flagged", "silent"):
        table.add_column(title, justify="right")
    for name in dict.fromkeys(outcome.perturbation for outcome in outcomes):
        members = [outcome for outcome in outcomes if outcome.perturbation == name]
        cells = []
        for dataset in datasets:
            errors_m = [outcome.error_m for outcome in members if outcome.dataset == dataset]
            cells.append(f"{np.mean(errors_m):.3f}" if errors_m else "")
        right = sum(outcome.right for outcome in members)
        silent = sum(outcome.silent for outcome in members)
        counts = (right, len(members) - right - silent, silent)
        table.add_row(name, *cells, *(str(count) for count in counts))
    return table
