"""A unit's own path of late, to look up where it was when a fix that comes late was valid."""

from __future__ import annotations

from bisect import bisect_left

import msgspec

from shared.clock import NS_PER_S
from shared.messages import Position

KEPT_NS = 30 * 60 * NS_PER_S
STEP_NS = NS_PER_S // 5
DENSE_NS = 60 * NS_PER_S  # of it every step, of what is older one in
COARSE_NS = 2 * NS_PER_S
THINNED_EVERY = 300  # points; as many as a minute has
NEAR_NS = 5 * NS_PER_S  # a place further from any known point is not known


class OwnPlace(msgspec.Struct, frozen=True, array_like=True):
    """In the unit's own frame."""

    t_ns: int
    north_m: float
    east_m: float
    distance_m: float


class PathMemory(msgspec.Struct):
    """The last half hour, in the unit's monotonic time; finer in the last minute."""

    points: list[OwnPlace] = msgspec.field(default_factory=list)

    def note(self, position: Position) -> None:
        """Points come in order; where they come too fast, the newest replaces its neighbour."""
        points, point = self.points, _point(position)
        if len(points) > 1 and point.t_ns - points[-2].t_ns < STEP_NS:
            points[-1] = point
            return
        points.append(point)
        if len(points) % THINNED_EVERY == 0:
            self._thin(point.t_ns)

    def fill(self, position: Position) -> None:
        """A point that came late, where none is near."""
        point = _point(position)
        at = self._after(point.t_ns)
        near = self.points[max(at - 1, 0) : at + 1]
        if near and all(abs(one.t_ns - point.t_ns) >= STEP_NS for one in near):
            self.points.insert(at, point)

    def at(self, t_ns: int) -> OwnPlace | str:
        """The place then (after the last point: there), or why that cannot be told."""
        points = self.points
        if not points:
            return OwnPlace(t_ns, 0.0, 0.0, 0.0)
        at = self._after(t_ns)
        if at == len(points):
            return points[-1]
        after = points[at]
        if at == 0:
            return after if after.t_ns - t_ns < NEAR_NS else "too old"
        before = points[at - 1]
        if min(t_ns - before.t_ns, after.t_ns - t_ns) > NEAR_NS:
            return "the path at its time is not known"
        part = (t_ns - before.t_ns) / (after.t_ns - before.t_ns)
        return OwnPlace(
            t_ns,
            before.north_m + part * (after.north_m - before.north_m),
            before.east_m + part * (after.east_m - before.east_m),
            before.distance_m + part * (after.distance_m - before.distance_m),
        )

    def _after(self, t_ns: int) -> int:
        return bisect_left(self.points, t_ns, key=lambda point: point.t_ns)

    def _thin(self, now_ns: int) -> None:
        """What was old already at the last time has been thinned then."""
        first = self._after(now_ns - KEPT_NS)
        thinned = max(first, len(self.points) - 2 * THINNED_EVERY)
        kept = self.points[first:thinned]
        for point in self.points[thinned:]:
            step_ns = COARSE_NS if now_ns - point.t_ns > DENSE_NS else 0
            if not kept or point.t_ns - kept[-1].t_ns >= step_ns:
                kept.append(point)
        self.points = kept


def _point(position: Position) -> OwnPlace:
    t_ns = position.header.t_mono_ns
    return OwnPlace(t_ns, position.north_m, position.east_m, position.distance_m)
