"""Several sensors of one person, and events of gait against marks, for ``muster bench track``.

The recordings have both feet and the lower back at once, and the beginning and the end of every
swing of either foot, marked by hand.
"""

from __future__ import annotations

import gzip
import heapq
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import msgspec
import numpy as np
from rich import box
from rich.table import Table

from edge.activity.gait_events import GaitEvents, find_gait_events
from edge.app.track import run_tracker
from edge.samples import Floats, ImuBatch
from edge.sources.recording import RecordingSource
from edge.tracker.interface import LEFT_FOOT, RIGHT_FOOT, TrackBatch, WornSensor
from edge.tracker.registry import TRACKERS, make_multi_sensor_tracker
from edge.tracker.track_rows import join_rows
from shared.errors import UserError
from tests.bench.tracker.body_recordings import score_return

_FILES = {
    LEFT_FOOT: "left_foot.csv.gz",
    RIGHT_FOOT: "right_foot.csv.gz",
    "waist": "lower_back.csv.gz",
}
RECORDED_PLACES = {  # tracker of a person: where it has its sensors here
    "two_feet": (LEFT_FOOT, RIGHT_FOOT),
    "foot_and_trunk": (LEFT_FOOT, "waist"),
}
_FOOT_TRACKER = TRACKERS[0].name
_SAME_SWING_S = 0.35  # between the middle of a swing and the middle of its marks


class _Marks(msgspec.Struct):
    """Beginning and end of each swing, seconds of the recording."""

    left_swing_or_stride_s: list[tuple[float, float]]
    right_swing_or_stride_s: list[tuple[float, float]]


@dataclass(frozen=True, slots=True)
class Returns:
    """Walks out and back by one tracker."""

    tracker: str
    places: tuple[str, ...]
    walks: int
    closure_median_m: float
    closure_coverage_95: float  # share


@dataclass(frozen=True, slots=True)
class GaitEventErrors:
    """Toe-offs and initial contacts against the marks, less the median of each kind."""

    walks: int
    marked: int  # swings
    missed: int
    error_median_s: float
    error_95_s: float


def measure_returns(data: Path) -> list[Returns]:
    """Score each foot alone, and every tracker of several sensors that these recordings have."""
    alone = [((place,), _FOOT_TRACKER) for place in (LEFT_FOOT, RIGHT_FOOT)]
    together = [(places, name) for name, places in RECORDED_PLACES.items()]
    return [measure_returns_of(data, places, name) for places, name in (*alone, *together)]


def measure_returns_of(data: Path, places: tuple[str, ...], name: str) -> Returns:
    """Score one tracker by the sensors at these places."""
    trials = _trials(data)
    walks = [score_return(trial, track_places(trial, places, name)) for trial in trials]
    return Returns(
        tracker=name,
        places=places,
        walks=len(walks),
        closure_median_m=float(np.median([walk.closure_m for walk in walks])),
        closure_coverage_95=float(np.mean([walk.covered for walk in walks])),
    )


def track_places(trial: Path, places: Sequence[str], name: str) -> TrackBatch:
    """Return the rows of one walk by a tracker of one sensor or of several."""
    sources = {place: RecordingSource(trial / _FILES[place]) for place in places}
    if len(sources) == 1:
        return run_tracker(sources[places[0]], name, quiet=True)
    sensors = {place: WornSensor(source.description, place) for place, source in sources.items()}
    tracker = make_multi_sensor_tracker(name, sensors)
    released = [tracker.push(place, imu) for place, imu in _in_turn(sources)]
    return join_rows([*released, tracker.finish()])


def _in_turn(sources: Mapping[str, RecordingSource]) -> Iterator[tuple[str, ImuBatch]]:
    """Give the batches of all sensors in the order in which they end."""

    def of(place: str) -> Iterator[tuple[int, str, ImuBatch]]:
        for batch in sources[place].batches():
            yield int(batch.imu.t_ns[-1]), place, batch.imu

    for _, place, imu in heapq.merge(*map(of, sources), key=lambda one: one[:2]):
        yield place, imu


def measure_gait_events(data: Path) -> list[GaitEventErrors]:
    """Compare the events of both feet with the marks: in all walks, and in those whose three
    sensors have as many samples (elsewhere some are missing, and the times do not show it).
    """
    trials = _trials(data)
    found_s = {trial: list(_errors_of_feet(trial)) for trial in trials}
    complete = [trial for trial in trials if _has_equal_counts(trial)]
    return [_summary([found_s[trial] for trial in some]) for some in (trials, complete)]


def _errors_of_feet(trial: Path) -> Iterator[Floats]:
    """Give the errors of each foot (m, 2), NaN where a marked swing was missed."""
    text = (trial / "trial.json").read_text(encoding="utf-8")
    marks = msgspec.convert(json.loads(text), _Marks)  # a weight may be NaN
    feet = {LEFT_FOOT: marks.left_swing_or_stride_s, RIGHT_FOOT: marks.right_swing_or_stride_s}
    for place, swings_s in feet.items():
        events = find_gait_events(track_places(trial, (place,), _FOOT_TRACKER))
        yield event_errors(events, np.array(swings_s))


def event_errors(events: GaitEvents, marked_s: Floats) -> Floats:
    """Return the errors of toe-off and contact of those ``marked_s`` (m, 2), NaN where missed."""
    found_s = np.column_stack((events.toe_off_s, events.initial_contact_s))
    errors_s = np.full(marked_s.shape, np.nan)
    for marked, error_s in zip(marked_s, errors_s, strict=True):
        off_s = np.abs(found_s.mean(axis=1) - marked.mean())
        if len(off_s) and off_s.min() < _SAME_SWING_S:
            error_s[:] = found_s[np.argmin(off_s)] - marked
    return errors_s


def _summary(walks: Sequence[Sequence[Floats]]) -> GaitEventErrors:
    all_s = np.concatenate([errors_s for walk in walks for errors_s in walk])
    found_s = all_s[~np.isnan(all_s[:, 0])]
    errors_s = np.abs(found_s - np.median(found_s, axis=0))
    return GaitEventErrors(
        walks=len(walks),
        marked=len(all_s),
        missed=len(all_s) - len(found_s),
        error_median_s=float(np.median(errors_s)),
        error_95_s=float(np.quantile(errors_s, 0.95)),
    )


def _has_equal_counts(trial: Path) -> bool:
    counts = set()
    for name in _FILES.values():
        with gzip.open(trial / name) as lines:
            counts.add(sum(1 for _ in lines))
    return len(counts) == 1


def _trials(data: Path) -> list[Path]:
    trials = sorted(path.parent for path in data.glob("body/ipol/*/trial.json"))
    if not trials:
        raise UserError(f"no body/ipol below {data}; give the folder of body")
    return trials


def returns_table(results: Sequence[Returns]) -> Table:
    table = Table(title="Several sensors of one person, out and back", box=box.SIMPLE_HEAD)
    for title in ("tracker", "sensors"):
        table.add_column(title)
    for title in ("walks", "closure, m", "in 95 %"):
        table.add_column(title, justify="right")
    for one in results:
        table.add_row(
            one.tracker,
            ", ".join(one.places),
            str(one.walks),
            f"{one.closure_median_m:.2f}",
            f"{100.0 * one.closure_coverage_95:.0f}",
        )
    return table


def gait_events_table(results: Sequence[GaitEventErrors]) -> Table:
    table = Table(title="Toe-off and initial contact against the marks", box=box.SIMPLE_HEAD)
    for title in ("walks", "swings", "missed", "median, ms", "95 %, ms"):
        table.add_column(title, justify="right")
    for one in results:
        counts = (str(one.walks), str(one.marked), str(one.missed))
        table.add_row(*counts, f"{1e3 * one.error_median_s:.0f}", f"{1e3 * one.error_95_s:.0f}")
    return table
