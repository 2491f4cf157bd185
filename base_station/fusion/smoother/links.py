"""Two trails, or one twice, at the same place: meetings, and ends of stairs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.smoother.chain import STATES, Belief, Chain, place_of
from base_station.fusion.smoother.equations import Equations

Floats = NDArray[np.float64]

End = tuple[str, int]  # a unit, and when


@dataclass(frozen=True)
class Link:
    one: End
    other: End
    std_m: float  # each axis
    tail: float  # standard deviations from which it counts less


@dataclass(frozen=True)
class Reached:
    """An end of a link on its chain."""

    knot: int
    column: int  # of the knot among the unknowns
    since_m: Floats  # (2,) own path since the knot
    place_m: Floats  # (2,) as believed


class Places:
    """Where ends of links are, as it is believed now."""

    def __init__(
        self,
        chains: Mapping[str, Chain],
        bases: Mapping[str, int],
        beliefs: Mapping[str, Belief],
    ) -> None:
        self._chains, self._bases, self._beliefs = chains, bases, beliefs

    def of(self, end: End) -> Reached:
        unit_id, t_ns = end
        knot, since = self._chains[unit_id].at(np.array([t_ns], dtype=np.int64))
        return Reached(
            knot=int(knot[0]),
            column=self._bases[unit_id] + STATES * int(knot[0]),
            since_m=since[0],
            place_m=place_of(self._beliefs[unit_id].x[knot], since)[0],
        )

    def apart_m(self, link: Link) -> float:
        return float(np.linalg.norm(self.of(link.one).place_m - self.of(link.other).place_m))

    def std_m(self, link: Link) -> float:
        """As the link counts now (Cauchy): less and less where it does not fit."""
        fit = self.apart_m(link) / (link.tail * link.std_m)
        return float(link.std_m * np.sqrt(1.0 + fit**2))


def add_link(equations: Equations, link: Link, places: Places) -> None:
    """The ends are at the same place."""
    one, other, std_m = places.of(link.one), places.of(link.other), places.std_m(link)
    terms = [
        (np.array([end.column]), sign, *(sign * end.since_m))
        for end, sign in ((one, 1.0), (other, -1.0))
    ]
    equations.add(
        std_m,
        0.0,
        *((column, sign) for column, sign, _, _ in terms),
        *((column + 2, north) for column, _, north, _ in terms),
        *((column + 3, -east) for column, _, _, east in terms),
    )
    equations.add(
        std_m,
        0.0,
        *((column + 1, sign) for column, sign, _, _ in terms),
        *((column + 2, east) for column, _, _, east in terms),
        *((column + 3, north) for column, _, north, _ in terms),
    )


def told_by_links(
    links: list[Link], places: Places, spreads: Mapping[str, Floats]
) -> dict[str, list[tuple[int, Floats]]]:
    """Knots by unit, each with the information (2, 2) that the other end is worth to it: no better
    than that is known without links (``spreads``).
    """
    told: dict[str, list[tuple[int, Floats]]] = {unit_id: [] for unit_id in spreads}
    for link in links:
        variance_m2 = places.std_m(link) ** 2 * np.eye(2)
        for end, other in ((link.one, link.other), (link.other, link.one)):
            known = spreads[other[0]][places.of(other).knot, :2, :2] + variance_m2
            information: Floats = np.asarray(np.linalg.inv(known), dtype=np.float64)
            told[end[0]].append((places.of(end).knot, information))
    return told
