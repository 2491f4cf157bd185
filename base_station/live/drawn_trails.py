"""Units' trails as consoles hear them, kept encoded.

A trail has up to 900 points and changes by one a second, so a point is encoded once, not again for
every console that joins: the thread that steps everybody's positions does this.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Sequence

import msgspec

from base_station.live_state import UnitState
from base_station.units.trail import TrailStep
from base_station.views.wire import TrailPoint
from shared.clock import NS_PER_MS, NS_PER_S

BEHIND_NS = 10 * NS_PER_S  # some points at once cost a tenth of the same ones one by one


class DrawnTrails:
    def __init__(self) -> None:
        self._drawn: dict[str, _DrawnTrail] = {}

    def keep_up(self, unit: UnitState) -> None:
        """Not far behind a trail that goes on: little is left to do when it is asked for."""
        if unit.trail:
            self._of(unit.unit_id).keep_near(unit.trail)

    def of(self, unit: UnitState) -> msgspec.Raw:
        drawn = self._of(unit.unit_id)
        drawn.follow(unit.trail)
        return drawn.whole()

    def all(self, units: Iterable[UnitState]) -> dict[str, msgspec.Raw]:
        """Of everybody who left a trail."""
        return {unit.unit_id: self.of(unit) for unit in units if unit.trail}

    def _of(self, unit_id: str) -> _DrawnTrail:
        drawn = self._drawn.get(unit_id)
        if drawn is None:
            drawn = self._drawn[unit_id] = _DrawnTrail()
        return drawn


class _DrawnTrail:
    def __init__(self) -> None:
        self._steps: list[TrailStep] = []  # what ``_text`` says
        self._text = bytearray()  # their points, with a comma between two

    def whole(self) -> msgspec.Raw:
        return msgspec.Raw(b"[%b]" % bytes(self._text))

    def keep_near(self, trail: list[TrailStep]) -> None:
        if not self._steps or trail[-1].t_ns - self._steps[-1].t_ns >= BEHIND_NS:
            self.follow(trail)

    def follow(self, trail: list[TrailStep]) -> None:
        """Say what the trail is now.  Steps are never changed, so comparing is cheap: they are
        the same ones.
        """
        if trail == self._steps:
            return
        new = trail
        if trail and self._steps:
            gone = bisect_left(self._steps, trail[0].t_ns, key=lambda step: step.t_ns)
            kept = len(self._steps) - gone
            if kept and self._steps[gone:] == trail[:kept]:
                self._drop(gone)
                new = trail[kept:]
        if new is trail:
            self._text.clear()
        if self._text and new:
            self._text += b","
        self._text += _encoded(new)
        self._steps = trail.copy()

    def _drop(self, points: int) -> None:
        for _ in range(points):
            del self._text[: self._text.index(b"]") + 2]  # with its comma


def _encoded(steps: Sequence[TrailStep]) -> bytes:
    """The points, without the brackets about them."""
    points = [
        TrailPoint(
            step.t_ns // NS_PER_MS, round(step.north_m, 2), round(step.east_m, 2), step.floor
        )
        for step in steps
    ]
    return msgspec.json.encode(points)[1:-1]
