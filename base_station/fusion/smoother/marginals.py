"""Covariances of the knots of a chain out of its information matrix.

Forward elimination and backward substitution of a block tridiagonal matrix (Golub and Van Loan,
Matrix Computations, section 4.5).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix

Floats = NDArray[np.float64]


def chain_covariances(
    information: csc_matrix, states: int, told: Sequence[tuple[int, Floats]] = ()
) -> Floats:
    """(k, states, states), of a chain's part of an information matrix; ``told`` is what else is
    known of the first unknowns of some knots, as information (2, 2).
    """
    count = information.shape[0] // states
    diagonal, beside = _blocks(information, count, states)
    for knot, known in told:
        diagonal[knot, :2, :2] += known
    inverses = np.empty_like(diagonal)
    gains = np.empty_like(beside)
    reduced = diagonal[0]
    for row in range(count):
        inverses[row] = np.linalg.inv(reduced)
        if row + 1 < count:
            gains[row] = inverses[row] @ beside[row]
            reduced = diagonal[row + 1] - beside[row].T @ gains[row]
    covariances = inverses
    for row in range(count - 2, -1, -1):
        covariances[row] += gains[row] @ covariances[row + 1] @ gains[row].T
    return covariances


def _blocks(information: csc_matrix, count: int, states: int) -> tuple[Floats, Floats]:
    """Blocks on the diagonal (k, s, s), and those right of them (k - 1, s, s)."""
    entries = information.tocoo()
    row, i = np.divmod(entries.row, states)
    column, j = np.divmod(entries.col, states)
    diagonal = np.zeros((count, states, states))
    beside = np.zeros((max(count - 1, 0), states, states))
    own = row == column
    diagonal[row[own], i[own], j[own]] = entries.data[own]
    right = column == row + 1
    beside[row[right], i[right], j[right]] = entries.data[right]
    return diagonal, beside
