"""Which of several places can be true together: what contradicts is left out, not averaged.

What is expected of all places without any of them is one normal distribution, so that every
question about a subset is a small linear problem.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

GATE2 = 16.0  # squared distance, chi-square of two degrees: 99.97 %
OTHER_BEGINNINGS = 10


@dataclass(frozen=True)
class Expected:
    """Of ``n`` places, each north and east: what is expected, and what is seen."""

    mean_m: Floats  # (2 n,)
    covariance_m2: Floats  # (2 n, 2 n)
    seen_m: Floats  # (2 n,)
    noise_m2: Floats  # (n,)

    def __len__(self) -> int:
        return len(self.noise_m2)

    def given(self, used: Sequence[int], of: int) -> tuple[Floats, Floats]:
        """Innovation (2,) of one place, and its covariance (2, 2), when others are taken."""
        pair = slice(2 * of, 2 * of + 2)
        innovation = self.seen_m[pair] - self.mean_m[pair]
        covariance = self.covariance_m2[pair, pair] + self.noise_m2[of] * np.eye(2)
        rows = [row for one in used if one != of for row in (2 * one, 2 * one + 1)]
        if not rows:
            return innovation, covariance
        noise = np.diag(np.repeat(self.noise_m2[[one for one in used if one != of]], 2))
        crossed = self.covariance_m2[pair, rows]
        gain = np.linalg.solve(self.covariance_m2[np.ix_(rows, rows)] + noise, crossed.T).T
        innovation = innovation - gain @ (self.seen_m[rows] - self.mean_m[rows])
        return innovation, covariance - gain @ crossed.T

    def distance2(self, used: Sequence[int], of: int) -> float:
        innovation, covariance = self.given(used, of)
        return float(innovation @ np.linalg.solve(covariance, innovation))


def agreeing(expected: Expected) -> list[int]:
    """The most places that agree; where as many do either way, those that were known first."""
    best = _taken(expected, list(range(len(expected))))
    left_out = [one for one in range(len(expected)) if one not in best]
    for first in left_out[:OTHER_BEGINNINGS]:
        rest = [one for one in range(len(expected)) if one != first]
        other = _taken(expected, [first, *rest])
        if len(other) > len(best):
            best = other
    return sorted(best)


def most_against(expected: Expected, used: Sequence[int], of: int) -> int | None:
    """The taken place that a left-out one contradicts most by itself; None: what was expected
    without any place contradicts it already.
    """
    if expected.distance2([], of) > GATE2 or not used:
        return None
    return max(used, key=lambda one: expected.distance2([one], of))


def _taken(expected: Expected, order: Sequence[int]) -> list[int]:
    """One by one, each where it agrees with what was taken before it."""
    taken: list[int] = []
    for one in order:
        if expected.distance2(taken, one) <= GATE2:
            taken.append(one)
    return taken
