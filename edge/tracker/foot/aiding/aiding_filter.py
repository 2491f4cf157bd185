"""Aiding filters: small Kalman filters beside the main one, for sensors with errors that last.

Errors of a compass or a barometer are anything but white: iron, weather, the building.  They are
estimated here, together with the one error of the main filter that the sensor observes (heading or
height), which is the first state.  Before an update both filters are brought to the same variance
of it; afterwards the main filter gets the measurement that brings it to just what the aiding filter
knows.  So nothing is counted twice, however often an update is made, and a sample costs nothing.
"""

from __future__ import annotations

import math

from numba import njit

from edge.samples import Floats

TINY = 1e-12  # a variance of zero has no inverse
GAIN_MIN = 1e-3  # an update that lowers the variance by a smaller share is left to the next


@njit()
def sync_variance(covariance: Floats, variance: float) -> None:
    """Make ``variance`` that of the first state of ``covariance`` (n, n).

    What the main filter lost since, its drift, is added; what it learned from elsewhere is a
    measurement of the first state.
    """
    before = covariance[0, 0]
    if variance >= before:
        covariance[0, 0] = variance
        return
    kept = variance / before
    size = len(covariance)
    for i in range(1, size):
        for j in range(1, size):
            covariance[i, j] -= (1.0 - kept) / before * covariance[i, 0] * covariance[0, j]
    for i in range(1, size):
        covariance[i, 0] *= kept
        covariance[0, i] *= kept
    covariance[0, 0] = variance


@njit()
def project(covariance: Floats, row: Floats, column: Floats) -> float:
    """Write ``P h`` into ``column`` (n,) and return ``h' P h`` for the measurement row ``h``."""
    size = len(row)
    total = 0.0
    for i in range(size):
        value = 0.0
        for j in range(size):
            value += covariance[i, j] * row[j]
        column[i] = value
        total += row[i] * value
    return total


@njit()
def measure(
    estimate: Floats,
    covariance: Floats,
    row: Floats,
    residual: float,
    variance: float,
    column: Floats,
) -> None:
    """Use one scalar measurement ``row`` (n,); ``residual`` is measured minus expected."""
    weight = 1.0 / (project(covariance, row, column) + variance)
    size = len(row)
    for i in range(size):
        gain = weight * column[i]
        estimate[i] += gain * residual
        for j in range(size):
            covariance[i, j] -= gain * column[j]


@njit()
def equivalent_measurement(
    estimate: Floats, covariance: Floats, prior: float
) -> tuple[float, float]:
    """Return residual and variance of the measurement that gives the main filter the same
    knowledge.

    ``prior`` is the main filter's own variance of the error.  The variance is infinite when
    there is too little to transfer; else the first state is transferred and becomes zero.
    """
    noise = equivalent_noise(prior, covariance[0, 0])
    if noise == math.inf:
        return 0.0, noise
    residual = residual_for_mean(estimate[0], prior, noise)
    estimate[0] = 0.0
    return residual, noise


@njit()
def equivalent_noise(prior: float, variance: float) -> float:
    """Return the variance of a measurement that brings ``prior`` down to ``variance``.

    Infinite where that is not worth it.
    """
    if not variance < (1.0 - GAIN_MIN) * prior:
        return math.inf
    return float(1.0 / (1.0 / max(variance, TINY) - 1.0 / prior))


@njit()
def residual_for_mean(mean: float, prior: float, noise: float) -> float:
    """Return the residual of that measurement which moves the error's mean from 0 to ``mean``."""
    return float(mean * (prior + noise) / prior)
