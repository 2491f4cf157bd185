"""Covariances of the knots of a chain out of its information matrix.

Forward elimination and backward substitution of a block tridiagonal matrix (Golub and Van Loan,
Matrix Computations, section 4.5).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numba import njit
from numba.core.types import float64, void
from numpy.typing import NDArray
from scipy.sparse import coo_matrix

Floats = NDArray[np.float64]

_BLOCKS = float64[:, :, ::1]
UNKNOWN_VAR = 1e8  # said of a knot where the numbers are too far apart to tell


def chain_covariances(information: coo_matrix, states: int) -> Floats:
    """(k, states, states), of a chain's part of an information matrix."""
    count = information.shape[0] // states
    diagonal, beside = _blocks(information, count, states)
    covariances = np.empty_like(diagonal)
    _substitute(diagonal, beside, covariances)
    variances = np.diagonal(covariances, axis1=1, axis2=2)
    lost = ~(np.isfinite(variances) & (variances > 0.0)).all(axis=1)
    covariances[lost] = UNKNOWN_VAR * np.eye(states)
    return covariances


def shared_spreads(
    leans: Mapping[str, Floats], covariance: Floats, states: int, plus: int | None = None
) -> dict[str, Floats]:
    """What unknowns (m) that all chains share add to the covariances of each chain's knots: (k,
    states, states).  ``leans`` (k states, m): of each chain's unknowns on the shared ones, whose
    ``covariance`` is (m, m).  ``plus``: the first of two of those that are added to the first two
    of every knot.
    """
    root = np.linalg.cholesky(covariance)
    spreads = {}
    for name, hanging in leans.items():
        lean = hanging
        if plus is not None:
            lean = hanging.copy()
            lean[0::states, plus] -= 1.0
            lean[1::states, plus + 1] -= 1.0
        parts = (lean @ root).reshape(-1, states, len(root))
        spreads[name] = parts @ parts.transpose(0, 2, 1)
    return spreads


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


def _blocks(entries: coo_matrix, count: int, states: int) -> tuple[Floats, Floats]:
    """Blocks on the diagonal (k, s, s), and those right of them (k - 1, s, s)."""
    row, i = np.divmod(entries.row, states)
    column, j = np.divmod(entries.col, states)
    diagonal = np.zeros((count, states, states))
    beside = np.zeros((max(count - 1, 0), states, states))
    own = row == column
    diagonal[row[own], i[own], j[own]] = entries.data[own]
    right = column == row + 1
    beside[row[right], i[right], j[right]] = entries.data[right]
    return diagonal, beside
