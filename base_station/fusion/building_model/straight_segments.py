"""Straight segments of a path as measurements of the directions of walls at right angles.

Wearers inside often walk along walls (Borenstein and Ojeda 2009, heuristic drift elimination), but
not always. A direction of walls is therefore weighted by all recent segments together: each is
along a wall or in any direction (a mixture on a grid over a quarter turn), and segments that cross
rooms do not agree with each other.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple, TypeVar

import msgspec
import numpy as np
from numpy.typing import NDArray

from shared.geo import wrap_pi

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

LOOK_M = 0.4  # way after which the direction is looked at
BENT_RAD = math.radians(25.0)  # from the leg so far: another one begins
MIN_SEGMENT_M = 2.5  # at least
LONG_M = 6.0  # and a longer one is used in parts
SEGMENT_STD_RAD = math.radians(3.0)  # people do not walk on exact lines
ASIDE_M = 0.2
QUARTER_RAD = math.pi / 2.0
ALONG_WALLS = 0.6  # of the legs, before anything is known of one
SHOWN = 3.0  # log odds from which they show an axis
TRIALS = 2.4  # of log odds that some axis fits by chance: a quarter turn by a leg's width
WANDER_VAR_PER_S = 0.004**2  # of an own heading beside its drift, while moving
CELLS = 44  # of a quarter turn
STEP_RAD = QUARTER_RAD / CELLS
RATES = np.linspace(-2.0, 2.0, 5)  # of drift, in standard deviations from the estimate
ASTRAY = 0.02  # probability that a direction is another one entirely
OFF = 2.5  # standard deviations from a direction: not that one

_RATE_WEIGHTS = np.exp(-0.5 * RATES**2) / np.exp(-0.5 * RATES**2).sum()


class StraightSegment(msgspec.Struct, frozen=True):
    """A straight piece of the own path."""

    direction_rad: float
    length_m: float
    turn_rad: float = 0.0  # the heading correction estimated when it was walked
    turn_variance: float = 0.0
    moved_s: float = 0.0  # how long the wearer had moved by then

    @property
    def variance(self) -> float:
        return SEGMENT_STD_RAD**2 + (ASIDE_M / self.length_m) ** 2


class SegmentDetector(msgspec.Struct):
    """Cuts the own path into straight legs."""

    step_m: tuple[float, float] = (0.0, 0.0)
    segment_m: tuple[float, float] = (0.0, 0.0)

    def update(self, north_m: float, east_m: float) -> StraightSegment | None:
        """The own path went on by this much; gives a leg that is over."""
        step_m = self.step_m[0] + north_m, self.step_m[1] + east_m
        self.step_m = step_m
        if math.hypot(*step_m) < LOOK_M:
            return None
        self.step_m = 0.0, 0.0
        segment_m, length_m, ended = self.segment_m, math.hypot(*self.segment_m), None
        bent_rad = abs(wrap_pi(_direction(step_m) - _direction(segment_m)))
        if length_m > LONG_M or (length_m > 0.0 and bent_rad > BENT_RAD):
            ended = (
                StraightSegment(_direction(segment_m), length_m)
                if length_m > MIN_SEGMENT_M
                else None
            )
            segment_m = 0.0, 0.0
        self.segment_m = segment_m[0] + step_m[0], segment_m[1] + step_m[1]
        return ended


class Axis(msgspec.Struct, frozen=True):
    """Direction of a building's walls; directions a quarter turn apart are equal."""

    direction_rad: float
    variance: float


class Drift(NamedTuple):
    """Drift rate of an own heading while the wearer moves, with its variance."""

    radps: float = 0.0
    variance: float = 0.0


class DirectionEvidence(NamedTuple):
    """Evidence of segments for an axis in the own frame, at the end of the last segment."""

    evidence: float  # log odds of walls against legs of any direction
    direction_rad: float
    variance: float
    kept: float  # of the estimate: that it is the former one


class DirectionWeights(NamedTuple):
    """Likelihood ratio of segments by direction of the axis, against segments of any direction."""

    about_rad: float
    likely: Floats  # (CELLS,): in that direction, and ``STEP_RAD`` further with each cell

    @staticmethod
    def of(segments: Sequence[StraightSegment], drift: Drift, about_rad: float) -> DirectionWeights:
        """Weights with the drift rate integrated out."""
        since_s = segments[-1].moved_s - np.array([segment.moved_s for segment in segments])
        std_radps = math.sqrt(drift.variance)
        drifted_rad = np.outer(since_s, drift.radps + std_radps * RATES)  # (legs, rates)
        then_rad = np.array([segment.direction_rad for segment in segments]) - about_rad
        off_rad = wrap_quarter(
            (then_rad[:, None] - drifted_rad)[..., None] - STEP_RAD * np.arange(CELLS)
        )
        variances = (
            np.array([segment.variance for segment in segments]) + WANDER_VAR_PER_S * since_s
        )
        variances += (std_radps * (RATES[1] - RATES[0]) * since_s) ** 2 / 12.0
        fits = np.exp(off_rad**2 * (-0.5 / variances)[:, None, None])
        fits *= (ALONG_WALLS * QUARTER_RAD / np.sqrt(math.tau * variances))[:, None, None]
        by_rate = (fits + (1.0 - ALONG_WALLS)).prod(axis=0)
        return DirectionWeights(about_rad, _RATE_WEIGHTS @ by_rate)

    def with_flat_prior(self) -> DirectionEvidence:
        """Evidence with every direction equally likely beforehand."""
        best = int(self.likely.argmax())
        rows = np.arange(-CELLS // 2, CELLS // 2)
        weights = self.likely[(rows + best) % CELLS] / CELLS
        return _shown(self.about_rad + best * STEP_RAD, rows, weights, 0.0)

    def with_prior(self, variance: float) -> DirectionEvidence:
        """Evidence with a prior of this variance (rad^2) about ``about_rad``."""
        rows = np.arange(-CELLS, CELLS + 1)  # past an eighth of a turn it may be the next wall
        spread = variance / STEP_RAD**2
        before = np.exp(-0.5 * rows**2 / (spread + 1.0 / 12.0))  # a cell stands for its width
        near = np.abs(rows) < CELLS / 2.0
        before = (1.0 - ASTRAY) * before / before.sum() + ASTRAY * near / near.sum()
        weights = before * self.likely[rows % CELLS]
        kept = float(weights[rows**2 < OFF**2 * spread + 1.0].sum() / weights.sum())
        return _shown(self.about_rad, rows, weights, kept)


def _shown(about_rad: float, rows: Ints, weights: Floats, kept: float) -> DirectionEvidence:
    whole = float(weights.sum())
    weights = weights / whole
    mean = float(weights @ rows)
    variance = float(weights @ (rows - mean) ** 2) + 1.0 / 12.0
    return DirectionEvidence(
        math.log(whole), about_rad + mean * STEP_RAD, variance * STEP_RAD**2, kept
    )


Angle = TypeVar("Angle", float, Floats)


def append_segment(segments: list[StraightSegment], segment: StraightSegment) -> None:
    """One leg after each turn: to and fro along a line shows no right angle."""
    if (
        segments
        and abs(wrap_pi(2.0 * (segment.direction_rad - segments[-1].direction_rad)))
        < 2.0 * BENT_RAD
    ):
        segments.pop()
    segments.append(segment)


def evidence(segments: Sequence[StraightSegment], axis: Axis) -> float:
    """Log odds of walls with such an axis against legs of any direction."""
    odds = 0.0
    for segment in segments:
        spread = axis.variance + segment.variance
        off_rad = wrap_quarter(segment.direction_rad - axis.direction_rad)
        fits = math.exp(-0.5 * off_rad**2 / spread) / math.sqrt(math.tau * spread)
        odds += math.log(ALONG_WALLS * fits * QUARTER_RAD + 1.0 - ALONG_WALLS)
    return odds


def along_wall(off_rad: float, spread: float) -> float:
    """Probability that a leg so far off an axis follows it."""
    fits = math.exp(-0.5 * off_rad**2 / spread) / math.sqrt(math.tau * spread)
    return ALONG_WALLS * fits / (ALONG_WALLS * fits + (1.0 - ALONG_WALLS) / QUARTER_RAD)


def wrap_quarter(angle_rad: Angle) -> Angle:
    """The nearest that is as good, within an eighth of a turn."""
    return (angle_rad + QUARTER_RAD / 2.0) % QUARTER_RAD - QUARTER_RAD / 2.0


def _direction(vector_m: tuple[float, float]) -> float:
    return math.atan2(vector_m[1], vector_m[0])
