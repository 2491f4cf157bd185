"""Common-mode error of all receivers of a site, estimated from one that does not move.

Errors of orbits, clocks and atmosphere are equal within some kilometres and change over tens of
minutes; reflections at a receiver's surroundings are its own. A receiver at a known place shows
their sum; the common part is subtracted from the fixes of others (differential positioning in the
position domain: Matosevic et al. 2006).
"""

from __future__ import annotations

import math

import msgspec
import numpy as np
from numpy.typing import NDArray

from base_station.fusion.interface import PlaceFix
from shared.clock import NS_PER_S

Floats = NDArray[np.float64]

COMMON_MOST_M = 1.5  # each axis, of the errors by orbits, clocks and the air for any receiver
COMMON_PART = 0.45  # of a fix's variance, at most
OWN_PART = 0.8  # of the rest is slow too; the remainder is new with every fix
COMMON_S, OWN_S = 1200.0, 300.0  # correlation times, of a receiver that does not move
MAX_AGE_S = 60.0  # after which nothing is taken off any more
GATE2 = 13.8  # chi-square of two degrees, 99.9 %

_COMMON, _OWN, _PLACE = range(3)
_OBSERVE = np.ones(3)


def common_m2(std_m: float) -> float:
    """Variance, each axis, of what a receiver that claims so much errs by with all others: a bad
    one errs by itself.
    """
    return min(COMMON_MOST_M**2, COMMON_PART * std_m**2)


class CommonModeError(msgspec.Struct):
    """Kalman filter of the common error, the receiver's own error and the error of its given place:
    x (3, 2) with one covariance P (3, 3) for both axes, H = [1, 1, 1]; the first two are
    first-order Gauss-Markov processes.
    """

    t_ns: int | None = None  # station time of the last fix
    std_m: float = 0.0  # of the receiver's fixes where nothing disturbs them: the least it claimed
    mean_m: list[list[float]] = msgspec.field(default_factory=list)  # (3, 2) north and east
    covariance_m2: list[list[float]] = msgspec.field(default_factory=list)  # (3, 3)

    def update(
        self, t_ns: int, off_m: tuple[float, float], std_m: float, place_std_m: float
    ) -> None:
        """A fix that lies so far north and east of where its receiver is known to stand."""
        if self.t_ns is None:
            self._begin(std_m, place_std_m)
        elif t_ns <= self.t_ns:
            return
        mean, covariance = self._at(t_ns)
        self.t_ns = t_ns
        noise_m2 = (1.0 - OWN_PART) * (self.std_m**2 - common_m2(self.std_m))
        noise_m2 += max(0.0, std_m**2 - self.std_m**2)
        spread = float(_OBSERVE @ covariance @ _OBSERVE) + noise_m2
        apart = np.array(off_m) - _OBSERVE @ mean
        if float(apart @ apart) < GATE2 * spread:
            gain = covariance @ _OBSERVE / spread
            mean = mean + np.outer(gain, apart)
            covariance = covariance - np.outer(gain, _OBSERVE @ covariance)
            mean, covariance = self._with_accuracy(std_m, mean, covariance)
        self.mean_m, self.covariance_m2 = mean.tolist(), covariance.tolist()

    def correct(self, fix: PlaceFix, t_ns: int) -> PlaceFix:
        """Another receiver's fix of that time without what all err by."""
        if self.t_ns is None or abs(t_ns - self.t_ns) > MAX_AGE_S * NS_PER_S:
            return fix
        mean, covariance = self._at(max(t_ns, self.t_ns))
        was_m2, is_m2 = common_m2(fix.horizontal_std_m), float(covariance[_COMMON, _COMMON])
        if is_m2 >= was_m2:  # known only as well as the other receiver's stated accuracy
            return fix
        return msgspec.structs.replace(
            fix,
            north_m=fix.north_m - float(mean[_COMMON, 0]),
            east_m=fix.east_m - float(mean[_COMMON, 1]),
            horizontal_std_m=math.sqrt(fix.horizontal_std_m**2 - was_m2 + is_m2),
            common_m2=is_m2,
            uncorrected_m=(fix.north_m, fix.east_m),
        )

    def _begin(self, std_m: float, place_std_m: float) -> None:
        self.std_m = std_m
        self.mean_m = np.zeros((3, 2)).tolist()
        self.covariance_m2 = np.diag([*self._slow_m2(), place_std_m**2]).tolist()

    def _with_accuracy(
        self, std_m: float, mean: Floats, covariance: Floats
    ) -> tuple[Floats, Floats]:
        """Scale the state down to the best accuracy claimed so far: a receiver that was just
        switched on claims tens of metres. No part is then less certain than its prior.
        """
        self.std_m = min(self.std_m, std_m)
        most = np.array([*self._slow_m2(), math.inf])
        part = np.sqrt(np.minimum(1.0, most / np.diagonal(covariance)))
        return part[:, None] * mean, np.outer(part, part) * covariance

    def _at(self, t_ns: int) -> tuple[Floats, Floats]:
        """Mean (3, 2) and covariance (3, 3) at that time, the last fix's or later."""
        since_s = 0.0 if self.t_ns is None else (t_ns - self.t_ns) / NS_PER_S
        keep = np.array([math.exp(-since_s / COMMON_S), math.exp(-since_s / OWN_S), 1.0])
        variances = np.array([*self._slow_m2(), 0.0])
        mean, covariance = np.array(self.mean_m), np.array(self.covariance_m2)
        spread = np.outer(keep, keep) * covariance + np.diag((1.0 - keep**2) * variances)
        return keep[:, None] * mean, spread

    def _slow_m2(self) -> tuple[float, float]:
        """Variances of what all err by, and of what the station's receiver adds for long."""
        common = common_m2(self.std_m)
        return common, OWN_PART * (self.std_m**2 - common)
