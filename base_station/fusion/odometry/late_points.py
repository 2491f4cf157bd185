"""Positions that come late, out of a journal, and the places in the path where they belong."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable

from base_station.fusion.interface import Estimate
from base_station.fusion.odometry.path_runs import PathRuns
from base_station.fusion.odometry.points import BREAK, DOUBTFUL, RESTART, Point
from base_station.fusion.odometry.thinned_path import MOVING_M, ThinnedPath
from shared.clock import NS_PER_MS, NS_PER_S
from shared.messages import Position
from shared.quality import GOOD

FILL_NS = 3 * NS_PER_S // 2  # a position that came late is wanted where none is nearer

_Join = Callable[[ThinnedPath, PathRuns, Point, int], bool]


def insert_late(
    path: ThinnedPath,
    runs: PathRuns,
    position: Position,
    t_ns: int,
    estimate: Estimate,
    floor: int | None,
) -> None:
    """Insert a late position with its estimate without pins, where no point is near: in a gap,
    before the first point of the running boot, or behind the last one of the boot before.
    """
    points = path.points
    row = bisect_left(points, t_ns, key=lambda point: point.t_ns)
    if row == len(points):
        return
    join = _join_of(path, runs, position.header.boot_id, t_ns, row)
    if join is None:
        return
    near = points[max(row - 1, 0) : row + 1]
    if min(abs(point.t_ns - t_ns) for point in near) < FILL_NS:
        return
    late = Point.of(position, t_ns, 0 if position.path_quality is GOOD else DOUBTFUL)
    late.set_live_estimate(estimate, floor)
    if join(path, runs, late, row):
        path.insert(row, late)


def _join_of(path: ThinnedPath, runs: PathRuns, boot_id: int, t_ns: int, row: int) -> _Join | None:
    """Function that joins a late position to the path; None where it has no place in it."""
    is_before = t_ns < runs.begin_ns
    if boot_id == runs.boot_id:
        return _begin_earlier if is_before else _fill_gap
    if boot_id == runs.ended_boot_id and is_before:
        is_last = path.points[row].t_ns >= runs.begin_ns
        return _end_later if is_last else _fill_gap
    return None


def _fill_gap(path: ThinnedPath, _runs: PathRuns, late: Point, row: int) -> bool:
    after = path.points[row]
    if row == 0 or after.flags & (BREAK | RESTART):
        return False
    before_ns = path.points[row - 1].t_ns
    part = (late.t_ns - before_ns) / (after.t_ns - before_ns)
    late.moving_ms = round(after.moving_ms * part)
    after.moving_ms -= late.moving_ms
    return True


def _begin_earlier(path: ThinnedPath, runs: PathRuns, late: Point, row: int) -> bool:
    """The running boot's own frame."""
    first = path.points[row]
    if row > 0 and not first.flags & RESTART:
        return False
    if row == 0 and (path.packed or late.t_ns < runs.since_ns):
        return False
    late.flags |= first.flags & RESTART
    first.flags &= ~RESTART
    if abs(first.north_m - late.north_m) + abs(first.east_m - late.east_m) > MOVING_M:
        first.moving_ms += (first.t_ns - late.t_ns) // NS_PER_MS
    runs.begin_ns = late.t_ns
    return True


def _end_later(path: ThinnedPath, _runs: PathRuns, late: Point, row: int) -> bool:
    """The own frame of the boot before."""
    if row == 0:
        return False
    last = path.points[row - 1]
    if abs(last.north_m - late.north_m) + abs(last.east_m - late.east_m) > MOVING_M:
        late.moving_ms = (late.t_ns - last.t_ns) // NS_PER_MS
    return True
