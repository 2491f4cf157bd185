"""Recent part of a unit's own path, to look up its place at the time of a late fix."""

from __future__ import annotations

from bisect import bisect_left

import msgspec
import numpy as np

from base_station.fusion.odometry.packed_rows import CHUNK, Packed, Records
from shared.clock import NS_PER_MS, NS_PER_S
from shared.messages import Position

KEPT_NS = 30 * 60 * NS_PER_S
STEP_NS = NS_PER_S // 5
DENSE_NS = 60 * NS_PER_S  # every step of the last minute, of older ones one in
COARSE_NS = 2 * NS_PER_S
MOST_POINTS = 600  # that are not packed; a minute has half as many
NEAR_NS = 5 * NS_PER_S  # a place further from any known point is not known
PLACE_ROW = np.dtype(
    [("t_ms", "<i8"), ("north_mm", "<i8"), ("east_mm", "<i8"), ("distance_mm", "<i8")]
)
_MOST_MM = 2**31 - 1


class PathPoint(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """In the unit's own frame."""

    t_ns: int
    north_m: float
    east_m: float
    distance_m: float


class RecentPath(msgspec.Struct):
    """The last half hour, in the unit's monotonic time; finer in the last minute, packed before."""

    packed: Packed = msgspec.field(default_factory=Packed)
    loose: bytes = b""  # rows, behind the packed ones
    points: list[PathPoint] = msgspec.field(default_factory=list)  # behind the loose ones

    def append(self, position: Position) -> None:
        """Points come in order; where they come too fast, the newest replaces its neighbour."""
        points, point = self.points, _point(position)
        if len(points) > 1 and point.t_ns - points[-2].t_ns < STEP_NS:
            points[-1] = point
            return
        points.append(point)
        if len(points) >= MOST_POINTS:
            self._pack(point.t_ns)

    def insert_late(self, position: Position) -> None:
        """A point that came late, where none is near: as near as points of that age are kept."""
        point = _point(position)
        age_ns = self.points[-1].t_ns - point.t_ns if self.points else 0
        if age_ns > KEPT_NS:
            return
        step_ns = STEP_NS if age_ns < DENSE_NS else COARSE_NS
        near = [one for one in self._around(point.t_ns) if one is not None]
        if not near or any(abs(one.t_ns - point.t_ns) < step_ns for one in near):
            return
        if self.loose and point.t_ns < self.points[0].t_ns:
            rows = self._rows()
            at = np.searchsorted(rows["t_ms"], point.t_ns // NS_PER_MS)
            self.packed, self.loose = Packed(), np.insert(rows, at, _rows_of([point])).tobytes()
        else:
            self.points.insert(self._after(point.t_ns), point)

    def at(self, t_ns: int) -> PathPoint | str:
        """Place at a time (after the last point: that point), or the reason for which it is
        unknown.
        """
        before, after = self._around(t_ns)
        if after is None:
            return before or PathPoint(t_ns, 0.0, 0.0, 0.0)
        if before is None:
            return after if after.t_ns - t_ns < NEAR_NS else "too old"
        if min(t_ns - before.t_ns, after.t_ns - t_ns) > NEAR_NS:
            return "the path at its time is not known"
        part = (t_ns - before.t_ns) / (after.t_ns - before.t_ns)
        return PathPoint(
            t_ns,
            before.north_m + part * (after.north_m - before.north_m),
            before.east_m + part * (after.east_m - before.east_m),
            before.distance_m + part * (after.distance_m - before.distance_m),
        )

    def _around(self, t_ns: int) -> tuple[PathPoint | None, PathPoint | None]:
        """The last point before that time and the first one then or after it."""
        points, at = self.points, self._after(t_ns)
        before = points[at - 1] if at > 0 else None
        after = points[at] if at < len(points) else None
        if before is None:
            rows = self._rows()
            row = int(np.searchsorted(rows["t_ms"], t_ns / NS_PER_MS))
            before = _place(rows[row - 1]) if row > 0 else None
            after = _place(rows[row]) if row < len(rows) else after
        return before, after

    def _after(self, t_ns: int) -> int:
        return bisect_left(self.points, t_ns, key=lambda point: point.t_ns)

    def _rows(self) -> Records:
        return np.concatenate((self.packed.rows(PLACE_ROW), self._loose()))

    def _loose(self) -> Records:
        return np.frombuffer(self.loose, PLACE_ROW)

    def _pack(self, now_ns: int) -> None:
        """Thin points older than a minute, and drop those that are too old."""
        kept: list[PathPoint] = []
        rows, oldest_ns = self._loose(), now_ns - KEPT_NS
        last_ns = int(rows["t_ms"][-1]) * NS_PER_MS if len(rows) else oldest_ns
        dense = self._after(now_ns - DENSE_NS)
        for point in self.points[:dense]:
            if point.t_ns - last_ns >= COARSE_NS:
                kept.append(point)
                last_ns = point.t_ns
        del self.points[:dense]
        rows = np.concatenate((rows, _rows_of(kept)))
        self.packed.cut(oldest_ns // NS_PER_MS, PLACE_ROW)
        rows = rows[rows["t_ms"] >= oldest_ns // NS_PER_MS]
        while len(rows) > CHUNK:
            self.packed.add(rows[:CHUNK], lambda rows: rows[::2])
            rows = rows[CHUNK:]
        self.loose = rows.tobytes()


def _rows_of(points: list[PathPoint]) -> Records:
    """Rows in millimetres, saturated at the range of the numbers."""
    rows = np.zeros(len(points), PLACE_ROW)
    rows["t_ms"] = [point.t_ns // NS_PER_MS for point in points]
    for name in ("north", "east", "distance"):
        metres = np.array([getattr(point, f"{name}_m") for point in points])
        rows[f"{name}_mm"] = np.rint(np.clip(metres * 1e3, -_MOST_MM, _MOST_MM))
    return rows


def _place(row: np.void) -> PathPoint:
    t_ms, *lengths_mm = row.item()
    return PathPoint(t_ms * NS_PER_MS, *(length_mm * 1e-3 for length_mm in lengths_mm))


def _point(position: Position) -> PathPoint:
    t_ns = position.header.t_mono_ns
    return PathPoint(t_ns, position.north_m, position.east_m, position.distance_m)
