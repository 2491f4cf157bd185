"""Posture of the foot: as when standing, or tipped over as in crawling and lying.

Standing is not given: the first rest is taken for it, and the footfalls of long strides,
which are impossible on hands and knees, correct it.
"""

from __future__ import annotations

from collections import deque

import numpy as np

from edge.activity.body_motion import WINDOW_NS, BodyMotionWindow, cosine
from edge.activity.strides import Stride
from edge.samples import Floats
from shared.clock import NS_PER_S

_LONG_STRIDE_M = 0.8
_LEARNT_SHARE = 0.2  # of a footfall in the standing posture
_UPRIGHT_COS = 0.97
_TIPPED_COS = 0.6  # 53 degrees or more from standing
_TIPPED_STEP_COS = 0.77  # 40 degrees: more than any shoe rolls while it carries the wearer
_LYING_AFTER_S = 2.0
_KNEELING_S = 6.0  # someone who crawls may rest on hands and knees for so long
_SAME_COS = 0.8
_CRAWL_STRIDE_M = 0.1  # who stirs where they lie puts the foot down where it was
_SUDDEN_NS = 2 * NS_PER_S  # from upright to rest
_SUDDEN_RADPS = 2.4  # faster than the foot tips when a person lies or kneels down
_COLLAPSED_S = 1.0
_TIPPED_FOR_NS = 3 * NS_PER_S // 2
_LATE_NS = 10 * NS_PER_S  # a stride is reported sooner; an older one is of a clock that was set


class Posture:
    """Estimator that takes windows of motion and strides as they come."""

    def __init__(self) -> None:
        self._standing_b: Floats | None = None  # (3,) up, of length 1 or less
        self._upright_ns: int | None = None
        self._tipped_since_ns: int | None = None
        self._now_ns = 0
        self._rest_ns: int | None = None  # since when nothing moves
        self._peaks: deque[tuple[int, float]] = deque(maxlen=16)  # (start, rate) of each window
        self._crawl_step_b: Floats | None = None  # up at the last step on hands and knees
        self.tipped_step = False  # the last one came down on the toes or on the side
        self.crawling = False  # the last two that got on were tipped the same way
        self.lying = False
        self.collapsed = False  # went down suddenly and has not moved since

    @property
    def tipped(self) -> bool:
        """True when the foot has not been held as in standing for longer than a swing lasts."""
        since_ns = self._tipped_since_ns
        return since_ns is not None and not 0 <= self._now_ns - since_ns < _TIPPED_FOR_NS

    def is_walking_step(self, stride: Stride) -> bool:
        """Return True for a step that only a standing person makes."""
        return (
            self._standing_b is not None
            and stride.length_m >= _LONG_STRIDE_M
            and cosine(stride.up_b, self._standing_b) >= _TIPPED_STEP_COS
        )

    def take_stride(self, stride: Stride) -> None:
        if stride.length_m >= _LONG_STRIDE_M:
            standing_b = self._standing_b if self._standing_b is not None else stride.up_b
            self._standing_b = standing_b + _LEARNT_SHARE * (stride.up_b - standing_b)
        self.tipped_step = self._is_tipped_step(stride)
        if not self.tipped_step:
            self._stand(stride.end_ns)
            self._end_crawl()
        elif stride.length_m > _CRAWL_STRIDE_M:
            before_b, self._crawl_step_b = self._crawl_step_b, stride.up_b
            # One such step may be that of someone who lies down.
            self.crawling = before_b is not None and cosine(before_b, stride.up_b) > _SAME_COS
            if self.crawling:
                self.lying = self.collapsed = False  # it was a rest on hands and knees

    def take_window(self, window: BodyMotionWindow, motionless_s: float) -> None:
        """Take the next half second; ``motionless_s`` counts it."""
        self._now_ns = window.end_ns
        start_ns = window.end_ns - WINDOW_NS
        self._peaks.append((start_ns, window.peak_rate_radps))
        if window.moving:
            self._rest_ns = None
        elif self._rest_ns is None:
            self._rest_ns = start_ns
        weight_mps2 = float(np.linalg.norm(window.force_mps2))
        if self._standing_b is None and not window.moving and weight_mps2 > 0.0:
            self._standing_b = window.force_mps2 / weight_mps2
        if self._standing_b is None:
            return
        cos = cosine(window.force_mps2, self._standing_b)
        if cos > _UPRIGHT_COS:
            self._stand(window.end_ns)
            if not window.moving:  # they have got up, and go down from there anew
                self._end_crawl()
        if cos > _TIPPED_COS:
            self.lying = self.collapsed = False
            self._tipped_since_ns = None
            return
        if self._tipped_since_ns is None:
            self._tipped_since_ns = window.end_ns
        self._hold_tipped(window, motionless_s)

    def _hold_tipped(self, window: BodyMotionWindow, motionless_s: float) -> None:
        step_b = self._crawl_step_b
        kneeling = (
            self.crawling and step_b is not None and cosine(step_b, window.force_mps2) > _SAME_COS
        )
        if motionless_s >= (_KNEELING_S if kneeling else _LYING_AFTER_S):
            self.lying = True
        self.collapsed = motionless_s >= _COLLAPSED_S and not kneeling and self._fell_suddenly()

    def _fell_suddenly(self) -> bool:
        upright_ns, rest_ns = self._upright_ns, self._rest_ns
        if upright_ns is None or rest_ns is None or rest_ns - upright_ns > _SUDDEN_NS:
            return False
        rates_radps = (rate for start_ns, rate in self._peaks if upright_ns <= start_ns < rest_ns)
        return max(rates_radps, default=0.0) > _SUDDEN_RADPS

    def _is_tipped_step(self, stride: Stride) -> bool:
        return (
            self._standing_b is not None
            and stride.length_m < _LONG_STRIDE_M
            and cosine(stride.up_b, self._standing_b) < _TIPPED_STEP_COS
        )

    def _end_crawl(self) -> None:
        self._crawl_step_b, self.crawling = None, False

    def _stand(self, t_ns: int) -> None:
        if self._upright_ns is None or not 0 <= self._upright_ns - t_ns <= _LATE_NS:
            self._upright_ns = t_ns
