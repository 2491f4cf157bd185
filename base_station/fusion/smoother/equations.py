"""Weighted linear equations between few unknowns each, and their least-squares solution."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import SuperLU, splu

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


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

    def normal(self) -> NormalEquations:
        matrix = self.matrix()
        return NormalEquations((matrix.T @ matrix).tocsc(), matrix.T @ np.concatenate(self._right))


class NormalEquations:
    """Positive definite; factorised when first asked."""

    def __init__(self, information: csr_matrix, right: Floats) -> None:
        self.information = information
        self._right = right
        self._factor: SuperLU | None = None

    def solve(self) -> Floats:
        x: Floats = self._factorised().solve(self._right)
        return x

    def spread_of(self, rows: csr_matrix) -> Floats:
        """Covariance of ``rows @ x``, (m, m)."""
        columns = rows.T.toarray()
        spread: Floats = columns.T @ self._factorised().solve(columns)
        return 0.5 * (spread + spread.T)

    def _factorised(self) -> SuperLU:
        if self._factor is None:
            self._factor = splu(
                self.information,
                permc_spec="MMD_AT_PLUS_A",
                diag_pivot_thresh=0.0,
                options={"SymmetricMode": True},
            )
        return self._factor
