"""Postures by the inclinations of trunk, thigh and shank: their likelihoods.

Each posture has one or more patterns: where up is in the axes forward, right, up of each segment.
A segment's direction is spread about that of the pattern as of von Mises and Fisher; whether it
moves counts as well.  A small part is spread over all directions, as no body keeps to patterns.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos, exp, expm1, log, pi, radians, sin

import numpy as np

from edge.activity.segment_axes import Segment
from edge.samples import Floats
from shared.messages import BodyPosture

_SPREAD_RAD: Mapping[Segment, float] = {
    "trunk": radians(17.0),
    "thigh": radians(20.0),
    "shank": radians(20.0),
}
_OUTLIER_SHARE = 0.01  # of directions that are of no pattern


@dataclass(frozen=True, slots=True, eq=False)
class Pattern:
    """One way to hold the body in a posture."""

    posture: BodyPosture
    up: Mapping[Segment, Floats]  # (3,) each, unit vectors: forward, right, up
    moving: float  # probability that the segments move


def _tipped(back_deg: float) -> Floats:
    """Up in a segment that is tipped backward from upright; its front is up at 90 degrees."""
    return np.array([sin(radians(back_deg)), 0.0, cos(radians(back_deg))])


def _pattern(
    posture: BodyPosture, moving: float, trunk_deg: float, thigh_deg: float, shank_deg: float
) -> Pattern:
    up: dict[Segment, Floats] = {
        "trunk": _tipped(trunk_deg),
        "thigh": _tipped(thigh_deg),
        "shank": _tipped(shank_deg),
    }
    return Pattern(posture, up, moving)


def _on_side(posture: BodyPosture, right_up: float) -> Pattern:
    side = np.array([0.0, right_up, 0.0])
    return Pattern(posture, {"trunk": side, "thigh": side, "shank": side}, 0.1)


# Degrees by which trunk, thigh and shank are tipped backward from standing.
PATTERNS: tuple[Pattern, ...] = (
    _pattern(BodyPosture.STANDING, 0.4, 0.0, 0.0, 0.0),
    _pattern(BodyPosture.STANDING, 0.4, -25.0, 0.0, 0.0),
    _pattern(BodyPosture.SITTING, 0.4, 0.0, 85.0, 0.0),
    _pattern(BodyPosture.SITTING, 0.4, 15.0, 85.0, 45.0),  # legs stretched out
    _pattern(BodyPosture.SITTING, 0.4, 0.0, 90.0, 90.0),  # on the floor
    _pattern(BodyPosture.KNEELING, 0.4, 0.0, 0.0, -90.0),
    _pattern(BodyPosture.KNEELING, 0.4, -30.0, 15.0, -90.0),  # at work
    _pattern(BodyPosture.KNEELING, 0.4, 0.0, 65.0, -90.0),  # on the heels
    _pattern(BodyPosture.CRAWLING, 0.9, -80.0, 0.0, -90.0),
    _pattern(BodyPosture.CRAWLING, 0.9, -80.0, 25.0, -80.0),
    _pattern(BodyPosture.CRAWLING, 0.9, -80.0, -25.0, -95.0),
    _pattern(BodyPosture.BENT, 0.5, -60.0, 0.0, 0.0),
    _pattern(BodyPosture.PRONE, 0.1, -90.0, -90.0, -90.0),
    _pattern(BodyPosture.SUPINE, 0.1, 90.0, 90.0, 90.0),
    _pattern(BodyPosture.SUPINE, 0.1, 90.0, 135.0, 45.0),  # with bent knees
    _on_side(BodyPosture.LEFT_SIDE, 1.0),
    _on_side(BodyPosture.RIGHT_SIDE, -1.0),
)


RARE: Mapping[BodyPosture, float] = {BodyPosture.BENT: 0.4}  # beside how often the others are


@dataclass(frozen=True, slots=True, eq=False)
class SegmentObservation:
    """Observation of one segment in a window."""

    up: Floats  # (3,) forward, right, up; a unit vector
    has_forward_axis: bool  # False: forward and right may be turned about up by any angle
    moving: bool


def log_likelihoods(observed: Mapping[Segment, SegmentObservation]) -> Floats:
    """Return the log-likelihood of each of ``PATTERNS`` (n,)."""
    return np.array([_log_likelihood(pattern, observed) for pattern in PATTERNS])


def _log_likelihood(pattern: Pattern, observed: Mapping[Segment, SegmentObservation]) -> float:
    total = sum(
        _log_direction(segment, pattern.up[segment], one) for segment, one in observed.items()
    )
    moves = any(one.moving for one in observed.values())
    return total + log(pattern.moving if moves else 1.0 - pattern.moving)


def _log_direction(segment: Segment, expected: Floats, observed: SegmentObservation) -> float:
    """Return the logarithm of the density of a direction, by von Mises and Fisher."""
    concentration = 1.0 / _SPREAD_RAD[segment] ** 2
    if observed.has_forward_axis:
        along = float(expected @ observed.up)
    else:  # as if it were turned where it fits best
        level = float(np.hypot(*expected[:2]) * np.hypot(*observed.up[:2]))
        along = level + float(expected[2] * observed.up[2])
    peak = concentration / (2.0 * pi * -expm1(-2.0 * concentration))
    density = peak * exp(concentration * (along - 1.0))
    return log((1.0 - _OUTLIER_SHARE) * density + _OUTLIER_SHARE / (4.0 * pi))
