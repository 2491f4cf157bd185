"""Trail as it is drawn and measured: simplified lines by floor, distance, time on each floor."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import pairwise

import msgspec
import numpy as np
from numpy.typing import NDArray

from base_station.exporters.interface import LONGEST_STEP_NS, pieces_of
from base_station.report.contents import FloorTrail, Interval, Line
from base_station.site.plan import Plan
from base_station.storage.db.records import TrackSample
from shared.clock import NS_PER_S

TOLERANCE_M = 0.3  # by so much a line that is drawn may miss a position: a third of a door
STEP_M = 0.5  # a unit that moves less than that about one place has not walked
_INSIDE_EVERY_NS = 5 * NS_PER_S  # to look at the walls for every second takes long


class TrailFigures(msgspec.Struct, frozen=True):
    distance_m: float
    inside_s: float | None
    floors: tuple[tuple[int | None, float], ...]
    trails: tuple[FloorTrail, ...]


def measure(
    points: Sequence[TrackSample], plan: Plan | None, radio_gaps: Sequence[Interval]
) -> TrailFigures:
    pieces = pieces_of(points) if points else ()
    return TrailFigures(
        sum(map(_distance_m, pieces)),
        _inside_s(points, plan) if plan is not None and plan.outlines else None,
        _floors(points),
        _floor_trails(pieces, radio_gaps),
    )


def simplified(line: NDArray[np.float64], tolerance_m: float = TOLERANCE_M) -> NDArray[np.bool_]:
    """Flags of the rows (n, 2) to keep, so that no other row lies further from the line than the
    tolerance (Douglas and Peucker, 1973).
    """
    keep = np.zeros(len(line), bool)
    keep[[0, -1]] = True
    spans = [(0, len(line) - 1)]
    while spans:
        first, last = spans.pop()
        if last - first < 2:
            continue
        away_m = _away_m(line[first + 1 : last], line[first], line[last])
        furthest = int(np.argmax(away_m))
        if away_m[furthest] > tolerance_m:
            row = first + 1 + furthest
            keep[row] = True
            spans += [(first, row), (row, last)]
    return keep


def _away_m(
    points: NDArray[np.float64], begin: NDArray[np.float64], end: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Distances of the points from the straight line between two ends."""
    along = end - begin
    length = float(along @ along)
    part = np.clip((points - begin) @ along / length, 0.0, 1.0) if length > 0.0 else 0.0
    nearest = begin + np.multiply.outer(part, along)
    return np.asarray(np.linalg.norm(points - nearest, axis=1))


def _distance_m(piece: Sequence[TrackSample]) -> float:
    total_m, last = 0.0, piece[0]
    for point in piece:
        moved_m = math.hypot(point.north_m - last.north_m, point.east_m - last.east_m)
        if moved_m >= STEP_M:
            total_m, last = total_m + moved_m, point
    return total_m


def _inside_s(points: Sequence[TrackSample], plan: Plan) -> float:
    inside, looked_ns, total_ns = False, -_INSIDE_EVERY_NS, 0
    for point, following in pairwise(points):
        if point.t_ns - looked_ns >= _INSIDE_EVERY_NS:
            inside, looked_ns = plan.is_inside(point.north_m, point.east_m, inside), point.t_ns
        if inside:
            total_ns += following.t_ns - point.t_ns
    return total_ns / NS_PER_S


def _floors(points: Sequence[TrackSample]) -> tuple[tuple[int | None, float], ...]:
    on_floor: dict[int | None, float] = {}
    for point, following in pairwise(points):
        step_ns = min(following.t_ns - point.t_ns, LONGEST_STEP_NS)
        on_floor[point.floor] = on_floor.get(point.floor, 0.0) + step_ns / NS_PER_S
    return tuple(sorted(on_floor.items(), key=lambda one: (one[0] is None, one[0] or 0)))


def _floor_trails(
    pieces: Iterable[Sequence[TrackSample]], radio_gaps: Sequence[Interval]
) -> tuple[FloorTrail, ...]:
    in_contact: dict[int | None, list[Line]] = {}
    silent: dict[int | None, list[Line]] = {}
    for piece in pieces:
        for floor, in_gap, run in _runs(piece, radio_gaps):
            lines = (silent if in_gap else in_contact).setdefault(floor, [])
            lines.append(_line(run))
    floors = sorted({*in_contact, *silent}, key=lambda one: (one is None, one or 0))
    return tuple(
        FloorTrail(floor, tuple(in_contact.get(floor, ())), tuple(silent.get(floor, ())))
        for floor in floors
    )


def _runs(
    piece: Sequence[TrackSample], radio_gaps: Sequence[Interval]
) -> Iterable[tuple[int | None, bool, Sequence[TrackSample]]]:
    """Parts on one floor, with or without radio contact; each ends where the next one begins."""
    kinds = [(one.floor, _in_gap(one.t_ns, radio_gaps)) for one in piece]
    changes = [row for row in range(1, len(kinds)) if kinds[row] != kinds[row - 1]]
    for begin, end in pairwise((0, *changes, len(piece))):
        floor, in_gap = kinds[begin]
        same_floor = end < len(piece) and kinds[end][0] == floor
        yield floor, in_gap, piece[begin : end + 1 if same_floor else end]


def _in_gap(t_ns: int, radio_gaps: Sequence[Interval]) -> bool:
    return any(gap.from_ns < t_ns < gap.until_ns for gap in radio_gaps)


def _line(run: Sequence[TrackSample]) -> Line:
    places = np.array([(one.east_m, one.north_m) for one in run])
    return tuple((float(east), float(north)) for east, north in places[simplified(places)])
