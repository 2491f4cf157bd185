"""Weighted linear equations between few unknowns each, and their least-squares solution.

The unknowns are those of some chains, each coupled within itself from knot to knot only, and behind
them a few that all chains share: an arrow.  Chains are eliminated one by one, which leaves a small
problem of what is shared (Golub and Van Loan, Matrix Computations, sections 4.3 and 4.5).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve, cho_solve_banded, cholesky_banded
from scipy.sparse import coo_matrix, csr_matrix, vstack

from base_station.fusion.smoothing.marginals import chain_covariances

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
        if not self._count:
            return csr_matrix((0, self._unknowns))
        entries = np.concatenate(self._values)
        places = (np.concatenate(self._rows), np.concatenate(self._columns))
        return csr_matrix((entries, places), shape=(self._count, self._unknowns))

    @property
    def right(self) -> Floats:
        """Whitened, as ``matrix``."""
        return np.concatenate(self._right) if self._right else np.zeros(0)


class NormalEquations:
    """Positive definite.  Chain by chain only what is banded or sparse is held: of a hundred units
    that walk for an hour all else is gigabytes.
    """

    def __init__(
        self,
        chains: Mapping[str, slice],
        states: int,
        of_chains: Iterable[tuple[str, Equations]],
        links: Equations,
        shared: Equations,
    ) -> None:
        """``chains``: the columns of each, with so many ``states`` a knot, from the first on;
        ``of_chains``: equations of one chain and of what is shared, each wanted when it is its
        turn.  Of ``links``, too, each is of one chain; those of ``shared`` are of none.
        """
        self._columns, self.states = chains, states
        self._first = max(own.stop for own in chains.values())
        self._chains: dict[str, _Chain] = {}
        of_shared = shared.matrix()[:, self._first :]
        whole = (of_shared.T @ of_shared).toarray()
        shared_right = of_shared.T @ shared.right
        rows, right = links.matrix(), links.right
        begins = [own.start for own in chains.values()]
        chain_numbers = np.searchsorted(begins, _first_columns(rows), side="right") - 1
        for number, (name, equations) in enumerate(of_chains):
            rows_of_chain = np.flatnonzero(chain_numbers == number)
            matrix = vstack((equations.matrix(), rows[rows_of_chain]), format="csr")
            self._take(
                name,
                matrix,
                np.concatenate((equations.right, right[rows_of_chain])),
                whole,
                shared_right,
            )
        self._whole = cho_factor(0.5 * (whole + whole.T))
        self._shared = cho_solve(self._whole, shared_right)

    def solve(self) -> tuple[dict[str, Floats], Floats]:
        """The unknowns of each chain, and those that are shared."""
        return {name: one.given(self._shared) for name, one in self._chains.items()}, self._shared

    def spread_of(self, name: str, rows: csr_matrix) -> Floats:
        """Covariance of ``rows @ x``, (m, m), where they are of one chain and what is shared."""
        chain, hung = self._chains[name], rows[:, self._columns[name]].toarray().T
        solved = chain.solve(hung)
        on_shared = rows[:, self._first :].toarray()
        on_shared[:, chain.columns] -= solved.T @ chain.beside
        spread: Floats = hung.T @ solved + on_shared @ cho_solve(self._whole, on_shared.T)
        return 0.5 * (spread + spread.T)

    def covariances(self, name: str) -> Floats:
        """Covariances of a chain's knots (k, states, states), without the shared unknowns."""
        return chain_covariances(self._chains[name].band, self.states)

    def shared_covariances(self, name: str, plus: int | None = None) -> Floats:
        """Covariances that the shared unknowns add. ``plus``: first of two shared unknowns that are
        added to the first two of every knot.
        """
        chain, states = self._chains[name], self.states
        columns = chain.columns
        if plus is not None:
            columns = np.union1d(columns, [plus, plus + 1])
        lean = np.zeros((len(chain.right), len(columns)))
        lean[:, np.searchsorted(columns, chain.columns)] = chain.coupling()
        if plus is not None:
            lean[0::states, np.searchsorted(columns, plus)] -= 1.0
            lean[1::states, np.searchsorted(columns, plus + 1)] -= 1.0
        root = np.linalg.cholesky(self.shared_covariance[np.ix_(columns, columns)])
        parts = (lean @ root).reshape(len(lean) // states, states, len(columns))
        spread: Floats = parts @ parts.transpose(0, 2, 1)
        return spread

    @cached_property
    def shared_covariance(self) -> Floats:
        """Covariance of the shared unknowns."""
        spread: Floats = cho_solve(self._whole, np.eye(len(self._shared)))
        return 0.5 * (spread + spread.T)

    def _take(
        self, name: str, matrix: csr_matrix, right: Floats, whole: Floats, shared_right: Floats
    ) -> None:
        """Eliminate a chain (Schur complement) into ``whole`` and ``shared_right``."""
        own, shared = matrix[:, self._columns[name]], matrix[:, self._first :]
        whole += (shared.T @ shared).toarray()
        shared_right += shared.T @ right
        beside = (own.T @ shared).tocsc()
        columns = np.flatnonzero(np.diff(beside.indptr))
        chain = self._chains[name] = _Chain(
            band=_banded((own.T @ own).tocoo(), 2 * self.states),
            beside=beside[:, columns].tocsr(),
            columns=columns,
            right=own.T @ right,
        )
        solved = chain.solve(np.column_stack((chain.right, chain.beside.toarray())))
        whole[np.ix_(columns, columns)] -= chain.beside.T @ solved[:, 1:]
        shared_right[columns] -= chain.beside.T @ solved[:, 0]


@dataclass(frozen=True)
class _Chain:
    """Its part of the normal equations; what follows from that is worked out each time."""

    band: Floats  # information (width, n), lower form of LAPACK
    beside: csr_matrix  # (n, m) information between it and the few shared unknowns that it is on
    columns: Ints  # (m,) of those among the shared ones
    right: Floats  # (n,)

    def solve(self, right: Floats) -> Floats:
        """Solution of the chain alone."""
        band = self.band.copy()
        band[0] *= 1.0 + LEAST_PART
        factor = cholesky_banded(band, overwrite_ab=True, lower=True, check_finite=False)
        solved: Floats = cho_solve_banded((factor, True), right, check_finite=False)
        return solved

    def coupling(self) -> Floats:
        """(n, m), of each unknown on those shared ones."""
        return self.solve(self.beside.toarray())

    def given(self, shared: Floats) -> Floats:
        return self.solve(self.right - self.beside @ shared[self.columns])


def _first_columns(rows: csr_matrix) -> Ints:
    """First column of each row."""
    rows.sort_indices()
    first: Ints = rows.indices[rows.indptr[:-1]]
    return first


def _banded(block: coo_matrix, width: int) -> Floats:
    """Lower form of LAPACK: (width, n)."""
    lower = block.row >= block.col
    rows, columns = block.row[lower], block.col[lower]
    band = np.zeros((width, block.shape[0]))
    band[rows - columns, columns] = block.data[lower]
    return band
