"""Interface of smoothers: whole paths from the own paths of units and all other evidence.

A smoother is pure: the same evidence gives the same paths. Places are in the incident frame, times
are the station's.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.interface import Posterior, Start
from base_station.fusion.odometry.noise_runs import NoiseRun
from base_station.fusion.odometry.points import PathArrays
from base_station.site.floor_grid import FloorGrid
from shared.path_noise import PathNoise

Floats = NDArray[np.float64]

ON_FLOOR_STD_M = 0.4  # of the height of a wearer on a known floor


@dataclass(frozen=True)
class PositionConstraint:
    """A unit at a place at a time; the heading of travel may be known too."""

    name: str  # of the pin
    t_ns: int
    north_m: float
    east_m: float
    std_m: float  # each axis
    down_m: float | None = None
    down_std_m: float = ON_FLOOR_STD_M
    heading_rad: float | None = None  # of travel, in the incident frame
    heading_std_rad: float = 0.0
    source: str = ""  # of repeated, equally wrong places: a beacon, or a met partner

    @property
    def source_key(self) -> str:
        """Key of the source: constraints of one source count as one."""
        return self.source or self.name


@dataclass(frozen=True)
class EncounterConstraint:
    """Two units at one place at a time."""

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
    places: Sequence[PositionConstraint] = ()  # in the order in which they came to be known
    grid: FloorGrid | None = None  # walls of the plan
    height_assumed: bool = False  # no evidence how high the own frame begins
    path_noise: PathNoise | None = None  # as the unit's tracker states it, after ...
    noise_runs: Sequence[NoiseRun] = ()  # ... these runs, by time


@dataclass(frozen=True)
class Verdict:
    """Result of the test of a constraint."""

    used: bool
    residual_m: float  # between it and the trail
    sigmas: float  # the same in standard deviations of the expectation without it
    against: str = ""  # the one it contradicts most; empty: the path and the fixes
    above_m: float = 0.0  # its height above the trail, where that contradicts


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
    posterior: Posterior  # the last point, on the plan where its walls are heeded

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

    def solve(
        self, units: Mapping[str, UnitEvidence], encounters: Sequence[EncounterConstraint] = ()
    ) -> Solution:
        """Paths by position constraints and encounters, fast enough for a running incident."""
        ...

    def smooth(
        self, units: Mapping[str, UnitEvidence], encounters: Sequence[EncounterConstraint] = ()
    ) -> Solution:
        """Paths as of ``solve``, with loop closures between paths as well; for post-processing."""
        ...
