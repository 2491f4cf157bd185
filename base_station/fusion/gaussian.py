"""Gaussian conditioning: a part of a state is replaced, and the rest follows by its covariance."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

LEAST = 1e-12  # variance: a state without uncertainty has no correlation


def jeffrey_update(
    mean: Floats, covariance: Floats, observe: Floats, to: Floats, to_covariance: Floats
) -> tuple[Floats, Floats]:
    """A normal distribution (n,), (n, n) after ``observe @ state`` (k,) has come to be known as
    ``to`` with ``to_covariance``; the rest follows as it hangs on that (Jeffrey's rule).
    """
    crossed = covariance @ observe.T
    was = observe @ crossed + LEAST * np.eye(len(observe))
    regression = np.linalg.solve(was, crossed.T).T
    moved = mean + regression @ (to - observe @ mean)
    left = covariance - regression @ (was - to_covariance) @ regression.T
    return moved, 0.5 * (left + left.T)


def conservative_fusion(
    mean: Floats, covariance: Floats, known: Floats, known_covariance: Floats, noise: Floats
) -> tuple[Floats, Floats]:
    """Estimate (k,) after it was recognised as a ``known`` one, of unknown correlation to it: the
    result is no better than the better of the two in any direction.

        G = max(P - K, 0),  W = G (G + R)^-1,  mean += W (known - mean),  P -= W G

    with ``P`` covariance, ``K`` known_covariance and ``R`` noise, each (k, k).
    """
    grown = at_least(covariance - known_covariance, 0.0)
    gain = grown @ np.linalg.inv(grown + noise)
    return mean + gain @ (known - mean), covariance - gain @ grown


def at_least(matrix: Floats, least: float) -> Floats:
    """The symmetric matrix with no eigenvalue below that."""
    values, vectors = np.linalg.eigh(0.5 * (matrix + matrix.T))
    return np.asarray((vectors * np.maximum(values, least)) @ vectors.T)
