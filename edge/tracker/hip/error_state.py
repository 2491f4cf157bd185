"""Error-state filter of distance and velocity, and of heading and turn rate (3.11 to 3.20).

The thesis's four errors (distance, velocity, heading, angular rate) fall into two pairs that no
equation links, so two filters of two errors are the same.  The mean of the errors is always zero:
what an update finds goes into what is integrated at once (3.20).  In the thesis's transition matrix
(3.14) the interval stands on the wrong side of the diagonal.
"""

from __future__ import annotations

from numba import njit

from edge.samples import Floats


@njit()
def propagate(covariance: Floats, dt_s: float, noise: float, rate_noise: float) -> None:
    """Advance the covariance (2, 2) of a quantity and its rate by F K F' + Q (3.15)."""
    covariance[0, 0] += dt_s * (covariance[0, 1] + covariance[1, 0] + dt_s * covariance[1, 1])
    covariance[0, 0] += noise * dt_s
    covariance[0, 1] += dt_s * covariance[1, 1]
    covariance[1, 0] = covariance[0, 1]
    covariance[1, 1] += rate_noise * dt_s


@njit()
def update(covariance: Floats, measured: int, off: float, variance: float, error: Floats) -> None:
    """Write into ``error`` (2,) the estimate of the pair (3.18, 3.19) by ``off``, and take it in.

    ``measured``: 0 where the quantity is, 1 where its rate is.
    """
    spread = covariance[measured, measured] + variance
    first, second = covariance[0, measured] / spread, covariance[1, measured] / spread
    error[0], error[1] = first * off, second * off
    row_0, row_1 = covariance[measured, 0], covariance[measured, 1]
    covariance[0, 0] -= first * row_0
    covariance[0, 1] -= first * row_1
    covariance[1, 0] = covariance[0, 1]
    covariance[1, 1] -= second * row_1
