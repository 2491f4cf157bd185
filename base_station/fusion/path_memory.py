"""The last stretch of a unit's own path, to look up where it was when a late fix was valid."""

from __future__ import annotations

from bisect import bisect_left

import msgspec

from shared.clock import NS_PER_S

KEPT_NS = 60 * NS_PER_S
STEP_NS = NS_PER_S // 5


class PathMemory(msgspec.Struct):
    """Own-frame north and east of the last minute, in the unit's monotonic time."""

    t_ns: list[int] = msgspec.field(default_factory=list)
    north_m: list[float] = msgspec.field(default_factory=list)
    east_m: list[float] = msgspec.field(default_factory=list)

    def note(self, t_ns: int, north_m: float, east_m: float) -> None:
        """Points come in order; where they come too fast, the newest replaces its neighbour."""
        if len(self.t_ns) > 1 and t_ns - self.t_ns[-2] < STEP_NS:
            self.t_ns[-1], self.north_m[-1], self.east_m[-1] = t_ns, north_m, east_m
            return
        self.t_ns.append(t_ns)
        self.north_m.append(north_m)
        self.east_m.append(east_m)
        if t_ns - self.t_ns[0] > 2 * KEPT_NS:
            old = bisect_left(self.t_ns, t_ns - KEPT_NS)
            del self.t_ns[:old], self.north_m[:old], self.east_m[:old]

    def at(self, t_ns: int) -> tuple[float, float] | str:
        """North and east then (after the last point: there), or why that cannot be told."""
        if not self.t_ns:
            return 0.0, 0.0
        after = bisect_left(self.t_ns, t_ns)
        if after == len(self.t_ns):
            return self.north_m[-1], self.east_m[-1]
        if after == 0:
            if t_ns < self.t_ns[0] and self.t_ns[-1] - t_ns > KEPT_NS:
                return "too old"
            return self.north_m[0], self.east_m[0]
        t0_ns, t1_ns = self.t_ns[after - 1], self.t_ns[after]
        part = (t_ns - t0_ns) / (t1_ns - t0_ns)
        return (
            self.north_m[after - 1] + part * (self.north_m[after] - self.north_m[after - 1]),
            self.east_m[after - 1] + part * (self.east_m[after] - self.east_m[after - 1]),
        )
