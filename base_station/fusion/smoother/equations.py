"""Weighted linear equations between few unknowns each, and their least-squares solution.

The unknowns are those of some chains, each coupled within itself from knot to knot only, and behind
them a few that all chains share: an arrow.  Chains are eliminated one by one, which leaves a small
problem of what is shared (Golub and Van Loan, Matrix Computations, sections 4.3 and 4.5).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve, cho_solve_banded, cholesky_banded
from scipy.sparse import coo_matrix, csr_matrix

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

LEAST_PART = 1e-13  # of each unknown's information is added: numbers have so many digits


class Equations:
    """Rows are added in bulk: one a column index given, each divided by its standard deviation."""

    def __init__(self, unknowns: int) -> None:
        self._unknowns = unknowns
        self._count = 0
        self._rows: list[Ints] = []
        self._columns: list[Ints] = []
        self._values: list[Floats] = []
        self._right: list[Floats] = []

    def add(
        self, std: Floats | float, right: Floats | float, *terms: tuple[Ints, Floats | float]
    ) -> None:
        """``sum(factor * x[column]) = right`` with this standard deviation, row by row."""
        count = len(terms[0][0])
        weight = np.broadcast_to(1.0 / np.asarray(std, dtype=np.float64), count)
        rows = self._count + np.arange(count)
        self._count += count
        for columns, factor in terms:
            self._rows.append(rows)
            self._columns.append(columns)
            self._values.append(
                np.broadcast_to(np.asarray(factor, dtype=np.float64), count) * weight
            )
        self._right.append(np.broadcast_to(np.asarray(right, dtype=np.float64), count) * weight)

    def matrix(self) -> csr_matrix:
        """Whitened, one row an equation."""
        entries = np.concatenate(self._values)
        places = (np.concatenate(self._rows), np.concatenate(self._columns))
        return csr_matrix((entries, places), shape=(self._count, self._unknowns))

    def normal(self, chains: Mapping[str, slice], states: int) -> NormalEquations:
        """``chains``: the columns of each, with so many ``states`` a knot, from the first on."""
        matrix = self.matrix()
        right = matrix.T @ np.concatenate(self._right)
        return NormalEquations((matrix.T @ matrix).tocsr(), right, chains, states)


class NormalEquations:
    """Positive definite."""

    def __init__(
        self, information: csr_matrix, right: Floats, chains: Mapping[str, slice], states: int
    ) -> None:
        self._chains, self._right = chains, right
        self._first = first = max(own.stop for own in chains.values())
        self.blocks = {name: information[own, own].tocoo() for name, own in chains.items()}
        self._factors = {
            name: cholesky_banded(_banded(block, 2 * states), lower=True, check_finite=False)
            for name, block in self.blocks.items()
        }
        self.leans: dict[str, Floats] = {}  # of each chain's unknowns on the shared ones
        self._beside: dict[str, csr_matrix] = {}  # each unknown leans on few of those itself
        whole = information[first:, first:].toarray()
        for name, own in chains.items():
            beside = self._beside[name] = information[own, first:]
            self.leans[name] = self._of_chain(name, beside.toarray())
            whole -= beside.T @ self.leans[name]
        self._whole = cho_factor(0.5 * (whole + whole.T))

    @property
    def shared_covariance(self) -> Floats:
        """Of the shared unknowns."""
        spread: Floats = cho_solve(self._whole, np.eye(len(self._right) - self._first))
        return 0.5 * (spread + spread.T)

    def solve(self) -> Floats:
        return self._solve(self._right[:, None])[:, 0]

    def spread_of(self, rows: csr_matrix) -> Floats:
        """Covariance of ``rows @ x``, (m, m)."""
        spread: Floats = rows @ self._solve(rows.T.toarray())
        return 0.5 * (spread + spread.T)

    def _solve(self, right: Floats) -> Floats:
        x = np.zeros_like(right)
        shared = right[self._first :].copy()
        for name, own in self._chains.items():
            here = right[own].any(axis=0)  # the right sides that say anything of this chain
            if here.any():
                x[own, here] = self._of_chain(name, right[own, here])
                shared -= self._beside[name].T @ x[own]
        x[self._first :] = shared = cho_solve(self._whole, shared)
        for name, own in self._chains.items():
            x[own] -= self.leans[name] @ shared
        return x

    def _of_chain(self, name: str, right: Floats) -> Floats:
        solved: Floats = cho_solve_banded((self._factors[name], True), right, check_finite=False)
        return solved


def _banded(block: coo_matrix, width: int) -> Floats:
    """Lower form of LAPACK: (width, n)."""
    lower = block.row >= block.col
    rows, columns = block.row[lower], block.col[lower]
    band = np.zeros((width, block.shape[0]))
    band[rows - columns, columns] = block.data[lower]
    band[0] *= 1.0 + LEAST_PART
    return band
