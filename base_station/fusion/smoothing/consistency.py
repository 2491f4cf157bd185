"""Largest consistent set of position constraints: the others are rejected, not averaged.

The prediction of all places without any constraint is one normal distribution, so that every
question about a subset is a small linear problem. Used for places on the plan, and again for
heights.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

GATE2 = 16.0  # squared distance, chi-square of two degrees: 99.97 %; of one: 99.99 %
RESTARTS = 10


@dataclass(frozen=True)
class Prediction:
    """Predicted and observed values of ``n`` places, each along ``a`` axes."""

    mean_m: Floats  # (a n,)
    covariance_m2: Floats  # (a n, a n)
    seen_m: Floats  # (a n,)
    noise_m2: Floats  # (n,)

    def __len__(self) -> int:
        return len(self.noise_m2)

    @property
    def axes(self) -> int:
        return len(self.mean_m) // len(self)

    def of(self, one: int) -> slice:
        """The rows of a place."""
        return slice(self.axes * one, self.axes * (one + 1))


class ConditionalPrediction:
    """Prediction of each place given the constraints taken so far, one after another.

    The inverse Cholesky factor of the taken ones grows with each of them and is never computed
    again: a unit near a beacon for hours has hundreds of places, and the live station waits for
    this.
    """

    def __init__(self, expected: Prediction, used: Sequence[int] = ()) -> None:
        self._expected = expected
        size = len(expected.mean_m)
        self._known = np.empty((size, size))  # by row: used constraints, against all; whitened
        self._whitened = np.empty(size)  # its innovations, whitened
        self._rows = 0
        for one in used:
            self.take(one)

    def of(self, one: int) -> tuple[Floats, Floats]:
        """Innovation (a,) of a place that is not taken, and its covariance (a, a)."""
        expected, its = self._expected, self._expected.of(one)
        crossed = self._known[: self._rows, its]
        noise = expected.noise_m2[one] * np.eye(expected.axes)
        innovation = expected.seen_m[its] - expected.mean_m[its]
        innovation = innovation - crossed.T @ self._whitened[: self._rows]
        return innovation, expected.covariance_m2[its, its] + noise - crossed.T @ crossed

    def distance2(self, one: int) -> float:
        innovation, covariance = self.of(one)
        return float(innovation @ np.linalg.solve(covariance, innovation))

    def take(self, one: int) -> None:
        innovation, covariance = self.of(one)
        its, end = self._expected.of(one), self._rows + self._expected.axes
        known, rows = self._known[: self._rows], slice(self._rows, end)
        left = self._expected.covariance_m2[its] - known[:, its].T @ known
        root = np.linalg.cholesky(covariance)
        self._known[rows] = np.linalg.solve(root, left)
        self._whitened[rows] = np.linalg.solve(root, innovation)
        self._rows = end


def consistent_set(expected: Prediction) -> list[int]:
    """The most places that agree; where as many do either way, those that were known first."""
    best = _greedy_set(expected, list(range(len(expected))))
    left_out = [one for one in range(len(expected)) if one not in best]
    for first in left_out[:RESTARTS]:
        rest = [one for one in range(len(expected)) if one != first]
        other = _greedy_set(expected, [first, *rest])
        if len(other) > len(best):
            best = other
    return sorted(best)


def strongest_conflict(expected: Prediction, used: Sequence[int], of: int) -> int | None:
    """The taken place that a left-out one contradicts most by itself; None: what was expected
    without any place contradicts it already.
    """
    alone = ConditionalPrediction(expected)
    if alone.distance2(of) > GATE2 or not used:
        return None
    innovation, covariance = alone.of(of)
    rows = expected.axes * np.asarray(used)[:, None] + np.arange(expected.axes)  # (k, a)
    spreads = expected.covariance_m2[rows[:, :, None], rows[:, None, :]]
    spreads = spreads + expected.noise_m2[used][:, None, None] * np.eye(expected.axes)
    crossed = expected.covariance_m2[rows, expected.of(of)]  # (k, a, a)
    gain = np.linalg.solve(spreads, crossed).transpose(0, 2, 1)
    off_m = (expected.seen_m - expected.mean_m)[rows]
    left_m = innovation - np.einsum("kij,kj->ki", gain, off_m)
    whitened = np.linalg.solve(covariance - gain @ crossed, left_m[..., None])[..., 0]
    return used[int(np.argmax((left_m * whitened).sum(axis=1)))]


def _greedy_set(expected: Prediction, order: Sequence[int]) -> list[int]:
    """One by one, each where it agrees with what was taken before it."""
    given, taken = ConditionalPrediction(expected), []
    for one in order:
        if given.distance2(one) <= GATE2:
            given.take(one)
            taken.append(one)
    return taken
