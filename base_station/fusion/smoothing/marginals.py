"""Covariances of the knots of a chain out of its information matrix.

Forward elimination and backward substitution of a block tridiagonal matrix (Golub and Van Loan,
Matrix Computations, section 4.5).
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numba.core.types import float64, void
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_BLOCKS = float64[:, :, ::1]
UNKNOWN_VAR = 1e8  # of a knot where the numbers are too far apart


def chain_covariances(band: Floats, states: int) -> Floats:
    """(k, states, states), of a chain's information matrix in the lower form of LAPACK."""
    diagonal, beside = _blocks(band, states)
    covariances = np.empty_like(diagonal)
    _substitute(diagonal, beside, covariances)
    variances = np.diagonal(covariances, axis1=1, axis2=2)
    lost = ~(np.isfinite(variances) & (variances > 0.0)).all(axis=1)
    covariances[lost] = UNKNOWN_VAR * np.eye(states)
    return covariances


@njit(void(_BLOCKS, _BLOCKS, _BLOCKS), cache=True, error_model="numpy")
def _substitute(diagonal: Floats, beside: Floats, covariances: Floats) -> None:
    """Eliminate forwards, substitute backwards; ``covariances`` is written."""
    count, states = len(diagonal), diagonal.shape[1]
    gains = np.empty_like(beside)
    scale = np.empty(states)
    reduced = diagonal[0].copy()
    for knot in range(count):
        for i in range(states):  # the rows are of very different units
            scale[i] = 1.0 / np.sqrt(max(reduced[i, i], 1.0 / UNKNOWN_VAR))
        for i in range(states):
            for j in range(states):
                reduced[i, j] *= scale[i] * scale[j]
        inverse = np.linalg.inv(reduced)
        for i in range(states):
            for j in range(states):
                covariances[knot, i, j] = inverse[i, j] * scale[i] * scale[j]
        if knot + 1 < count:
            gains[knot] = covariances[knot] @ beside[knot]
            reduced = diagonal[knot + 1] - beside[knot].T @ gains[knot]
            reduced = 0.5 * (reduced + reduced.T)
    for knot in range(count - 2, -1, -1):
        covariances[knot] += gains[knot] @ covariances[knot + 1] @ gains[knot].T


def _blocks(band: Floats, states: int) -> tuple[Floats, Floats]:
    """Blocks on the diagonal (k, s, s), and those right of them (k - 1, s, s)."""
    count = band.shape[1] // states
    begins = states * np.arange(count)
    diagonal = np.empty((count, states, states))
    beside = np.zeros((max(count - 1, 0), states, states))
    for i in range(states):
        for j in range(states):
            diagonal[:, i, j] = band[abs(i - j), begins + min(i, j)]
            if states + j - i < len(band):
                beside[:, i, j] = band[states + j - i, begins[:-1] + i]
    return diagonal, beside
