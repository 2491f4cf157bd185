"""Several sensors of one person, and footfalls against marks, for ``muster bench track``.

The recordings have both feet and the lower back at once, and the beginning and the end of every
swing of either foot, marked by hand.
"""

from __future__ import annotations

import heapq
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import msgspec
import numpy as np
from rich import box
from rich.table import Table

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
_LONGEST_SWING_S = 0.7  # half of it, from its middle


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
class Footfalls:
    """Beginnings and ends of swings against the marks, less the median of each kind."""

    marked: int
    missed: int  # marked swings that have no swing of the tracker
    error_median_s: float
    error_95_s: float


def measure_returns(data: Path) -> list[Returns]:
    """Score each foot alone, and every tracker of several sensors that these recordings have."""
    trials = _trials(data)
    alone = [((place,), _FOOT_TRACKER) for place in (LEFT_FOOT, RIGHT_FOOT)]
    together = [(places, name) for name, places in RECORDED_PLACES.items()]
    return [_measure(trials, places, name) for places, name in (*alone, *together)]


def _measure(trials: Sequence[Path], places: tuple[str, ...], name: str) -> Returns:
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


def measure_footfalls(data: Path) -> Footfalls:
    """Compare what the foot's tracker takes for a swing with the marks, both feet of everybody."""
    errors = []
    marked = 0
    for trial in _trials(data):
        text = (trial / "trial.json").read_text(encoding="utf-8")
        marks = msgspec.convert(json.loads(text), _Marks)  # a weight may be NaN
        feet = {LEFT_FOOT: marks.left_swing_or_stride_s, RIGHT_FOOT: marks.right_swing_or_stride_s}
        for place, swings_s in feet.items():
            rows = track_places(trial, (place,), _FOOT_TRACKER)
            errors.append(swing_errors(rows, np.array(swings_s)))
            marked += len(swings_s)
    found_s = np.concatenate(errors)
    errors_s = np.abs(found_s - np.median(found_s, axis=0))
    return Footfalls(
        marked=marked,
        missed=marked - len(found_s),
        error_median_s=float(np.median(errors_s)),
        error_95_s=float(np.quantile(errors_s, 0.95)),
    )


def swing_errors(rows: TrackBatch, marked_s: Floats) -> Floats:
    """Return (n, 2) errors of beginning and end of those ``marked_s`` (m, 2) that were found."""
    changes = np.diff(rows.stationary.astype(np.int8))
    t_s = rows.t_ns[1:] * 1e-9
    begun_s, ended_s = t_s[changes == -1], t_s[changes == 1]
    errors = []
    for begin_s, end_s in marked_s:
        middle_s = (begin_s + end_s) / 2.0
        before = begun_s[(begun_s < middle_s) & (begun_s > middle_s - _LONGEST_SWING_S)]
        after = ended_s[(ended_s > middle_s) & (ended_s < middle_s + _LONGEST_SWING_S)]
        if len(before) and len(after):
            errors.append((before[-1] - begin_s, after[0] - end_s))
    return np.array(errors).reshape(-1, 2)


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


def footfalls_line(found: Footfalls) -> str:
    return (
        f"Swings of both feet: {found.marked} marked, {found.missed} missed; beginnings and ends "
        f"off by {1000.0 * found.error_median_s:.0f} ms (median), "
        f"{1000.0 * found.error_95_s:.0f} ms (95 %)"
    )
