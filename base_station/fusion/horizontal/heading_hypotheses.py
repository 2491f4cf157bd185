"""Heading hypotheses: a grid of headings over the full turn, each with its own place.

For a given heading, path and fixes with slow errors are a linear problem in ``[north, east, b_n,
b_e, k_n, k_e]``. All hypotheses have the same covariance, because neither the noise of the path nor
that of a fix depends on the heading; so there is one gain, and only means and weights differ (a
Rao-Blackwellised grid: Doucet et al. 2000, section 3).
"""

from __future__ import annotations

import math

import msgspec
import numpy as np
from numpy.typing import NDArray

from base_station.fusion.horizontal.state import PLACE_AND_SLOW

Floats = NDArray[np.float64]

HYPOTHESES = 72
SPACING_RAD = 2.0 * math.pi / HYPOTHESES
_PLAUSIBLE = 1e-3  # of the best hypothesis' weight
SCALE_KNOWN = 0.1  # standard deviation; a solution without a heading has several times that


class GnssObservation(msgspec.Struct, frozen=True):
    """A fix as an observation of the present state."""

    north_m: float
    east_m: float
    since_north_m: float  # own path walked since it was valid
    since_east_m: float
    slow_m: float  # weight of the receiver's slow error, which has unit variance
    common_m: float  # and of the error that all receivers of the site share
    white_m2: float  # variance of the rest, each axis


def slow_error_jacobian(observation: GnssObservation) -> Floats:
    """(2, 4): what the slow errors ``[b_n, b_e, k_n, k_e]`` do to a fix."""
    slow_m, common_m = observation.slow_m, observation.common_m
    return np.array([[slow_m, 0.0, common_m, 0.0], [0.0, slow_m, 0.0, common_m]])


class SavedHypotheses(msgspec.Struct, frozen=True):
    means: list[list[float]]
    covariance: list[list[float]]
    turns_rad: list[float]
    weights: list[float]


class HeadingHypotheses:
    """Hypotheses of the heading correction, each with its own place."""

    def __init__(
        self, means: Floats, covariance: Floats, turns_rad: Floats, weights: Floats
    ) -> None:
        self._means = means  # (n, 6) north, east, and the fixes' slow errors
        self._covariance = covariance  # (6, 6), of every hypothesis
        self._turns_rad = turns_rad  # (n,)
        self._cosine, self._sine = np.cos(turns_rad), np.sin(turns_rad)
        self._weights = weights  # (n,), their sum is 1

    @staticmethod
    def from_prior(
        mean: Floats, covariance: Floats, heading_rad: float, heading_std_rad: float
    ) -> HeadingHypotheses:
        """``mean`` (6,) and ``covariance`` (6, 6) for every heading, weighted by a normal
        distribution about one; a standard deviation of pi and above: any heading is as likely.
        """
        offsets_rad = SPACING_RAD * np.arange(-HYPOTHESES // 2, HYPOTHESES // 2, dtype=np.float64)
        flat = heading_std_rad >= math.pi
        weights = np.exp(-0.5 * (offsets_rad / (math.inf if flat else heading_std_rad)) ** 2)
        weights /= weights.sum()
        means = np.tile(mean, (HYPOTHESES, 1))
        return HeadingHypotheses(means, covariance.copy(), heading_rad + offsets_rad, weights)

    @staticmethod
    def from_gaussian(mean: Floats, covariance: Floats) -> HeadingHypotheses:
        """Hypotheses of a normal distribution (8,), (8, 8) of ``[north, east, c, s, b_n, b_e, k_n,
        k_e]``, conditioned on each heading. With a known scale ``(c, s)`` lies on an arc, and the
        distribution gives its tangent; else ``(c, s)`` is conditioned on a point of the unit
        circle.
        """
        own, turn = PLACE_AND_SLOW, [2, 3]
        spread, crossed = covariance[np.ix_(turn, turn)], covariance[np.ix_(own, turn)]
        c, s = float(mean[2]), float(mean[3])
        about_rad, scale2 = math.atan2(s, c), c * c + s * s
        offsets_rad = SPACING_RAD * np.arange(-HYPOTHESES // 2, HYPOTHESES // 2, dtype=np.float64)
        turns_rad = about_rad + offsets_rad
        along = np.array([math.cos(about_rad), math.sin(about_rad)])
        if float(along @ spread @ along) < SCALE_KNOWN**2:
            to_turn = np.array([[-s, c]]) / scale2
            off = offsets_rad[:, None]
        else:
            to_turn = np.eye(2)
            off = np.column_stack((np.cos(turns_rad), np.sin(turns_rad))) - mean[turn]
        inverse = np.linalg.inv(to_turn @ spread @ to_turn.T)
        gain = crossed @ to_turn.T @ inverse
        means, left = mean[own] + off @ gain.T, covariance[np.ix_(own, own)]
        exponents = -0.5 * ((off @ inverse) * off).sum(axis=1)
        weights = np.exp(exponents - exponents.max())
        left = left - gain @ to_turn @ crossed.T
        return HeadingHypotheses(means, left, turns_rad, weights / weights.sum())

    @staticmethod
    def restore(saved: SavedHypotheses) -> HeadingHypotheses:
        return HeadingHypotheses(
            np.array(saved.means),
            np.array(saved.covariance),
            np.array(saved.turns_rad),
            np.array(saved.weights),
        )

    def save(self) -> SavedHypotheses:
        return SavedHypotheses(
            self._means.tolist(),
            self._covariance.tolist(),
            self._turns_rad.tolist(),
            self._weights.tolist(),
        )

    def predict(self, north_m: float, east_m: float, place_var_m2: float, turn_var: float) -> None:
        """The own path went on by this much; its heading may have wandered."""
        self._means[:, :2] += self._turned(north_m, east_m)
        self.inflate_place(place_var_m2)
        share = 0.5 * min(turn_var / SPACING_RAD**2, 0.5)
        around = np.roll(self._weights, 1) + np.roll(self._weights, -1)
        self._weights = (1.0 - 2.0 * share) * self._weights + share * around

    def inflate_place(self, variance_m2: float) -> None:
        self._covariance[0, 0] += variance_m2
        self._covariance[1, 1] += variance_m2

    def decay_slow_errors(self, keeps: Floats) -> None:
        """Time went by for the fixes' slow errors (4,), of unit variance."""
        self._means[:, 2:] *= keeps
        self._covariance[2:, :] *= keeps[:, None]
        self._covariance[:, 2:] *= keeps
        self._covariance[range(2, 6), range(2, 6)] += 1.0 - keeps**2

    def reset_place(self, variance_m2: float) -> None:
        self._covariance[:2, :] = 0.0
        self._covariance[:, :2] = 0.0
        self.inflate_place(variance_m2)

    def distance2(self, observation: GnssObservation) -> float:
        """Squared distance to the nearest plausible hypothesis, chi-square of two degrees."""
        innovations, inverse = self._innovations(observation)
        distances2 = _squares(innovations, inverse)
        plausible = self._weights > _PLAUSIBLE * self._weights.max()
        return float(distances2[plausible].min())

    def update(self, observation: GnssObservation) -> None:
        innovations, inverse = self._innovations(observation)
        distances2 = _squares(innovations, inverse)
        observe = _observe(observation)
        gain = self._covariance @ observe.T @ inverse
        self._means += innovations @ gain.T
        keep = np.eye(6) - gain @ observe
        noise = observation.white_m2 * gain @ gain.T
        self._covariance = keep @ self._covariance @ keep.T + noise
        weights = self._weights * np.exp(-0.5 * (distances2 - distances2.min()))
        self._weights = weights / weights.sum()

    def update_heading(self, turn_rad: float, variance: float) -> None:
        """The heading correction was measured."""
        off_rad = (self._turns_rad - turn_rad + math.pi) % (2.0 * math.pi) - math.pi
        weights = self._weights * np.exp(-0.5 * off_rad**2 / variance)
        self._weights = weights / weights.sum()

    def _innovations(self, observation: GnssObservation) -> tuple[Floats, Floats]:
        """Innovations by hypothesis (n, 2), and the inverse of their covariance (2, 2)."""
        observe = _observe(observation)
        spread = observe @ self._covariance @ observe.T + observation.white_m2 * np.eye(2)
        innovations = self._turned(observation.since_north_m, observation.since_east_m)
        innovations += (observation.north_m, observation.east_m)
        innovations -= self._means @ observe.T
        inverse = np.asarray(np.linalg.inv(spread), dtype=np.float64)
        return innovations, inverse

    def reframe(self, turn_rad: float, turn: Floats, shift_m: Floats) -> None:
        """``turn`` (2, 2) is the rotation by ``turn_rad``."""
        self._turns_rad = self._turns_rad + turn_rad
        self._cosine, self._sine = np.cos(self._turns_rad), np.sin(self._turns_rad)
        self._means[:, :2] = self._means[:, :2] @ turn.T + shift_m
        for pair in (slice(2, 4), slice(4, 6)):
            self._means[:, pair] = self._means[:, pair] @ turn.T
        both = np.kron(np.eye(3), turn)
        self._covariance = both @ self._covariance @ both.T

    def moments(self) -> tuple[Floats, Floats]:
        """Mean (8,) and covariance (8, 8) of ``[north, east, cos, sin, b_n, b_e, k_n, k_e]``."""
        weights, cosine, sine = self._weights, self._cosine, self._sine
        states = np.column_stack([self._means[:, :2], cosine, sine, self._means[:, 2:]])
        mean: Floats = weights @ states
        apart = states - mean
        covariance: Floats = (apart * weights[:, None]).T @ apart
        covariance[np.ix_(PLACE_AND_SLOW, PLACE_AND_SLOW)] += self._covariance
        between = SPACING_RAD**2 / 12.0  # a hypothesis stands for the headings next to it
        covariance[2, 2] += between * float(weights @ sine**2)
        covariance[3, 3] += between * float(weights @ cosine**2)
        crossed = between * float(weights @ (sine * cosine))
        covariance[2, 3] -= crossed
        covariance[3, 2] -= crossed
        return mean, covariance

    def _turned(self, north_m: float, east_m: float) -> Floats:
        """The own-frame vector in the incident frame, by every hypothesis (n, 2)."""
        turned = np.empty((len(self._cosine), 2))
        turned[:, 0] = self._cosine * north_m - self._sine * east_m
        turned[:, 1] = self._sine * north_m + self._cosine * east_m
        return turned


def _observe(observation: GnssObservation) -> Floats:
    return np.hstack([np.eye(2), slow_error_jacobian(observation)])


def _squares(innovations: Floats, inverse: Floats) -> Floats:
    squares: Floats = ((innovations @ inverse) * innovations).sum(axis=1)
    return squares
