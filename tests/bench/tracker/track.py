"""``muster bench track``: errors and speed of the tracker on recorded walks."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Annotated

import typer
from rich import box
from rich.console import Console
from rich.progress import track as progress_bar
from rich.table import Table

from edge.app.track import run_tracker
from edge.sources.recording import RecordingSource, read_truth
from edge.tracker.interface import FOOT
from edge.tracker.registry import TRACKERS, find_tracker
from shared.bench_figures import FiguresFile, write_figures
from shared.errors import UserError
from tests.bench.tracker.body_recordings import elsewhere_table, measure_elsewhere
from tests.bench.tracker.cross_validation import cross_validate, left_out_table
from tests.bench.tracker.hard_motions import hard_motions_table, measure_hard_motions
from tests.bench.tracker.honesty import honesty_table, measure_honesty
from tests.bench.tracker.perturbed_walks import perturbed_table, score_perturbed
from tests.bench.tracker.scoring import Score, score_track
from tests.bench.tracker.several_sensors import (
    gait_events_table,
    measure_gait_events,
    measure_returns,
    returns_table,
)
from tests.bench.tracker.simulated_body_sensors import (
    measure_simulated_elsewhere,
    scenarios_table,
    simulated_elsewhere_table,
)
from tests.bench.tracker.simulated_walks import score_simulated, simulated_walks
from tests.bench.tracker.speed import measure_speed, print_speed
from tests.bench.tracker.wearers import measure_wearers, wearers_table


@dataclass(frozen=True, slots=True)
class TrialScore:
    dataset: str
    trial: str
    score: Score


@dataclass(frozen=True, slots=True)
class Column:
    """One figure of the table: its title, where it is in a score, its decimals."""

    title: str
    field: str
    decimals: int


COLUMNS = (
    Column("walked", "distance_m", 1),
    Column("closure", "closure_horizontal_m", 3),
    Column("down", "closure_vertical_m", 3),
    Column("ATE", "ate_m", 3),
    Column("ARMSE", "armse_2d_m", 4),
    Column("%", "per_cent_of_distance", 2),
    Column("height", "vertical_rms_m", 3),
    Column("in 95 %", "coverage_95", 3),
    Column("held", "coverage_95_from_start", 3),
    Column("up", "coverage_95_vertical", 3),
    Column("stated", "stated_by_error", 1),
    Column("silent", "silently_wrong", 3),
    Column("lost", "lost", 2),
)
UNITS = """metres; % of the distance walked; height: vertical RMS; in 95 %: share of the truth in
the stated 95 % ellipse, the track fitted to the truth, or held at its start; up: share of the
heights in the stated 95 % interval; stated: RMS stated by RMS error, start held; silent: share
over three stated regions off with quality good; lost: share of the rows that are flagged so"""
WIDTH = 140  # that the tables need


SimulatedOption = Annotated[
    bool,
    typer.Option(
        "--simulated", help="Also score the document's walks and hard motions, simulated."
    ),
]
SpeedOption = Annotated[
    bool, typer.Option("--speed", help="Also measure samples per second and live latency.")
]
PerturbedOption = Annotated[
    bool, typer.Option("--perturbed", help="Also track every trial with worse sensors (a minute).")
]
HonestyOption = Annotated[
    bool,
    typer.Option("--honesty", help="Also compare what is stated of simulated walks (minutes)."),
]
WearersOption = Annotated[
    bool,
    typer.Option("--wearers", help="Also track simulated wearers that nobody recorded (minutes)."),
]
ElsewhereOption = Annotated[
    Path | None,
    typer.Option(
        "--elsewhere",
        help="Folder with body/ipol and phones: also compare the trackers that are not for a foot, "
        "or for several sensors.",
    ),
]
SimulatedElsewhereOption = Annotated[
    bool,
    typer.Option(
        "--simulated-elsewhere",
        help="Also compare the trackers that are not for a foot on half a simulated minute of "
        "every scenario (minutes).",
    ),
]
LeftOutOption = Annotated[
    bool, typer.Option("--cross-validate", help="Also leave each dataset out once (a minute).")
]


def bench_track(
    data: Annotated[
        list[Path],
        typer.Argument(
            help="Folders of trials, such as shared/data/walks; of several each is shown apart, "
            "and the options that track trials again take the first."
        ),
    ],
    json_file: FiguresFile = None,
    tracker: Annotated[
        str, typer.Option(help="One of: " + ", ".join(entry.name for entry in TRACKERS) + ".")
    ] = TRACKERS[0].name,
    simulated: SimulatedOption = False,
    speed: SpeedOption = False,
    perturbed: PerturbedOption = False,
    honesty: HonestyOption = False,
    wearers: WearersOption = False,
    cross_validation: LeftOutOption = False,
    elsewhere: ElsewhereOption = None,
    simulated_elsewhere: SimulatedElsewhereOption = False,
) -> None:
    """Measure the errors of every trial below DATA: closure, ATE, ARMSE, heights, honesty of the
    uncertainty.
    """
    console = Console(width=max(Console().width, WIDTH))
    sets = {folder: find_trials(folder) for folder in data}
    first = next(iter(sets.values()))
    scores = _scores(sets, tracker, simulated)
    console.print(trial_table(scores))
    console.print(summary_table(scores))
    report: dict[str, object] = {
        "tracker": tracker,
        "trials": [{"dataset": s.dataset, "trial": s.trial, **asdict(s.score)} for s in scores],
        "datasets": summarise(scores),
    }
    if simulated and FOOT in find_tracker(tracker).worn_on:
        hard = measure_hard_motions(tracker)
        console.print(hard_motions_table(hard))
        report["hard_motions"] = [asdict(one) for one in hard]
    if speed:
        report["speed"] = _speed(first[0], tracker, console)
    if perturbed:
        report["perturbed"] = _perturbed(first, tracker, console)
    if honesty:
        results = measure_honesty()
        console.print(honesty_table(results))
        report["honesty"] = [asdict(result) for result in results]
    if wearers:
        worn = measure_wearers()
        console.print(wearers_table(worn))
        report["wearers"] = [asdict(one) for one in worn]
    if cross_validation:
        left_out = cross_validate(first)
        console.print(left_out_table(left_out))
        report["cross_validation"] = [asdict(entry) for entry in left_out]
    if elsewhere is not None:
        compared = measure_elsewhere(elsewhere)
        console.print(elsewhere_table(compared))
        report["elsewhere"] = [asdict(one) for one in compared]
        returns = measure_returns(elsewhere)
        console.print(returns_table(returns))
        report["several_sensors"] = [asdict(one) for one in returns]
        events = measure_gait_events(elsewhere)
        console.print(gait_events_table(events))
        report["gait_events"] = [asdict(one) for one in events]
    if simulated_elsewhere:
        places = measure_simulated_elsewhere()
        console.print(simulated_elsewhere_table(places))
        console.print(scenarios_table(places))
        report["simulated_elsewhere"] = [asdict(one) for one in places]
    write_figures(json_file, report)


def _scores(sets: Mapping[Path, Sequence[Path]], tracker: str, simulated: bool) -> list[TrialScore]:
    scorings = [
        partial(score_trial, path, tracker, of=folder.resolve().name if len(sets) > 1 else "")
        for folder, trials in sets.items()
        for path in trials
    ]
    if simulated:
        scorings += [partial(score_simulation, walk, tracker) for walk in simulated_walks(tracker)]
    return [
        scoring()
        for scoring in progress_bar(
            scorings, description="Scoring", console=Console(stderr=True), transient=True
        )
    ]


def _speed(trial: Path, tracker: str, console: Console) -> dict[str, object]:
    figures = measure_speed(RecordingSource(trial), tracker)
    print_speed(console, figures)
    return asdict(figures)


def _perturbed(trials: Sequence[Path], tracker: str, console: Console) -> list[dict[str, object]]:
    outcomes = score_perturbed(trials, tracker)
    console.print(perturbed_table(outcomes))
    for outcome in outcomes:
        if outcome.silent:
            console.print(
                f"silent: {outcome.perturbation}, {outcome.dataset} {outcome.trial}, "
                f"{outcome.error_m:.2f} m"
            )
    return [asdict(outcome) for outcome in outcomes]


def find_trials(data: Path) -> list[Path]:
    """Return every folder at or below ``data`` with samples in it; ``UserError`` if none."""
    trials = sorted({path.parent for path in data.rglob("imu.csv*")})
    if not trials:
        raise UserError(f"no imu.csv.gz or imu.csv below {data}; give a folder of trials")
    return trials


def score_trial(path: Path, tracker: str, of: str = "") -> TrialScore:
    """Run one trial folder through a tracker, in its source's batches, and score it.

    ``of``: the set that its dataset is named by, where there are several.
    """
    source = RecordingSource(path)
    dataset = source.trial.dataset or path.parent.name
    rows = run_tracker(source, tracker, quiet=True)
    closed_loop = source.trial.truth_kind == "closed_loop"
    return TrialScore(
        dataset=f"{of}/{dataset}" if of else dataset,
        trial=source.trial.trial or path.name,
        score=score_track(rows, read_truth(path), closed_loop=closed_loop),
    )


def score_simulation(walk: str, tracker: str) -> TrialScore:
    return TrialScore("simulated", walk, score_simulated(walk, tracker))


def trial_table(scores: Iterable[TrialScore]) -> Table:
    table = _table("Trials", "trial")
    for entry in scores:
        values = (getattr(entry.score, column.field) for column in COLUMNS)
        table.add_row(entry.dataset, entry.trial, *_cells(values))
    return table


def _table(title: str, second: str) -> Table:
    table = Table(title=title, caption=UNITS, caption_justify="left", box=box.SIMPLE_HEAD)
    table.collapse_padding = True
    for name in ("dataset", second):
        table.add_column(name, no_wrap=True)
    for column in COLUMNS:
        table.add_column(column.title, justify="right", no_wrap=True)
    return table


def _cells(values: Iterable[float | None]) -> Iterator[str]:
    for value, column in zip(values, COLUMNS, strict=True):
        yield "" if value is None else f"{value:.{column.decimals}f}"


def summarise(scores: Sequence[TrialScore]) -> dict[str, dict[str, dict[str, float]]]:
    """Return mean, median and worst of every figure that a dataset has, by dataset."""
    summary: dict[str, dict[str, dict[str, float]]] = {}
    for dataset in dict.fromkeys(entry.dataset for entry in scores):
        members = [entry.score for entry in scores if entry.dataset == dataset]
        summary[dataset] = {}
        for column in COLUMNS:
            values = [getattr(score, column.field) for score in members]
            known = [value for value in values if value is not None]
            if known:
                worst: Callable[[list[float]], float] = (
                    min if column.field.startswith("coverage") else max
                )
                summary[dataset][column.field] = {
                    "mean": statistics.fmean(known),
                    "median": statistics.median(known),
                    "worst": worst(known),
                }
    return summary


def summary_table(scores: Sequence[TrialScore]) -> Table:
    table = _table("Datasets", "of trials")
    for dataset, figures in summarise(scores).items():
        for statistic in ("mean", "median", "worst"):
            values = (figures.get(column.field, {}).get(statistic) for column in COLUMNS)
            table.add_row(dataset, statistic, *_cells(values), end_section=statistic == "worst")
    return table
