"""The directions of a building: people inside walk along its walls, two ways at right angles.

A straight leg of the own path is taken for one along a wall where it fits (Borenstein and Ojeda
2009, Heuristic drift elimination); then it tells how far the own heading has drifted since the
first ones.  The axis is not known beforehand; it is as good as the heading that somebody came in
with, and whoever came in with a better one tells the others.
"""

from __future__ import annotations

import math
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
CLEAR_M = 20.0  # of the last legs that are asked for an axis
CLEAR = 0.55  # of their length, summed as vectors of four times the angle: it shows
ALONG_WALLS = 0.6  # of the legs, before anything is known of one
OFF = 2.5  # standard deviations by which an axis that shows may be another
LOST_RAD = math.radians(20.0)  # the heading's doubt then
SHARED_STD_RAD = math.radians(1.0)  # walls of one building are not quite parallel


class Leg(msgspec.Struct, frozen=True):
    """A straight piece of the own path."""

    direction_rad: float
    length_m: float

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


class AxisFilter(msgspec.Struct):
    """One unit's heading correction and the building's axis, as one normal distribution: what is
    not known of the one is not known of the other.
    """

    legs: list[Leg] = msgspec.field(default_factory=list)  # until an axis shows
    axis: Axis | None = None
    turn_variance: float = 0.0
    crossed: float = 0.0  # covariance of both

    def look(self, leg: Leg, turn_rad: float, variance: float) -> tuple[float, float]:
        """Heading correction and variance after a leg, given what they were before: as far as the
        leg may be one along a wall (probabilistic data association, Bar-Shalom and Tse 1975).
        """
        shown_rad = self._shown(leg)
        if self.axis is None:
            if shown_rad is not None:
                self._begin(turn_rad + shown_rad, variance)
            return turn_rad, variance
        self._catch_up(variance)
        if shown_rad is not None and self._contradicts(turn_rad + shown_rad, variance):
            return turn_rad, variance + LOST_RAD**2
        axis = self.axis
        off_rad = quarter(turn_rad + leg.direction_rad - axis.direction_rad)
        spread = variance - 2.0 * self.crossed + axis.variance + leg.variance
        fits = math.exp(-0.5 * off_rad**2 / spread) / math.sqrt(math.tau * spread)
        along = ALONG_WALLS * fits / (ALONG_WALLS * fits + (1.0 - ALONG_WALLS) / QUARTER_RAD)
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

    def _shown(self, leg: Leg) -> float | None:
        """The axis, in the own frame, that the last legs show by themselves."""
        self.legs.append(leg)
        length_m = sum(one.length_m for one in self.legs)
        if length_m < CLEAR_M:
            return None
        four_rad = [4.0 * one.direction_rad for one in self.legs]
        whole_m = (
            sum(one.length_m * math.cos(a) for one, a in zip(self.legs, four_rad, strict=True)),
            sum(one.length_m * math.sin(a) for one, a in zip(self.legs, four_rad, strict=True)),
        )
        del self.legs[0]
        clear = math.hypot(*whole_m) > CLEAR * length_m
        return _direction(whole_m) / 4.0 if clear else None

    def _begin(self, axis_rad: float, variance: float) -> None:
        leg_var = sum(one.variance for one in self.legs) / len(self.legs) ** 2
        self.axis = Axis(quarter(axis_rad), variance + 2.0 * leg_var)
        self.turn_variance = self.crossed = variance
        self.legs.clear()

    def _contradicts(self, axis_rad: float, variance: float) -> bool:
        """The last legs agree with each other, and not with what is held."""
        assert self.axis is not None
        off_rad = quarter(axis_rad - self.axis.direction_rad)
        spread = variance - 2.0 * self.crossed + self.axis.variance + LEG_STD_RAD**2
        if off_rad**2 < OFF**2 * spread:
            return False
        self.legs.clear()
        return True

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


def quarter(angle_rad: Angle) -> Angle:
    """The nearest that is as good, within an eighth of a turn."""
    return (angle_rad + QUARTER_RAD / 2.0) % QUARTER_RAD - QUARTER_RAD / 2.0


def _direction(vector_m: tuple[float, float]) -> float:
    return math.atan2(vector_m[1], vector_m[0])
