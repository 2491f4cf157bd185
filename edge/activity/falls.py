"""Fall detector: weightlessness, an impact, and then no walking.

The first two alone are a jump from a step.  Bourke et al., "Evaluation of a threshold-based
tri-axial accelerometer fall detection algorithm", 2007, use the same order of events; the
thresholds here are for a unit on the foot.
"""

from __future__ import annotations

from math import isnan

import numpy as np

from edge.activity.body_motion import WINDOW_NS
from edge.activity.strides import Stride
from edge.samples import ImuBatch
from shared.clock import NS_PER_S

_WEIGHTLESS_MPS2 = 4.0
_WEIGHTLESS_NS = NS_PER_S // 4  # a drop of 0.3 m
_HOLE_NS = NS_PER_S // 10  # between two samples; in a longer one there may have been weight
_IMPACT_MPS2 = 30.0
_IMPACT_WITHIN_NS = NS_PER_S // 2
_DOWN_FOR_S = 2.0  # motionless after the blow
_DOWN_WITHIN_NS = 8 * NS_PER_S  # of received samples: a gap in them is no proof of getting up
_WALKING_STRIDES = 2  # strides: one may be a lunge on the way down


class FallDetector:
    """Detector of falls; ``falling`` from the impact until it is clear whether the wearer got
    up.
    """

    def __init__(self) -> None:
        self._weightless_since_ns: int | None = None
        self._weightless_ns = 0  # the last such sample
        self._weightless_until_ns: int | None = None
        self._impact_ns = 0
        self._seen_ns: int | None = None  # how long the wearer has been watched since the blow
        self._strides = 0  # since then

    @property
    def falling(self) -> bool:
        return self._seen_ns is not None and self._strides < _WALKING_STRIDES

    def push(self, imu: ImuBatch) -> None:
        force_mps2 = np.linalg.norm(imu.accel_mps2, axis=1)
        # Most batches hold nothing of interest; NaN is none of it.
        relevant = (force_mps2 < _WEIGHTLESS_MPS2) | (force_mps2 > _IMPACT_MPS2)
        if not relevant.any() and self._weightless_since_ns is None:
            return
        for t_ns, force in zip(imu.t_ns.tolist(), force_mps2.tolist(), strict=True):
            self._step(t_ns, force)

    def walk(self, stride: Stride) -> None:
        """Count a stride that only a standing person makes."""
        if stride.end_ns - round(stride.period_s * NS_PER_S) > self._impact_ns:
            self._strides += 1

    def confirm(self, motionless_s: float, *, lying: bool) -> bool:
        """Return True once for a fall: the wearer has stayed down after the impact.

        To be asked after every window of motion, from the one with the blow on.
        """
        if self._seen_ns is None:
            return False
        self._seen_ns += WINDOW_NS
        walked_on = self._strides >= _WALKING_STRIDES and not lying
        down = motionless_s >= _DOWN_FOR_S and not walked_on
        if down or self._seen_ns > _DOWN_WITHIN_NS:
            self._seen_ns = None
        return down

    def _step(self, t_ns: int, force_mps2: float) -> None:
        if isnan(force_mps2):
            return  # a sample that was missed does not end a drop
        if force_mps2 < _WEIGHTLESS_MPS2:
            continues = 0 <= t_ns - self._weightless_ns <= _HOLE_NS
            self._weightless_ns = t_ns
            if self._weightless_since_ns is None or not continues:
                self._weightless_since_ns = t_ns
            if t_ns - self._weightless_since_ns >= _WEIGHTLESS_NS:
                self._weightless_until_ns = t_ns
            return
        self._weightless_since_ns = None
        dropped_ns = self._weightless_until_ns
        if (
            force_mps2 > _IMPACT_MPS2
            and dropped_ns is not None
            and 0 <= t_ns - dropped_ns <= _IMPACT_WITHIN_NS
        ):
            self._impact_ns = t_ns
            self._seen_ns = self._strides = 0
