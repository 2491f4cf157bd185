"""``muster bench activity``: recognition of the wearer's activity by the unit."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Annotated, Any, TypeVar

import typer
from rich.console import Console
from rich.progress import track as progress_bar
from rich.table import Table

from edge.simulation.factory import open_simulation
from edge.sources.recording import RecordingSource, read_truth
from shared.bench_figures import FiguresFile, write_figures
from shared.messages import Activity
from tests.bench.tracker.activity_scoring import (
    ActivityScore,
    Confusion,
    kinds_in,
    recorded_label,
    score_activity,
)
from tests.bench.tracker.track import find_trials

T = TypeVar("T")

# Scenarios that hold every activity, and how much of each is played.
_SCENARIOS = (
    ("gaits", 600.0),
    ("stairs", 600.0),
    ("gets-hot", 100.0),
    ("goes-down", 60.0),
    ("search-ground-floor", 100.0),
)


def bench_activity(
    data: Annotated[
        Path | None,
        typer.Argument(help="A folder of trials, such as shared/data/walks; without: simulated."),
    ] = None,
    json_file: FiguresFile = None,
    first_seed: Annotated[
        int, typer.Option(min=0, help="First seed of the simulated wearers.")
    ] = 10,
    seeds: Annotated[int, typer.Option(min=1, max=1000, help="Number of wearers.")] = 5,
) -> None:
    """Measure the activities that units report, on simulated and recorded wearers.

    The thresholds were set on the seeds 0 to 2, which are not among the default ones.
    """
    console = Console(width=max(Console().width, 130))
    report = {"simulated": _simulated(first_seed, seeds)}
    if data is not None:
        report |= _recorded(data)
    for title, score in report.items():
        console.print(_table(f"{title}, settled", score.settled))
        console.print(_table(f"{title}, every instant", score.every))
        console.print(
            f"{score.falls_reported} falls reported, {score.falls_done} labelled, in "
            f"{score.duration_s / 60.0:.1f} minutes\n"
        )
    write_figures(json_file, {title: _as_json(score) for title, score in report.items()})


def _simulated(first_seed: int, seeds: int) -> ActivityScore:
    score = ActivityScore()
    plays = [
        (name, until_s, seed)
        for name, until_s in _SCENARIOS
        for seed in range(first_seed, first_seed + seeds)
    ]
    for name, until_s, seed in _progress(plays, "Simulating"):
        simulation = open_simulation(f"{name}?seed={seed}")
        score_activity(
            simulation.batches(), simulation.description, simulation.activity, until_s, score
        )
    return score


def _recorded(data: Path) -> dict[str, ActivityScore]:
    """By dataset, those trials whose reference has times."""
    scores: dict[str, ActivityScore] = {}
    for path in _progress(find_trials(data), "Playing"):
        truth = read_truth(path)
        if truth is None:
            continue
        source = RecordingSource(path)
        label = recorded_label(truth, sampled=source.trial.truth_kind == "motion_capture")
        score = scores.setdefault(source.trial.dataset or path.parent.name, ActivityScore())
        score_activity(source.batches(), source.description, label, float("inf"), score)
    return scores


def _progress(items: Sequence[T], description: str) -> Iterable[T]:
    return progress_bar(
        items, description=description, console=Console(stderr=True), transient=True
    )


def _table(title: str, confusion: Confusion) -> Table:
    kinds = kinds_in([confusion])
    table = Table(title=f"{title}: {100.0 * confusion.accuracy:.1f} % right")
    table.add_column("done \\ reported")
    for kind in kinds:
        table.add_column(_name(kind), justify="right")
    table.add_column("% right", justify="right")
    for done in kinds:
        if not confusion.of(done):
            continue
        counts = (confusion.counts.get((done, reported), 0) for reported in kinds)
        cells = (str(count) if count else "" for count in counts)
        table.add_row(_name(done), *cells, f"{100.0 * confusion.recall(done):.1f}")
    return table


def _name(kind: Activity) -> str:
    return kind.name.lower().replace("_", " ")


def _as_json(score: ActivityScore) -> dict[str, Any]:
    def matrix(confusion: Confusion) -> dict[str, Any]:
        kinds = kinds_in([confusion])
        done_kinds = [kind for kind in kinds if confusion.of(kind)]
        return {
            "accuracy": confusion.accuracy,
            "recall": {_name(done): confusion.recall(done) for done in done_kinds},
            "counts": {
                _name(done): {
                    _name(reported): confusion.counts[done, reported]
                    for reported in kinds
                    if (done, reported) in confusion.counts
                }
                for done in done_kinds
            },
        }

    return {
        "settled": matrix(score.settled),
        "every_instant": matrix(score.every),
        "falls_labelled": score.falls_done,
        "falls_reported": score.falls_reported,
        "duration_s": score.duration_s,
    }
