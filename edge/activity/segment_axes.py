"""Axes of a body segment in those of its sensor: given, or learnt from walking upright.

Up is where gravity is while the wearer walks.  Forward of a trunk is where its horizontal
acceleration goes in phase with its downward velocity: a walking body is fastest where it is lowest.
A leg turns about the axis from left to right, and faster forward, in the swing, than backward.
"""

from __future__ import annotations

from collections import deque
from typing import Literal

import numpy as np

from edge.activity.inclination import InclinationWindow
from edge.samples import Floats

Segment = Literal["trunk", "thigh", "shank"]

_WINDOWS = 6  # three seconds of walking are judged at once
_STEPS_HZ = (1.3, 2.8)  # of a walk; crawling is slower
_STEP_STD_MPS2 = (0.6, 8.0)  # of the vertical force
_LEG_STD_RADPS = 0.5
_STEADY_COS = 0.95  # of the inclination, from window to window
_LEG_STEADY_COS = 0.7
_STRAIGHT_RADPS = 0.35  # about up: who turns goes nowhere in particular
_PERIODIC = 0.5  # autocorrelation after a step, or a stride of a leg
_LEARNT_SHARE = 0.1  # of a new walk in the axes
_AGAINST_SHARE = 0.02  # of one in the opposite direction: people walk backward only shortly
_WORN_OTHERWISE_COS = 0.9  # of up and up as it was learnt, in two walks in a row
_FORWARD_WALKS = 2  # until the forward direction is used
_FORWARD_AGREES = 0.6  # length of their mean direction


class SegmentAxes:
    """Learner of one sensor."""

    def __init__(self, segment: Segment, rotation_sb: Floats | None = None) -> None:
        """``rotation_sb`` (3, 3) takes sensor axes to forward, right, up, where it is known."""
        self._segment = segment
        self._recent: deque[InclinationWindow] = deque(maxlen=_WINDOWS)
        self._up_b: Floats | None = None
        self._forward_b = np.zeros(3)
        self._walks = 0
        self._contradicted = False  # by the last walk
        self._is_given = rotation_sb is not None
        if rotation_sb is not None:
            self._forward_b, self._up_b = rotation_sb[0].copy(), rotation_sb[2].copy()
            self._walks = 1

    @property
    def has_up_axis(self) -> bool:
        return self._up_b is not None

    @property
    def has_forward_axis(self) -> bool:
        """True where front and sides are distinguished."""
        length = float(np.linalg.norm(self._forward_b))
        is_shown = self._is_given or self._walks >= _FORWARD_WALKS
        return is_shown and length >= _FORWARD_AGREES

    def inclination(self, up_b: Floats) -> Floats:
        """Return up (3,) in the segment's axes forward, right, up; forward and right are any two
        level ones where they are not known.
        """
        assert self._up_b is not None
        forward_b = _level(self._forward_b, self._up_b)
        right_b = np.cross(forward_b, self._up_b)
        return np.array([forward_b @ up_b, right_b @ up_b, self._up_b @ up_b])

    def push(self, window: InclinationWindow) -> Floats | None:
        """Take a window; return the direction of the walk, a unit vector (3,) in sensor axes,
        where the last seconds were one.
        """
        before = self._recent[-1] if self._recent else None
        if before is not None and window.end_ns <= before.end_ns:
            self._recent.clear()
        self._recent.append(window)
        if len(self._recent) < _WINDOWS:
            return None
        samples = np.vstack([one.samples for one in self._recent])
        up_b = np.mean([one.up_b for one in self._recent], axis=0)
        up_b /= np.linalg.norm(up_b)
        least = _STEADY_COS if self._segment == "trunk" else _LEG_STEADY_COS
        if min(float(one.up_b @ up_b) for one in self._recent) < least:
            return None
        if abs(float(samples[:, 4:7].mean(axis=0) @ up_b)) > _STRAIGHT_RADPS:
            return None
        direction_b = (
            _trunk_direction(samples, up_b)
            if self._segment == "trunk"
            else _leg_direction(samples, up_b)
        )
        if direction_b is not None:
            self._recent.clear()
            self._learn(up_b, direction_b)
        return direction_b

    def _learn(self, up_b: Floats, direction_b: Floats) -> None:
        """Learn up and forward from a walk: walkers are upright, and mostly go forward."""
        if self._up_b is not None and float(self._up_b @ up_b) < _WORN_OTHERWISE_COS:
            if not self._contradicted:
                self._contradicted = True
                return
            self._up_b, self._walks, self._is_given = None, 0, False
        self._contradicted = False
        self._walks += 1
        share = max(_LEARNT_SHARE, 1.0 / self._walks)
        if self._up_b is None:
            self._up_b, self._forward_b = up_b, direction_b
            return
        mean_b = self._up_b + share * (up_b - self._up_b)
        self._up_b = mean_b / np.linalg.norm(mean_b)
        if float(direction_b @ self._forward_b) < 0.0:
            share = max(_AGAINST_SHARE, 1.0 / self._walks**2)
        self._forward_b = self._forward_b + share * (direction_b - self._forward_b)


def _trunk_direction(samples: Floats, up_b: Floats) -> Floats | None:
    """Return the direction of a walk of a trunk; None where the samples (n, 7) are no walk."""
    t_s, force_mps2 = samples[:, 0], samples[:, 1:4]
    along_mps2 = force_mps2 @ up_b
    rise_mps2 = along_mps2 - along_mps2.mean()
    if not _STEP_STD_MPS2[0] < rise_mps2.std() < _STEP_STD_MPS2[1]:
        return None
    if _period_s(t_s, rise_mps2, _STEPS_HZ) is None:
        return None
    level_mps2 = force_mps2 - np.outer(along_mps2, up_b)
    step_s = np.diff(t_s, prepend=t_s[0])
    rise_mps = np.cumsum(rise_mps2 * step_s)
    rise_mps = rise_mps - np.polyval(np.polyfit(t_s - t_s[0], rise_mps, 2), t_s - t_s[0])
    return _unit(-(rise_mps @ (level_mps2 - level_mps2.mean(axis=0))), up_b)


def _leg_direction(samples: Floats, up_b: Floats) -> Floats | None:
    """Return the direction in which a leg swings; None where the samples (n, 7) are no walk."""
    rate_radps = samples[:, 4:7] - np.outer(samples[:, 4:7] @ up_b, up_b)
    rate_radps = rate_radps - rate_radps.mean(axis=0)
    _, axes = np.linalg.eigh(rate_radps.T @ rate_radps)
    right_b = axes[:, -1]
    swing_radps = rate_radps @ right_b
    if swing_radps.std() < _LEG_STD_RADPS:
        return None
    strides_hz = _STEPS_HZ[0] / 2.0, _STEPS_HZ[1] / 2.0
    if _period_s(samples[:, 0], swing_radps, strides_hz) is None:
        return None
    if float((swing_radps**3).sum()) < 0.0:
        right_b = -right_b
    return _unit(np.cross(up_b, right_b), up_b)


def _period_s(t_s: Floats, signal: Floats, band_hz: tuple[float, float]) -> float | None:
    """Return the period of a signal (n,) within a band; None where it has none."""
    interval_s = float(np.median(np.diff(t_s)))
    lags = np.arange(round(1.0 / band_hz[1] / interval_s), round(1.0 / band_hz[0] / interval_s) + 1)
    lags = lags[(lags > 0) & (lags < len(signal) // 2)]
    power = float(signal @ signal)
    if not len(lags) or power <= 0.0:
        return None
    scores = [
        float(signal[lag:] @ signal[:-lag]) / power * len(signal) / (len(signal) - lag)
        for lag in lags.tolist()
    ]
    best = int(np.argmax(scores))
    return float(lags[best]) * interval_s if scores[best] >= _PERIODIC else None


def _unit(vector: Floats, up_b: Floats) -> Floats | None:
    level = vector - float(vector @ up_b) * up_b
    length = float(np.linalg.norm(level))
    return np.asarray(level / length) if length > 0.0 else None


def _level(forward_b: Floats, up_b: Floats) -> Floats:
    """Return the unit vector of ``forward_b`` across ``up_b``; any one of a zero vector."""
    level = _unit(forward_b, up_b)
    if level is None:
        level = _unit(np.eye(3)[int(np.argmin(np.abs(up_b)))], up_b)
    assert level is not None
    return level
