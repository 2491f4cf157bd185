"""The directions of a building: people inside walk along its walls, two ways at right angles.

A straight leg of the own path is taken for one along a wall where it fits (Borenstein and Ojeda
2009, Heuristic drift elimination); then it tells how far the own heading has drifted since the
first ones.  The axis is not known beforehand; it is as good as the heading that somebody came in
with, and whoever came in with a better one tells the others.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TypeVar

import msgspec
import numpy as np
from numpy.typing import NDArray

from shared.geo import wrap_pi

LOOK_M = 0.4  # way after which the direction is looked at
BENT_RAD = math.radians(25.0)  # from the leg so far: another one begins
LEG_M = 2.5  # at least
LONG_M = 6.0  # and a longer one is told of in parts
LEG_STD_RAD = math.radians(3.0)  # nobody walks on lines
ASIDE_M = 0.2
QUARTER_RAD = math.pi / 2.0
ALONG_WALLS = 0.6  # of the legs, before anything is known of one
WINDOW = 8  # of the last legs, one after each turn, that are asked for an axis
SHOWN = 3.0  # log odds from which they show one
TRIALS = 2.4  # of log odds that some axis fits by chance: a quarter turn by a leg's width
OFF = 2.5  # standard deviations by which an axis that shows may be another
ABOUT_RAD = math.radians(8.0)  # what shows an axis tells no more of its direction
LOST_RAD = math.radians(20.0)  # the heading's doubt then
SHARED_STD_RAD = math.radians(1.0)  # walls of one building are not quite parallel


class Leg(msgspec.Struct, frozen=True):
    """A straight piece of the own path."""

    direction_rad: float
    length_m: float
    turn_rad: float = 0.0  # the heading correction believed when it was walked
    turn_variance: float = 0.0

    @property
    def variance(self) -> float:
        return LEG_STD_RAD**2 + (ASIDE_M / self.length_m) ** 2


class LegWatch(msgspec.Struct):
    """Cuts the own path into straight legs."""

    step_m: tuple[float, float] = (0.0, 0.0)
    leg_m: tuple[float, float] = (0.0, 0.0)

    def follow(self, north_m: float, east_m: float) -> Leg | None:
        """The own path went on by this much; gives a leg that is over."""
        step_m = self.step_m[0] + north_m, self.step_m[1] + east_m
        self.step_m = step_m
        if math.hypot(*step_m) < LOOK_M:
            return None
        self.step_m = 0.0, 0.0
        leg_m, length_m, ended = self.leg_m, math.hypot(*self.leg_m), None
        bent_rad = abs(wrap_pi(_direction(step_m) - _direction(leg_m)))
        if length_m > LONG_M or (length_m > 0.0 and bent_rad > BENT_RAD):
            ended = Leg(_direction(leg_m), length_m) if length_m > LEG_M else None
            leg_m = 0.0, 0.0
        self.leg_m = leg_m[0] + step_m[0], leg_m[1] + step_m[1]
        return ended


class Axis(msgspec.Struct, frozen=True):
    """Of a building, in the incident frame; directions a quarter turn apart are the same."""

    direction_rad: float
    variance: float

    def is_other(self, held: Axis) -> bool:
        off_rad = quarter(self.direction_rad - held.direction_rad)
        return off_rad**2 > OFF**2 * (self.variance + held.variance)


class AxisFilter(msgspec.Struct):
    """One unit's heading correction and the building's axis, as one normal distribution: what is
    not known of the one is not known of the other.
    """

    legs: list[Leg] = msgspec.field(default_factory=list)  # the last ones
    axis: Axis | None = None
    turn_variance: float = 0.0
    crossed: float = 0.0  # covariance of both

    def look(
        self, leg: Leg, turn_rad: float, variance: float, known: Axis | None = None
    ) -> tuple[float, float]:
        """Heading correction and variance after a leg, given what they were before: as far as the
        leg may be one along a wall (probabilistic data association, Bar-Shalom and Tse 1975).
        Where an axis is ``known`` to others, legs need only fit that one to show it.
        """
        remember(self.legs, msgspec.structs.replace(leg, turn_rad=turn_rad, turn_variance=variance))
        del self.legs[:-WINDOW]
        shown = shown_by(self.legs)
        if self.axis is None:
            if shown is not None:
                return self._begin(shown.direction_rad)
            if known is not None:
                there = Axis(known.direction_rad - turn_rad, known.variance + variance)
                if evidence(self.legs, there) > SHOWN:
                    return self._begin(there.direction_rad)
            return turn_rad, variance
        self._catch_up(variance)
        apart = variance - 2.0 * self.crossed + self.axis.variance
        held = Axis(self.axis.direction_rad - turn_rad, apart)
        if shown is not None and shown.is_other(held):
            self.legs.clear()  # they agree with each other, and not with what is held
            return turn_rad, variance + LOST_RAD**2
        if evidence(self.legs, held) < 0.0:
            return turn_rad, variance  # nobody walks along walls here
        return self._follow(leg, held, turn_rad, variance)

    def _follow(
        self, leg: Leg, held: Axis, turn_rad: float, variance: float
    ) -> tuple[float, float]:
        """``held``: the axis in the own frame."""
        assert self.axis is not None
        axis, spread = self.axis, held.variance + leg.variance
        off_rad = quarter(leg.direction_rad - held.direction_rad)
        along = along_wall(off_rad, spread)
        learnt = along * spread - along * (1.0 - along) * off_rad**2  # less where it may be none
        turn_gain = (variance - self.crossed) / spread
        axis_gain = (self.crossed - axis.variance) / spread
        self.crossed -= turn_gain * axis_gain * learnt
        self.axis = Axis(
            axis.direction_rad - along * axis_gain * off_rad, axis.variance - axis_gain**2 * learnt
        )
        self.turn_variance = variance - turn_gain**2 * learnt
        return turn_rad - along * turn_gain * off_rad, self.turn_variance

    def hear(self, other: Axis, turn_rad: float, variance: float) -> tuple[float, float]:
        """The same after another's word for the axis, which is worth no more than it says."""
        axis = self.axis
        if axis is None:
            return turn_rad, variance
        self._catch_up(variance)
        off_rad = quarter(other.direction_rad - axis.direction_rad)
        grown = axis.variance - other.variance
        same = off_rad**2 < 9.0 * (axis.variance + other.variance + SHARED_STD_RAD**2)
        if grown <= 0.0 or not same:
            return turn_rad, variance
        gain = grown / (grown + SHARED_STD_RAD**2)
        hangs_on = self.crossed / axis.variance
        self.axis = Axis(axis.direction_rad + gain * off_rad, axis.variance - gain * grown)
        self.crossed -= hangs_on * gain * grown
        self.turn_variance = variance - hangs_on**2 * gain * grown
        return turn_rad + hangs_on * gain * off_rad, self.turn_variance

    def _begin(self, direction_rad: float) -> tuple[float, float]:
        """The legs show an axis about this direction of the own frame.  It is as good as the
        heading was at the first of them, and tells what that has lost since: all are followed
        again.  Gives heading correction and variance after the last.
        """
        first = self.legs[0]
        about_rad = quarter(first.turn_rad + direction_rad)
        self.axis = Axis(about_rad, first.turn_variance + ABOUT_RAD**2)
        self.turn_variance = self.crossed = before = first.turn_variance
        corrected_rad = 0.0
        for leg in self.legs:
            self.turn_variance += max(0.0, leg.turn_variance - before)
            before = leg.turn_variance
            turn_rad, variance = leg.turn_rad + corrected_rad, self.turn_variance
            apart = variance - 2.0 * self.crossed + self.axis.variance
            held = Axis(self.axis.direction_rad - turn_rad, apart)
            corrected_rad = self._follow(leg, held, turn_rad, variance)[0] - leg.turn_rad
        return self.legs[-1].turn_rad + corrected_rad, self.turn_variance

    def _catch_up(self, variance: float) -> None:
        """What the heading lost since is its own; what it learnt elsewhere tells of the axis."""
        axis, was = self.axis, self.turn_variance
        if axis is not None and variance < was:
            left = variance / was
            told = self.crossed**2 / was * (1.0 - left)
            self.axis = Axis(axis.direction_rad, max(axis.variance - told, 1e-6))
            self.crossed *= left
        self.turn_variance = variance


Angle = TypeVar("Angle", float, NDArray[np.float64])


def remember(legs: list[Leg], leg: Leg) -> None:
    """One leg after each turn: to and fro along a line shows no right angle."""
    if legs and abs(wrap_pi(2.0 * (leg.direction_rad - legs[-1].direction_rad))) < 2.0 * BENT_RAD:
        legs.pop()
    legs.append(leg)


def evidence(legs: Sequence[Leg], axis: Axis) -> float:
    """Log odds of walls with such an axis against legs of any direction."""
    odds = 0.0
    for leg in legs:
        spread = axis.variance + leg.variance
        off_rad = quarter(leg.direction_rad - axis.direction_rad)
        fits = math.exp(-0.5 * off_rad**2 / spread) / math.sqrt(math.tau * spread)
        odds += math.log(ALONG_WALLS * fits * QUARTER_RAD + 1.0 - ALONG_WALLS)
    return odds


def along_wall(off_rad: float, spread: float) -> float:
    """Probability that a leg so far off an axis follows it."""
    fits = math.exp(-0.5 * off_rad**2 / spread) / math.sqrt(math.tau * spread)
    return ALONG_WALLS * fits / (ALONG_WALLS * fits + (1.0 - ALONG_WALLS) / QUARTER_RAD)


def shown_by(legs: Sequence[Leg]) -> Axis | None:
    """The axis that legs show by themselves."""
    about = [Axis(leg.direction_rad, leg.variance) for leg in legs]
    if not about:
        return None
    best = max(about, key=lambda axis: evidence(legs, axis))
    if evidence(legs, best) < SHOWN + TRIALS:
        return None
    offs_rad = [quarter(leg.direction_rad - best.direction_rad) for leg in legs]
    near = [
        (off_rad, leg.variance)
        for off_rad, leg in zip(offs_rad, legs, strict=True)
        if off_rad**2 < OFF**2 * (best.variance + leg.variance)
    ]
    weight = sum(1.0 / variance for _, variance in near)
    mean_rad = sum(off_rad / variance for off_rad, variance in near) / weight
    return Axis(best.direction_rad + mean_rad, 1.0 / weight)


def quarter(angle_rad: Angle) -> Angle:
    """The nearest that is as good, within an eighth of a turn."""
    return (angle_rad + QUARTER_RAD / 2.0) % QUARTER_RAD - QUARTER_RAD / 2.0


def _direction(vector_m: tuple[float, float]) -> float:
    return math.atan2(vector_m[1], vector_m[0])
