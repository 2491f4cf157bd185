"""Trail encoder: keeps the trails of units encoded as consoles get them.

A trail has up to 900 points and changes by one a second.  So a point is encoded once, not again for
each console that joins: the thread that steps all positions does this.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Sequence

import msgspec

from base_station.core.state import UnitState
from base_station.core.state.trail import TrailStep
from base_station.views.wire import TrailPoint, encoded_trail
from shared.clock import NS_PER_MS, NS_PER_S

BEHIND_NS = 10 * NS_PER_S  # some points at once cost a tenth of the same ones one by one


class TrailEncoder:
    def __init__(self) -> None:
        self._encoded_trails: dict[str, _EncodedTrail] = {}

    def update_if_behind(self, unit: UnitState) -> None:
        """Update the encoded trail if it is behind by some seconds, so that little is left to do
        when it is asked for.
        """
        if unit.trails.shown:
            self._of(unit.unit_id).update_if_behind(unit.trails.shown)

    def of(self, unit: UnitState) -> msgspec.Raw:
        encoded = self._of(unit.unit_id)
        encoded.update(unit.trails.shown)
        return encoded.whole()

    def all(self, units: Iterable[UnitState]) -> dict[str, msgspec.Raw]:
        """Trails of all units that have one."""
        return {unit.unit_id: self.of(unit) for unit in units if unit.trails.shown}

    def _of(self, unit_id: str) -> _EncodedTrail:
        encoded = self._encoded_trails.get(unit_id)
        if encoded is None:
            encoded = self._encoded_trails[unit_id] = _EncodedTrail()
        return encoded


class _EncodedTrail:
    def __init__(self) -> None:
        self._steps: list[TrailStep] = []  # contents of ``_text``
        self._text = bytearray()  # their points, with a comma between two

    def whole(self) -> msgspec.Raw:
        return msgspec.Raw(b"[%b]" % bytes(self._text))

    def update_if_behind(self, trail: list[TrailStep]) -> None:
        if not self._steps or trail[-1].t_ns - self._steps[-1].t_ns >= BEHIND_NS:
            self.update(trail)

    def update(self, trail: list[TrailStep]) -> None:
        """Update the encoded trail.  Steps are never changed, so comparing is cheap: equal ones are
        the same objects.
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
    """The encoded points, without the brackets of the list."""
    return encoded_trail(map(trail_point, steps))[1:-1]


def trail_point(step: TrailStep) -> TrailPoint:
    """Point of a trail as consoles get it, to a centimetre."""
    return TrailPoint(
        step.t_ns // NS_PER_MS,
        round(step.north_m, 2),
        round(step.east_m, 2),
        step.floor,
        int(step.after_gap),
    )
