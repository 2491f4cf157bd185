"""People walking with a unit that loses its way slowly and a receiver that errs slowly.

The errors are drawn by models of their own, not by the fuser's: the path's heading wanders by
distance and turning, its scale is a little wrong, each step adds a little; a fix's error is part
white and part slow, part of it common to all receivers where that is said, and its receiver is as
wrong as it says.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.interface import FixVerdict, Fuser, PlaceFix
from shared.messages import Header, Position
from tests.rig import message_factory
from tests.rig.incident.scores import CHI2_95_2DOF, normalised2
from tests.rig.incident.sensors import COMMON_S
from tests.rig.published_path import reckoned

Floats = NDArray[np.float64]
RATE_HZ = 5
SEEDS = range(16)


@dataclass(frozen=True)
class Errors:
    """Errors of the unit's own path and of its receiver."""

    heading_rad_per_sqrt_m: float = 0.003
    turn_part: float = 0.004
    scale_std: float = 0.02
    step_m_per_sqrt_m: float = 0.04
    fix_std_m: float = 3.0
    common_m: float = 0.0  # of that, what all receivers of the site share; the rest is its own
    slow_part: float = 0.6  # of its own
    slow_s: float = 25.0


@dataclass
class Walk:
    """Truth in the incident frame and the same in the unit's own frame."""

    truth_m: Floats  # (n, 2) north, east
    own_m: Floats  # (n, 2)
    turn_rad: float  # heading of the own north in the incident frame
    t_s: Floats  # (n,)
    distance_m: Floats  # (n,) truly walked

    @staticmethod
    def wander(rng: np.random.Generator, duration_s: float) -> Walk:
        """Now and then a new direction, now and then a rest, starting anywhere."""
        count = round(duration_s * RATE_HZ)
        heading_rad, speed_mps = rng.uniform(-math.pi, math.pi), 1.3
        steps = np.zeros((count, 2))
        turns = np.zeros(count)
        for index in range(count):
            if rng.random() < 0.03:
                turns[index] = rng.normal(0.0, 1.0)
                heading_rad += turns[index]
                speed_mps = 0.0 if rng.random() < 0.2 else rng.uniform(0.7, 1.6)
            steps[index] = (
                speed_mps / RATE_HZ * np.array([math.cos(heading_rad), math.sin(heading_rad)])
            )
        return Walk.of_steps(rng, steps, turns, Errors())

    @staticmethod
    def of_steps(rng: np.random.Generator, steps: Floats, turns: Floats, errors: Errors) -> Walk:
        count = len(steps)
        lengths = np.linalg.norm(steps, axis=1)
        turn_rad = rng.uniform(-math.pi, math.pi)
        wander = rng.normal(size=count) * errors.heading_rad_per_sqrt_m * np.sqrt(lengths)
        wander += rng.normal(size=count) * errors.turn_part * np.abs(turns)
        scale = 1.0 + rng.normal(0.0, errors.scale_std)
        own = scale * reckoned(steps, np.cumsum(wander) - turn_rad)
        own += rng.normal(size=(count, 2)) * errors.step_m_per_sqrt_m * np.sqrt(lengths)[:, None]
        begin = rng.uniform(-50.0, 50.0, size=2)
        return Walk(
            truth_m=begin + np.cumsum(steps, axis=0),
            own_m=np.cumsum(own, axis=0),
            turn_rad=turn_rad,
            t_s=(1 + np.arange(count)) / RATE_HZ,
            distance_m=np.cumsum(lengths),
        )

    def __len__(self) -> int:
        return len(self.t_s)

    def position(self, index: int, boot_id: int = 1) -> Position:
        north_m, east_m = self.own_m[index]
        return message_factory.position(
            Header("FF-01", boot_id, index + 1, message_factory.mono_ns(self.t_s[index])),
            north_m=float(north_m),
            east_m=float(east_m),
            distance_m=float(self.distance_m[index]),
        )


@dataclass
class Receiver:
    """Gives fixes whose error is part common, part slow and part white."""

    rng: np.random.Generator
    errors: Errors = field(default_factory=Errors)
    slow: Floats = field(default_factory=lambda: np.zeros(2))
    common: Floats = field(default_factory=lambda: np.zeros(2))
    before_s: float | None = None

    def fix(self, t_s: float, place_m: Floats) -> PlaceFix:
        errors, since_s = self.errors, math.inf if self.before_s is None else t_s - self.before_s
        self.before_s = t_s
        self.slow = self._went_on(self.slow, since_s / errors.slow_s)
        error = math.sqrt(errors.slow_part) * self.slow
        error = error + math.sqrt(1.0 - errors.slow_part) * self.rng.normal(size=2)
        error_m = math.sqrt(errors.fix_std_m**2 - errors.common_m**2) * error
        if errors.common_m > 0.0:
            self.common = self._went_on(self.common, since_s / COMMON_S)
            error_m = error_m + errors.common_m * self.common
        north_m, east_m = place_m + error_m
        return PlaceFix(
            t_mono_ns=message_factory.mono_ns(t_s),
            north_m=float(north_m),
            east_m=float(east_m),
            down_m=0.0,
            horizontal_std_m=errors.fix_std_m,
            vertical_std_m=None,
        )

    def _went_on(self, error: Floats, since: float) -> Floats:
        """An error of unit variance after so many of its correlation times."""
        keep = math.exp(-since)
        return keep * error + math.sqrt(1.0 - keep**2) * self.rng.normal(size=2)


def walks(duration_s: float, fix_std_m: float = 3.0) -> list[tuple[Walk, Receiver]]:
    """Return a walk and a receiver for each of ``SEEDS``."""
    generators = [np.random.default_rng(seed) for seed in SEEDS]
    errors = Errors(fix_std_m=fix_std_m)
    return [(Walk.wander(rng, duration_s), Receiver(rng, errors)) for rng in generators]


@dataclass
class Scores:
    """Errors of the estimate against the truth, one a position."""

    error_m: list[float] = field(default_factory=list)
    normalised2: list[float] = field(default_factory=list)  # chi-square of 2 degrees of freedom
    verdicts: list[FixVerdict] = field(default_factory=list)

    def note(self, fuser: Fuser, truth_m: Floats) -> None:
        estimate = fuser.estimate()
        assert estimate is not None
        error = np.array([estimate.north_m, estimate.east_m]) - truth_m
        self.error_m.append(float(np.linalg.norm(error)))
        self.normalised2.append(normalised2(estimate, error))

    @property
    def inside_95(self) -> float:
        """The part of the time in which the stated 95 % region held the truth."""
        return float(np.mean(np.array(self.normalised2) < CHI2_95_2DOF))


def run(
    fuser: Fuser, walk: Walk, receiver: Receiver, with_gps: tuple[float, float], begin: int = 0
) -> Scores:
    """Walk with a fix a second within ``with_gps`` (seconds); every position is scored."""
    scores = Scores()
    for index in range(begin, len(walk)):
        t_s = float(walk.t_s[index])
        fuser.predict(walk.position(index))
        if index % RATE_HZ == 0 and with_gps[0] <= t_s < with_gps[1]:
            scores.verdicts.append(fuser.update_gnss(receiver.fix(t_s, walk.truth_m[index])))
        scores.note(fuser, walk.truth_m[index])
    return scores
