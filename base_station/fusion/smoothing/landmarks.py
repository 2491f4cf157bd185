"""Places that several paths lead through: stairs, and where people met.

Each is an unknown of the one problem, and each path that leads through it a visit.  Visits are
weighed robustly: one that does not fit counts less and less (a Cauchy kernel).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.smoothing.chain import STATES, PathEstimate, place_of
from base_station.fusion.smoothing.equations import Equations

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Visit:
    unit_id: str
    knot: int
    since_m: Floats  # (2,) own path from the knot


@dataclass(frozen=True)
class Landmark:
    visits: Sequence[Visit]
    std_m: float  # of each visit, each axis
    tail: float  # standard deviations from which one counts less


class Visited:
    """Places of visits by the present estimates."""

    def __init__(self, bases: Mapping[str, int], estimates: Mapping[str, PathEstimate]) -> None:
        self._bases, self._estimates = bases, estimates

    def places_m(self, landmark: Landmark) -> Floats:
        """(v, 2)."""
        x = np.array([self._estimates[one.unit_id].x[one.knot] for one in landmark.visits])
        return place_of(x, np.array([one.since_m for one in landmark.visits]))

    def apart_m(self, meeting: Landmark) -> float:
        """Distance of the two units of an encounter."""
        one, other = self.places_m(meeting)
        return float(np.linalg.norm(one - other))

    def add(self, equations: Equations, landmark: Landmark, column: int, place_m: Floats) -> None:
        """Add the equations of a landmark. ``column``: of its north; ``place_m`` (2,): its
        estimated place.
        """
        apart_m = np.linalg.norm(self.places_m(landmark) - place_m, axis=1)
        std_m = landmark.std_m * np.sqrt(1.0 + (apart_m / (landmark.tail * landmark.std_m)) ** 2)
        north, east = np.array([one.since_m for one in landmark.visits]).T
        own = np.array([self._bases[one.unit_id] + STATES * one.knot for one in landmark.visits])
        there = np.full(len(own), column)
        equations.add(
            std_m, 0.0,
            (own, 1.0), (own + 2, north), (own + 3, -east), (there, -1.0),
        )  # fmt: skip
        equations.add(
            std_m, 0.0,
            (own + 1, 1.0), (own + 2, east), (own + 3, north), (there + 1, -1.0),
        )  # fmt: skip
