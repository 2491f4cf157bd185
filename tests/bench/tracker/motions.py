"""``muster bench motions``: error of each kind of motion with constants tuned without it.

One kind of motion is taken out of all walks, recorded and simulated.  The constants in ``TUNED``
are
tuned on the walks that are left, from the shipped values on: each is halved and doubled, and what
makes the mean error smaller is kept, the largest gain first.  Then the kind that was left out is
scored, with the tuned and with the shipped constants.  Where the tuned ones do worse, the figures
of that kind owe as much to its being in the data.

Every kind has the same weight, whatever the number of its walks, and no error below a centimetre
counts.  Constants that make more walks silently wrong than the shipped ones are not taken.
"""

from __future__ import annotations

import statistics
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from rich.console import Console
from rich.progress import track as progress_bar
from rich.table import Table

from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.eskf import EskfTracker
from edge.tracker.track_rows import join_rows
from shared.bench_figures import FiguresFile, write_figures
from tests.bench.tracker.constant_walks import Walk, hard_walks, recorded_walks, score_walk
from tests.bench.tracker.constants import FACTORS, LEAST_ERROR_M, WIDTH, changed
from tests.bench.tracker.motion_kinds import motion_of

# Of those that move errors most when they are halved or doubled (``muster bench constants``).
TUNED = (
    "detection.half_window_s",
    "detection.rate_weight_m2ps2",
    "detection.stride_past_s",
    "detection.threshold_ratio",
    "detection.threshold_max_m2ps4",
    "acceptance.slow_swing_mps",
    "acceptance.unlike_ratio",
    "zupt.glide_gate",
    "zupt.stance_velocity_per_motion",
    "process.accel_noise_mps2_rthz",
    "process.gyro_noise_radps_rthz",
)
MOST_CHANGES = 4  # constants that one tuning takes

Changes = Mapping[str, float]  # constant -> factor on its shipped value


@dataclass(frozen=True, slots=True)
class Outcome:
    """One walk with one set of constants."""

    error_m: float  # horizontal: ATE, or closure where only that is known
    covered: float | None  # share of points in the stated 95 % ellipse, held at the start
    stated_by_error: float | None
    silent: bool  # any row is silently wrong


@dataclass(frozen=True, slots=True)
class LeftOutMotion:
    """One kind of motion, scored by constants that were tuned without it."""

    motion: str
    walks: int
    changes: dict[str, float]
    shipped: list[Outcome]
    tuned: list[Outcome]


class Study:
    """Walks by kind of motion, tracked with any constants, each once."""

    def __init__(self, walks: Mapping[str, Sequence[Walk]]) -> None:
        self._walks = walks
        self._known: dict[tuple[frozenset[tuple[str, float]], str], list[Outcome]] = {}

    @property
    def motions(self) -> list[str]:
        return list(self._walks)

    def outcomes(self, changes: Changes, motion: str) -> list[Outcome]:
        """Return the outcome of each walk of a motion."""
        key = (frozenset(changes.items()), motion)
        if key not in self._known:
            config = changed_config(changes)
            self._known[key] = [_outcome(walk, config) for walk in self._walks[motion]]
        return self._known[key]

    def loss(self, changes: Changes, motions: Sequence[str]) -> tuple[int, float]:
        """Return how many walks are silently wrong, and the mean log error, over ``motions``."""
        by_motion = [self.outcomes(changes, motion) for motion in motions]
        silent = sum(one.silent for outcomes in by_motion for one in outcomes)
        return silent, statistics.fmean(mean_log_error(outcomes) for outcomes in by_motion)


def bench_motions(
    data: Annotated[
        Path, typer.Argument(help="Folder with walks, hard and body/ipol, such as shared/data.")
    ],
    json_file: FiguresFile = None,
) -> None:
    """Measure the error of each kind of motion with constants that were tuned without it."""
    walks: dict[str, list[Walk]] = {}
    for walk in (*recorded_walks(data), *hard_walks()):
        walks.setdefault(motion_of(walk), []).append(walk)
    results = leave_each_out(Study(walks))
    console = Console(width=max(Console().width, WIDTH))
    console.print(left_out_table(results))
    write_figures(json_file, {"left_out": [asdict(one) for one in results]})


def changed_config(changes: Changes) -> EskfConfig:
    config = EskfConfig()
    for constant, factor in changes.items():
        config = changed(constant, factor, config)
    return config


def leave_each_out(study: Study) -> list[LeftOutMotion]:
    """Leave each motion out once."""
    bar = progress_bar(
        study.motions, description="Leaving out", console=Console(stderr=True), transient=True
    )
    return [_leave_out(study, motion) for motion in bar]


def _leave_out(study: Study, motion: str) -> LeftOutMotion:
    changes = tune(study, [kept for kept in study.motions if kept != motion])
    shipped, tuned = study.outcomes({}, motion), study.outcomes(changes, motion)
    return LeftOutMotion(motion, len(shipped), dict(changes), shipped, tuned)


def tune(study: Study, motions: Sequence[str]) -> Changes:
    """Return the changes, at most ``MOST_CHANGES``, that do best on ``motions``."""
    shipped = study.loss({}, motions)
    singles = [(constant, factor) for constant in TUNED for factor in FACTORS]
    better = sorted(
        (loss[1], constant, factor)
        for constant, factor in singles
        if (loss := study.loss({constant: factor}, motions))[0] <= shipped[0]
        and loss[1] < shipped[1]
    )
    chosen: dict[str, float] = {}
    best = shipped[1]
    for _, constant, factor in better:
        if constant in chosen or len(chosen) == MOST_CHANGES:
            continue
        silent, error = study.loss(chosen | {constant: factor}, motions)
        if silent <= shipped[0] and error < best:
            chosen[constant], best = factor, error
    return chosen


def mean_log_error(outcomes: Sequence[Outcome]) -> float:
    return float(np.mean([np.log(max(one.error_m, LEAST_ERROR_M)) for one in outcomes]))


def _outcome(walk: Walk, config: EskfConfig) -> Outcome:
    tracker = EskfTracker(walk.description, config)
    score = score_walk(walk, join_rows([tracker.push(walk.imu), tracker.finish()]))
    return Outcome(
        error_m=score.closure_horizontal_m if score.ate_m is None else score.ate_m,
        covered=score.coverage_95_from_start,
        stated_by_error=score.stated_by_error,
        silent=bool(score.silently_wrong),
    )


def left_out_table(results: Sequence[LeftOutMotion]) -> Table:
    """Return a row for each motion: shipped constants, then those tuned without it."""
    table = Table(
        title="Each kind of motion by constants that were tuned without it",
        caption="shipped -> tuned; error: geometric mean, m; worst: m; covered: mean share in the "
        "stated 95 % ellipse, held at the start; stated: median of stated by error; silent: walks",
    )
    table.add_column("left out")
    table.add_column("walks", justify="right")
    table.add_column("the others choose")
    for title in ("error", "worst", "covered, %", "stated", "silent"):
        table.add_column(title, justify="right")
    for one in results:
        chosen = ", ".join(
            f"{constant.partition('.')[2]} x {factor:g}" for constant, factor in one.changes.items()
        )
        pairs = zip(_figures(one.shipped), _figures(one.tuned), strict=True)
        table.add_row(
            one.motion, str(one.walks), chosen or "the shipped", *(" -> ".join(p) for p in pairs)
        )
    return table


def _figures(outcomes: Sequence[Outcome]) -> tuple[str, ...]:
    covered = [one.covered for one in outcomes if one.covered is not None]
    stated = [one.stated_by_error for one in outcomes if one.stated_by_error is not None]
    return (
        f"{np.exp(mean_log_error(outcomes)):.3f}",
        f"{max(one.error_m for one in outcomes):.2f}",
        f"{100.0 * float(np.mean(covered)):.0f}" if covered else "-",
        f"{float(np.median(stated)):.1f}" if stated else "-",
        str(sum(one.silent for one in outcomes)),
    )
