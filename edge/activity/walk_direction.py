"""Direction of steps against the body: forward, backward, to a side, or a turn on the spot."""

from __future__ import annotations

from collections import deque
from math import atan2, pi

from edge.activity.body_motion import WINDOW_NS
from edge.activity.inclination import InclinationWindow
from edge.activity.segment_axes import SegmentAxes
from edge.samples import Floats
from shared.clock import NS_PER_S
from shared.messages import Mobility

_SILENT_NS = 2 * NS_PER_S
_WALK_LASTS_NS = 3 * NS_PER_S  # since the last walk was found: it is looked for every three
_TURN_WINDOWS = 3
_TURN_RAD = pi / 4.0  # in so many windows
_SECTOR_RAD = pi / 4.0  # about forward, and about backward


class WalkDirection:
    """Tracker of a trunk's steps."""

    def __init__(self) -> None:
        self._turns_rad: deque[float] = deque(maxlen=_TURN_WINDOWS)  # about up, of each window
        self._walk: tuple[int, Mobility] | None = None  # when it was found last
        self._window: InclinationWindow | None = None

    def push(
        self, window: InclinationWindow, axes: SegmentAxes, direction_b: Floats | None
    ) -> None:
        """Take a window of the trunk, and the direction of the walk (3,) where one was found."""
        self._window = window
        rate_radps = float(window.samples[:, 4:7].mean(axis=0) @ window.up_b)
        self._turns_rad.append(rate_radps * WINDOW_NS / NS_PER_S)
        if direction_b is not None:
            self._walk = window.end_ns, _way(axes, direction_b)

    def mobility(self, t_ns: int) -> Mobility:
        window = self._window
        if window is None or not 0 <= t_ns - window.end_ns <= _SILENT_NS:
            return Mobility.UNKNOWN
        if self._walk is not None and 0 <= window.end_ns - self._walk[0] <= _WALK_LASTS_NS:
            return self._walk[1]
        if abs(sum(self._turns_rad)) >= _TURN_RAD:
            return Mobility.TURNING
        return Mobility.MOVING if window.moving else Mobility.STILL


def _way(axes: SegmentAxes, direction_b: Floats) -> Mobility:
    if not axes.has_forward_axis:
        return Mobility.MOVING
    forward, right, _ = axes.inclination(direction_b)
    angle_rad = atan2(float(right), float(forward))
    if abs(angle_rad) <= _SECTOR_RAD:
        return Mobility.FORWARD
    if abs(angle_rad) >= pi - _SECTOR_RAD:
        return Mobility.BACKWARD
    return Mobility.RIGHTWARD if angle_rad > 0.0 else Mobility.LEFTWARD
