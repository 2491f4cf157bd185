"""What a smoother is: from the own paths of units and all that is known of them, whole trails.

A smoother is pure: the same evidence gives the same trails.  Places are in the incident frame,
times are the station's.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.path.points import PathArrays
from base_station.fusion.port import Present, Start
from base_station.site.floor_grid import FloorGrid

Floats = NDArray[np.float64]

ON_FLOOR_STD_M = 0.4  # of the height of somebody on a floor that is known


@dataclass(frozen=True)
class PlaceSeen:
    """A unit was at a place; which way its wearer went then may be known too."""

    name: str  # of the pin
    t_ns: int
    north_m: float
    east_m: float
    std_m: float  # each axis
    down_m: float | None = None
    down_std_m: float = ON_FLOOR_STD_M
    heading_rad: float | None = None  # of travel, in the incident frame
    heading_std_rad: float = 0.0
    source: str = ""  # what may say it again, and again wrong: a beacon, or somebody who was met

    @property
    def voice(self) -> str:
        """Those of one source are one."""
        return self.source or self.name


@dataclass(frozen=True)
class Tie:
    """Two units were beside each other."""

    name: str
    unit_id: str
    other_id: str
    t_ns: int
    std_m: float  # each axis


@dataclass(frozen=True)
class UnitEvidence:
    """All that is known of one unit."""

    path: PathArrays  # at least one point
    start: Start | None  # of the own frame that begins at ``start_ns``
    start_ns: int = 0
    places: Sequence[PlaceSeen] = ()  # in the order in which they came to be known
    grid: FloorGrid | None = None  # walls of the plan
    height_assumed: bool = False  # nothing has told how high the own frame begins


@dataclass(frozen=True)
class Verdict:
    """What became of a place or a tie."""

    used: bool
    residual_m: float  # between it and the trail
    sigmas: float  # the same in standard deviations of what was expected without it
    against: str = ""  # the one it contradicts most; empty: the path and the fixes
    above_m: float = 0.0  # so far above the trail it is, where that is what contradicts


@dataclass(frozen=True)
class SmoothedPath:
    """One row a point of the evidence's path; NED metres."""

    t_ns: NDArray[np.int64]
    north_m: Floats
    east_m: Floats
    down_m: Floats
    std_north_m: Floats
    std_east_m: Floats
    correlation_ne: Floats
    std_down_m: Floats
    turn_rad: Floats  # heading of the own frame's north
    present: Present  # the last point, on the plan where its walls are heeded

    @property
    def places_m(self) -> Floats:
        """(n, 3)"""
        return np.column_stack((self.north_m, self.east_m, self.down_m))


@dataclass(frozen=True)
class Solution:
    paths: Mapping[str, SmoothedPath]  # by unit
    verdicts: Mapping[str, Verdict]  # by name of the place or tie


class Smoother(Protocol):
    """A frozen dataclass whose fields are the smoother's parameters."""

    @property
    def name(self) -> str:
        """Short, lower case, with hyphens."""
        ...

    def solve(self, units: Mapping[str, UnitEvidence], ties: Sequence[Tie] = ()) -> Solution:
        """Trails from what is said, at once: while the incident runs."""
        ...

    def smooth(self, units: Mapping[str, UnitEvidence], ties: Sequence[Tie] = ()) -> Solution:
        """As ``solve``, and with whatever the trails tell of each other: afterwards."""
        ...
