"""Straight legs of a path, and what they tell of the walls of a building at right angles.

People inside walk along walls, two ways at right angles (Borenstein and Ojeda 2009, Heuristic
drift elimination), but not always.  So a direction that walls may have is weighed by all legs of
late at once: each is along a wall or any way at all (a mixture on a grid over a quarter turn), and
those that cross a room do not agree with each other.
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

LOOK_M = 0.4  # way after which the direction is looked at
BENT_RAD = math.radians(25.0)  # from the leg so far: another one begins
LEG_M = 2.5  # at least
LONG_M = 6.0  # and a longer one is told of in parts
LEG_STD_RAD = math.radians(3.0)  # nobody walks on lines
ASIDE_M = 0.2
QUARTER_RAD = math.pi / 2.0
ALONG_WALLS = 0.6  # of the legs, before anything is known of one
SHOWN = 3.0  # log odds from which they show an axis
TRIALS = 2.4  # of log odds that some axis fits by chance: a quarter turn by a leg's width
WANDER_VAR_PER_S = 0.004**2  # of an own heading beside its drift, while moving
CELLS = 44  # of a quarter turn
RATES = np.linspace(-2.0, 2.0, 7)  # of drift, in standard deviations from what is believed
ASTRAY = 0.02  # of what is believed of a direction: that it is quite another
OFF = 2.5  # standard deviations from a direction: not that one


class Leg(msgspec.Struct, frozen=True):
    """A straight piece of the own path."""

    direction_rad: float
    length_m: float
    turn_rad: float = 0.0  # the heading correction believed when it was walked
    turn_variance: float = 0.0
    moved_s: float = 0.0  # how long the wearer had moved by then

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
    """Of a building; directions a quarter turn apart are the same."""

    direction_rad: float
    variance: float


class Drift(NamedTuple):
    """Of an own heading while its wearer moves: what is believed of its rate."""

    radps: float = 0.0
    variance: float = 0.0


class Shown(NamedTuple):
    """What legs show of an axis in the own frame, as it lies at the end of the last one."""

    evidence: float  # log odds of walls against legs of any direction
    direction_rad: float
    variance: float
    kept: float  # of the belief: that it is the one that was held before


def shown_by(legs: Sequence[Leg], drift: Drift, held: Axis | None) -> Shown:
    """``held``: what was believed before; None: any direction is as likely."""
    since_s = legs[-1].moved_s - np.array([leg.moved_s for leg in legs])
    std_radps = math.sqrt(drift.variance)
    rates_radps = drift.radps + std_radps * RATES
    now_rad = np.array([leg.direction_rad for leg in legs])[:, None]
    now_rad = now_rad - rates_radps * since_s[:, None]  # (legs, rates)
    variances = np.array([leg.variance for leg in legs]) + WANDER_VAR_PER_S * since_s
    variances += (std_radps * (RATES[1] - RATES[0]) * since_s) ** 2 / 12.0
    step_rad = QUARTER_RAD / CELLS
    quarters = 1 if held is None else 2  # past an eighth of a turn it may be the next wall
    cells = step_rad * np.arange(-quarters * CELLS // 2, quarters * CELLS // 2 + quarters - 1)
    about_rad = float(now_rad[-1, 0]) if held is None else held.direction_rad
    odds = _odds(now_rad[..., None] - about_rad - cells, variances[:, None, None]).sum(axis=0)
    likely = np.exp(-0.5 * RATES**2) @ np.exp(odds - odds.max()) / np.exp(-0.5 * RATES**2).sum()
    if held is None:
        best = int(likely.argmax())
        about_rad += float(cells[best])
        likely = np.roll(likely, CELLS // 2 - best)
        before = np.full(CELLS, 1.0 / CELLS)
    else:
        spread = held.variance + step_rad**2 / 12.0  # a cell stands for its width
        before = np.exp(-0.5 * cells**2 / spread)
        near = np.abs(cells) < QUARTER_RAD / 2.0
        before = (1.0 - ASTRAY) * before / before.sum() + ASTRAY * near / near.sum()
    believed = before * likely
    whole = float(believed.sum())
    believed /= whole
    mean_rad = float(believed @ cells)
    variance = float(believed @ (cells - mean_rad) ** 2) + step_rad**2 / 12.0
    kept = 0.0
    if held is not None:
        kept = float(believed[cells**2 < OFF**2 * held.variance + step_rad**2].sum())
    evidence = math.log(whole) + float(odds.max())
    return Shown(evidence, about_rad + mean_rad, variance, kept)


Angle = TypeVar("Angle", float, Floats)


def remember(legs: list[Leg], leg: Leg) -> None:
    """One leg after each turn: to and fro along a line shows no right angle."""
    if legs and abs(wrap_pi(2.0 * (leg.direction_rad - legs[-1].direction_rad))) < 2.0 * BENT_RAD:
        legs.pop()
    legs.append(leg)


def evidence(legs: Sequence[Leg], axis: Axis) -> float:
    """Log odds of walls with such an axis against legs of any direction."""
    off_rad = np.array([leg.direction_rad for leg in legs]) - axis.direction_rad
    variances = axis.variance + np.array([leg.variance for leg in legs])
    return float(_odds(off_rad, variances).sum())


def along_wall(off_rad: float, spread: float) -> float:
    """Probability that a leg so far off an axis follows it."""
    fits = math.exp(-0.5 * off_rad**2 / spread) / math.sqrt(math.tau * spread)
    return ALONG_WALLS * fits / (ALONG_WALLS * fits + (1.0 - ALONG_WALLS) / QUARTER_RAD)


def quarter(angle_rad: Angle) -> Angle:
    """The nearest that is as good, within an eighth of a turn."""
    return (angle_rad + QUARTER_RAD / 2.0) % QUARTER_RAD - QUARTER_RAD / 2.0


def _odds(off_rad: Floats, variances: Floats) -> Floats:
    """Log odds of legs so far off an axis."""
    fits = np.exp(-0.5 * quarter(off_rad) ** 2 / variances) / np.sqrt(math.tau * variances)
    return np.asarray(np.log(ALONG_WALLS * fits * QUARTER_RAD + 1.0 - ALONG_WALLS))


def _direction(vector_m: tuple[float, float]) -> float:
    return math.atan2(vector_m[1], vector_m[0])
