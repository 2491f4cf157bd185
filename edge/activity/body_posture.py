"""Posture of the body, from the sensors on trunk, thigh and shank, whichever of them there are.

A filter over the patterns of ``posture_model``: a posture goes on more often than not, and each
half second of inclinations changes the belief.  What the sensors there are cannot tell apart is
reported together: upright, or lying.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from edge.activity.inclination import InclinationFilter, InclinationWindow
from edge.activity.posture_model import PATTERNS, RARE, SegmentObservation, log_likelihoods
from edge.activity.segment_axes import Segment, SegmentAxes
from edge.activity.walk_direction import WalkDirection
from edge.samples import Floats, ImuBatch
from shared.clock import NS_PER_S
from shared.messages import BodyPosture, Mobility

SEGMENT_OF_PLACE: Mapping[str, Segment] = {
    "lower_back": "trunk",
    "torso": "trunk",
    "waist": "trunk",
    "hip": "trunk",
    "chest": "trunk",
    "thigh": "thigh",
    "pocket": "thigh",
    "shank": "shank",
}

_STAYS = 0.95  # probability, from one window to the next
_TEMPERED = 0.5  # windows in a row say much the same
_SILENT_NS = 2 * NS_PER_S  # since the last window of a segment
_TOLD_APART = 0.85  # share of one posture in those that are reported together
_BELIEVED = 0.5
_TOGETHER: Mapping[BodyPosture, frozenset[BodyPosture]] = {
    BodyPosture.UPRIGHT: frozenset(
        {BodyPosture.STANDING, BodyPosture.SITTING, BodyPosture.KNEELING}
    ),
    BodyPosture.LYING: frozenset(
        {
            BodyPosture.PRONE,
            BodyPosture.SUPINE,
            BodyPosture.LEFT_SIDE,
            BodyPosture.RIGHT_SIDE,
        }
    ),
}


class BodyPostureEstimator:
    """Estimator of one wearer; takes the samples of each sensor in order."""

    def __init__(self, mounts: Mapping[str, Floats] | None = None) -> None:
        """``mounts``: by place, the rotation (3, 3) from sensor axes to forward, right, up of the
        segment, where it is known; it is corrected by walking.
        """
        self._mounts = mounts or {}
        self._filters: dict[str, InclinationFilter] = {}
        self._axes: dict[str, SegmentAxes] = {}
        self._latest: dict[str, InclinationWindow] = {}
        self._belief = _prior()
        self._window_ns: int | None = None
        self._direction = WalkDirection()

    def push(self, place: str, imu: ImuBatch) -> None:
        """Take samples of the sensor at ``place``; those elsewhere tell nothing."""
        segment = SEGMENT_OF_PLACE.get(place)
        if segment is None:
            return
        if place not in self._filters:
            self._filters[place] = InclinationFilter()
            self._axes[place] = SegmentAxes(segment, self._mounts.get(place))
        for window in self._filters[place].push(imu):
            axes = self._axes[place]
            direction_b = axes.push(window)
            self._latest[place] = window
            if segment == "trunk":
                self._direction.push(window, axes, direction_b)
            if self._window_ns is None or window.end_ns != self._window_ns:
                self._step(window.end_ns)

    def posture(self, t_ns: int) -> tuple[BodyPosture, float]:
        """Return the posture and its probability; UNKNOWN, 0 while nothing is known of it."""
        if self._window_ns is None or not self._observed(t_ns):
            return BodyPosture.UNKNOWN, 0.0
        beliefs: dict[BodyPosture, float] = {}
        for pattern, belief in zip(PATTERNS, self._belief.tolist(), strict=True):
            beliefs[pattern.posture] = beliefs.get(pattern.posture, 0.0) + belief
        best = max(beliefs, key=beliefs.__getitem__)
        for name, members in _TOGETHER.items():
            together = sum(beliefs[one] for one in members)
            if best in members and beliefs[best] < _TOLD_APART * together:
                best, beliefs[name] = name, together
        if beliefs[best] < _BELIEVED:
            return BodyPosture.UNKNOWN, 0.0
        return best, beliefs[best]

    def mobility(self, t_ns: int) -> Mobility:
        """Return how the wearer goes, by the trunk; UNKNOWN without a sensor there."""
        return self._direction.mobility(t_ns)

    def _step(self, end_ns: int) -> None:
        """Advance to a window; of a segment whose window comes later the one before counts."""
        before_ns, self._window_ns = self._window_ns, end_ns
        if before_ns is not None and not 0 < end_ns - before_ns <= _SILENT_NS:
            self._belief = _prior()
        observed = self._observed(end_ns)
        if not observed:
            return
        predicted = _STAYS * self._belief + (1.0 - _STAYS) * _prior()
        logs = _TEMPERED * log_likelihoods(observed)
        belief = predicted * np.exp(logs - logs.max())
        self._belief = belief / belief.sum()

    def _observed(self, t_ns: int) -> dict[Segment, SegmentObservation]:
        observed: dict[Segment, SegmentObservation] = {}
        for place, window in self._latest.items():
            axes = self._axes[place]
            if not axes.has_up_axis or abs(t_ns - window.end_ns) > _SILENT_NS:
                continue
            observed[SEGMENT_OF_PLACE[place]] = SegmentObservation(
                axes.inclination(window.up_b), axes.has_forward_axis, window.moving
            )
        return observed


def _prior() -> Floats:
    """Return the beliefs of the patterns (n,) where nothing was observed."""
    postures = [pattern.posture for pattern in PATTERNS]
    shares = [RARE.get(posture, 1.0) / postures.count(posture) for posture in postures]
    return np.array(shares) / sum(shares)
