"""Activity monitor: still, walking, running, on stairs, crawling, lying, falling.

The tracker's strides say how one moves, by their speed, their rise and the tilt of the foot
as it comes down; the accelerometer alone says whether one moves at all and how the foot is
held.  Rows come up to a second after their samples, so an end is found in the samples.
"""

from __future__ import annotations

from collections import deque

from edge.activity.body_motion import WINDOW_NS, BodyMotion, BodyMotionWindow, by_window
from edge.activity.falls import FallDetector
from edge.activity.posture import Posture
from edge.activity.pressure_height import PressureHeight
from edge.activity.step_direction import StepDirection
from edge.activity.strides import Stride, StrideCutter
from edge.samples import ImuBatch
from edge.tracker.interface import TrackBatch
from shared.clock import NS_PER_S
from shared.messages import Activity, Mobility

_CADENCE_OVER_NS = 4 * NS_PER_S
_WALKING_TIMEOUT_NS = 5 * NS_PER_S // 2  # after the last footfall that is known
_AT_REST_S = 1.0  # longer than a foot stands still in any stride
_SILENT_NS = 2 * NS_PER_S  # since the last samples: who knows what has become of the wearer
_STIRRING_S = 1.0  # of motion before the first stride of a walk is known
_RUNNING_MPS = 2.0  # people change from walking to running here (Hreljac 1995)
_RUNNING_PERIOD_S = 0.8
_RUNNING_STRIDE_M = 0.9
_LATE_NS = 2 * NS_PER_S  # no row comes later
_FASTEST_MPS = 12.0  # nobody is faster
_STAIR_RISE_M = 0.11
_STAIR_SLOPE = 0.25  # steeper than ramps, flatter than stairs
_STAIRS_KEPT = 8  # strides: about a storey
_CHECKED_FROM_M = 1.0  # of stairs: less is lost in the barometer's noise
_CONFIRMED_SHARE = 0.3  # of the rise that the barometer must have seen
_COLLAPSED_S = 4.0  # motionless after going down suddenly


class ActivityMonitor:
    """Monitor that takes samples and tracker rows of one unit, in order."""

    def __init__(self) -> None:
        self._motion = BodyMotion()
        self._falls = FallDetector()
        self._posture = Posture()
        self._cutter = StrideCutter()
        self._directions = StepDirection()
        self._pressure_height = PressureHeight()
        self._strides: deque[Stride] = deque()
        self._stairs: list[Stride] = []  # the strides in a row that were stairs
        self._activity = Activity.STILL
        self._stride_count = 0
        self._stirring_s = 0.0
        self._window_ns: int | None = None  # the end of the last one
        self._moved_ns = 0  # the end of the last one that moved
        self._fall_reported = False

    @property
    def motionless_s(self) -> float:
        return self._motion.motionless_s

    @property
    def moving_s(self) -> float:
        return self._motion.moving_s

    def note_press(self) -> None:
        """Take a press of the button for motion: it cancels the no-motion pre-alert."""
        self._motion.note_motion()

    @property
    def steps(self) -> int:
        """Steps of both feet; the unit counts the strides of one, also those on the spot."""
        return 2 * self._stride_count

    def push(self, imu: ImuBatch, track: TrackBatch) -> int:
        """Take one batch and the rows that came out of it; return the falls confirmed."""
        for stride in self._cutter.push(track):
            self._take_stride(stride)
        if not len(imu):
            return 0
        self._pressure_height.push(imu)
        confirmed = 0
        for part in by_window(imu):  # in order: no blow is judged by what was before it
            confirmed += sum(self._take_window(window) for window in self._motion.push(part))
            self._falls.push(part)
        return confirmed

    def cadence_hz(self, t_ns: int) -> float:
        """Return steps a second over the last strides; 0 once the wearer has stopped."""
        if not self._is_striding(t_ns):
            return 0.0
        return 2.0 * len(self._strides) / sum(stride.period_s for stride in self._strides)

    def activity(self, t_ns: int) -> Activity:
        if self._window_ns is None or t_ns - self._window_ns > _SILENT_NS:
            return Activity.UNKNOWN
        if self._falls.falling:
            return Activity.FALLING
        if self._posture.lying:
            return Activity.LYING
        if self._posture.collapsed:
            return Activity.FALLING
        return self._upright_or_crawling(t_ns)

    def mobility(self, t_ns: int) -> Mobility:
        """Return the way in which the foot steps; UNKNOWN without samples."""
        if self._window_ns is None or t_ns - self._window_ns > _SILENT_NS:
            return Mobility.UNKNOWN
        if self._motion.motionless_s >= _AT_REST_S:
            return Mobility.STILL
        return self._directions.mobility(t_ns) or Mobility.MOVING

    def _upright_or_crawling(self, t_ns: int) -> Activity:
        resting = self._motion.motionless_s >= _AT_REST_S
        # On hands and knees one goes on crawling after a rest.
        if self._posture.tipped and (self._posture.crawling or not resting):
            return Activity.CRAWLING
        if self._is_striding(t_ns):
            return self._activity
        return Activity.WALKING if self._stirring_s >= _STIRRING_S else Activity.STILL

    def _take_stride(self, stride: Stride) -> None:
        if self._is_without_motion(stride):
            return
        self._posture.take_stride(stride)
        self._directions.push(stride)
        if self._posture.is_walking_step(stride) and stride.speed_mps <= _FASTEST_MPS:
            self._falls.walk(stride)
        self._activity = self._kind(stride)
        self._stride_count += 1
        self._strides.append(stride)
        while not 0 <= stride.end_ns - self._strides[0].end_ns <= _CADENCE_OVER_NS:
            self._strides.popleft()

    def _is_without_motion(self, stride: Stride) -> bool:
        """A tracker whose samples are poor loses its stances also while the foot rests."""
        if self._window_ns is None or not 0 <= self._window_ns - stride.end_ns <= _LATE_NS:
            return False  # what it did is not known yet, or of a clock that was set
        began_ns = stride.end_ns - round(stride.period_s * NS_PER_S)
        return began_ns >= self._moved_ns

    def _kind(self, stride: Stride) -> Activity:
        if self._posture.crawling:
            return Activity.CRAWLING
        if self._posture.tipped_step or stride.speed_mps > _FASTEST_MPS:
            return self._activity  # a stumble, someone who lies down, or a tracker that is lost
        if self._is_on_stairs(stride):
            return Activity.STAIRS_UP if stride.rise_m > 0.0 else Activity.STAIRS_DOWN
        quick = stride.period_s < _RUNNING_PERIOD_S and stride.length_m > _RUNNING_STRIDE_M
        return Activity.RUNNING if quick or stride.speed_mps > _RUNNING_MPS else Activity.WALKING

    def _is_on_stairs(self, stride: Stride) -> bool:
        steep = abs(stride.rise_m) > _STAIR_SLOPE * stride.length_m
        if not steep or abs(stride.rise_m) <= _STAIR_RISE_M:
            self._stairs.clear()
            return False
        if self._stairs and self._stairs[-1].rise_m * stride.rise_m < 0.0:
            self._stairs.clear()
        self._stairs.append(stride)
        del self._stairs[:-_STAIRS_KEPT]
        return not self._contradicts_pressure()

    def _contradicts_pressure(self) -> bool:
        """A tracker that has lost its way may climb where the air does not."""
        first, last = self._stairs[0], self._stairs[-1]
        rise_m = sum(stride.rise_m for stride in self._stairs[1:])
        if abs(rise_m) < _CHECKED_FROM_M:
            return False
        climbed_m = self._pressure_height.climbed_m(first.end_ns, last.end_ns)
        return climbed_m is not None and climbed_m / rise_m < _CONFIRMED_SHARE

    def _take_window(self, window: BodyMotionWindow) -> bool:
        """Return True where the window confirms a fall."""
        self._window_ns = window.end_ns
        if window.moving:
            self._moved_ns = window.end_ns
        self._stirring_s = self._stirring_s + WINDOW_NS / NS_PER_S if window.moving else 0.0
        motionless_s = self._motion.motionless_s
        self._posture.take_window(window, motionless_s)
        struck = self._falls.confirm(motionless_s, lying=self._posture.lying)
        collapsed = self._posture.collapsed and motionless_s >= _COLLAPSED_S
        if not (struck or collapsed):
            self._fall_reported = self._fall_reported and not window.moving
            return False
        confirmed, self._fall_reported = self._fall_reported, True
        return not confirmed

    def _is_striding(self, t_ns: int) -> bool:
        if not self._strides or self._motion.motionless_s >= _AT_REST_S:
            return False
        return abs(t_ns - self._strides[-1].end_ns) <= _WALKING_TIMEOUT_NS
