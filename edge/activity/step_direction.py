"""Direction of the steps of a foot: forward, backward, to a side, or a turn on the spot.

Forward is where the long strides go, in the axes of the sensor on the foot.
"""

from __future__ import annotations

from math import atan2, pi, radians

import numpy as np

from edge.activity.strides import Stride
from edge.samples import Floats
from shared.clock import NS_PER_S
from shared.messages import Mobility

_LONG_STRIDE_M = 0.9  # few step so far backward or to a side
_LEARNT_SHARE = 0.1
_AGAINST_SHARE = 0.02  # of one that contradicts: people walk backward only shortly
_SOME_LONG = 3
_SECTOR_RAD = pi / 4.0  # about forward, and about backward
_ON_THE_SPOT_M = 0.45
_TURN_RAD = radians(25.0)  # of one step
_STRIDE_LASTS_NS = 5 * NS_PER_S // 2


class StepDirection:
    """Tracker of one foot's strides, which come in order."""

    def __init__(self) -> None:
        self._forward_b = np.zeros(3)
        self._long_strides = 0
        self._last: tuple[int, Mobility] | None = None

    def push(self, stride: Stride) -> None:
        if stride.length_m >= _LONG_STRIDE_M:
            self._learn(_level(stride.step_b, stride.up_b) / stride.length_m)
        self._last = stride.end_ns, self._way(stride)

    def mobility(self, t_ns: int) -> Mobility | None:
        """Return the way of the last stride; None where that was long ago."""
        if self._last is None or abs(t_ns - self._last[0]) > _STRIDE_LASTS_NS:
            return None
        return self._last[1]

    def _learn(self, direction_b: Floats) -> None:
        """Take the direction of a long stride (3,), of unit length."""
        self._long_strides += 1
        agrees = float(direction_b @ self._forward_b) >= 0.0
        share = max(_LEARNT_SHARE if agrees else _AGAINST_SHARE, 1.0 / self._long_strides**2)
        self._forward_b = self._forward_b + share * (direction_b - self._forward_b)

    def _way(self, stride: Stride) -> Mobility:
        if stride.length_m < _ON_THE_SPOT_M and abs(stride.turn_rad) >= _TURN_RAD:
            return Mobility.TURNING
        if stride.length_m < _ON_THE_SPOT_M / 2.0 or self._long_strides < _SOME_LONG:
            return Mobility.MOVING
        forward_b = _level(self._forward_b, stride.up_b)
        step_b = _level(stride.step_b, stride.up_b)
        right_b = np.cross(forward_b, stride.up_b)
        angle_rad = atan2(float(right_b @ step_b), float(forward_b @ step_b))
        if abs(angle_rad) <= _SECTOR_RAD:
            return Mobility.FORWARD
        if abs(angle_rad) >= pi - _SECTOR_RAD:
            return Mobility.BACKWARD
        return Mobility.RIGHTWARD if angle_rad > 0.0 else Mobility.LEFTWARD


def _level(vector_b: Floats, up_b: Floats) -> Floats:
    return np.asarray(vector_b - float(vector_b @ up_b) * up_b)
