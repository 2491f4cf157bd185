"""What the wearer does, in few words: still, walking, running, lying, falling.

Strides come from the tracker, stillness and posture from the accelerometer.  Lying is told
by the foot: its tilt while it rests is compared with the tilt it has between strides.
"""

from __future__ import annotations

from collections import deque

import numpy as np

from edge.body_motion import BodyMotion, MotionWindow, cosine
from edge.falls import FallDetector
from edge.samples import Floats, ImuBatch
from edge.tracker.port import TrackBatch
from shared.clock import NS_PER_S
from shared.messages import Activity

_CADENCE_OVER_NS = 4 * NS_PER_S
_WALKS_FOR_NS = 5 * NS_PER_S // 2  # after the last stride
_RUNNING_STEPS_HZ = 2.4
_LYING_COS = 0.6  # the foot rests 53 degrees or more from where it stands
_LYING_AFTER_S = 2.0
_COLLAPSE_NS = 2 * NS_PER_S  # from the last stride to rest
_STANCE_SHARE = 0.1  # of a new window in the learned tilt


class ActivityMonitor:
    """Takes the samples and the tracker's rows of one unit, in order."""

    def __init__(self) -> None:
        self._motion = BodyMotion()
        self._falls = FallDetector()
        self._strides: deque[tuple[int, int]] = deque()  # (time, strides so far) as they rise
        self._stride_count = 0
        self._standing_force_mps2: Floats | None = None
        self._resting_force_mps2: Floats | None = None
        self._collapse_told = False
        self._seen = False

    @property
    def motionless_s(self) -> float:
        return self._motion.motionless_s

    @property
    def steps(self) -> int:
        """Of both feet; the unit counts the strides of one."""
        return 2 * self._stride_count

    def push(self, imu: ImuBatch, track: TrackBatch) -> int:
        """Take one batch and the rows that came out of it; return the falls confirmed."""
        self._take_strides(track)
        if not len(imu):
            return 0
        self._falls.push(imu)
        falls = 0
        for window in self._motion.push(imu):
            self._seen = True
            self._learn_posture(window)
            falls += self._falls.confirm(window.end_ns, self._motion.motionless_s)
            falls += self._has_collapsed(window.end_ns)
        return falls

    def cadence_hz(self, t_ns: int) -> float:
        """Steps a second over the last strides; 0 once the wearer has stopped."""
        if not self._is_striding(t_ns):
            return 0.0
        (first_ns, first), (last_ns, last) = self._strides[0], self._strides[-1]
        if last_ns <= first_ns:
            return 0.0
        return 2.0 * (last - first) * NS_PER_S / (last_ns - first_ns)

    def activity(self, t_ns: int) -> Activity:
        if not self._seen:
            return Activity.UNKNOWN
        if self._falls.falling:
            return Activity.FALLING
        if self._is_lying():
            return Activity.LYING
        if self._is_striding(t_ns):
            running = self.cadence_hz(t_ns) > _RUNNING_STEPS_HZ
            return Activity.RUNNING if running else Activity.WALKING
        return Activity.STILL

    def _take_strides(self, track: TrackBatch) -> None:
        rises = np.flatnonzero(np.diff(track.steps, prepend=self._stride_count) > 0)
        for row in rises.tolist():
            self._stride_count = int(track.steps[row])
            self._strides.append((int(track.t_ns[row]), self._stride_count))
        while self._strides and len(self._strides) > 1:
            if self._strides[-1][0] - self._strides[0][0] <= _CADENCE_OVER_NS:
                break
            self._strides.popleft()

    def _is_striding(self, t_ns: int) -> bool:
        return bool(self._strides) and abs(t_ns - self._strides[-1][0]) <= _WALKS_FOR_NS

    def _learn_posture(self, window: MotionWindow) -> None:
        """While the wearer walks, the foot's mean tilt is that of standing."""
        self._resting_force_mps2 = None if window.moving else window.force_mps2
        standing = self._standing_force_mps2
        if standing is None:
            if not window.moving:
                self._standing_force_mps2 = window.force_mps2
        elif window.moving and self._is_striding(window.end_ns):
            self._standing_force_mps2 = standing + _STANCE_SHARE * (window.force_mps2 - standing)

    def _has_collapsed(self, t_ns: int) -> bool:
        """From walking to lying without motion, faster than anyone lies down: True once."""
        if not self._is_lying():
            self._collapse_told = False
            return False
        if self._collapse_told or not self._strides:
            return False
        self._collapse_told = True
        took_ns = t_ns - self._strides[-1][0] - round(self._motion.motionless_s * NS_PER_S)
        return took_ns <= _COLLAPSE_NS

    def _is_lying(self) -> bool:
        resting, standing = self._resting_force_mps2, self._standing_force_mps2
        return (
            resting is not None
            and standing is not None
            and self._motion.motionless_s >= _LYING_AFTER_S
            and cosine(resting, standing) < _LYING_COS
        )
