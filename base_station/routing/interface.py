"""Trails and positions over which ways are searched, and the routes that are found."""

from __future__ import annotations

import msgspec
import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]
Flags = NDArray[np.bool_]

NO_FLOOR = -1_000_000  # number of a floor that is not known
STOREY_M = 3.0  # rise of a storey without a height in the plan (ours)


class Waypoint(msgspec.Struct, frozen=True):
    """Point in the incident frame."""

    north_m: float
    east_m: float
    floor: int | None


class WalkedTrail(msgspec.Struct, frozen=True):
    """Way of one unit until now, oldest point first; the last point is its position."""

    unit_id: str
    places_m: Floats  # (n, 2), north and east
    floors: Indices  # (n,), ``NO_FLOOR`` where it is not known
    after_gap: Flags  # (n,), the way from the point before is unknown
    std_m: float  # of the position now, in one direction; of the trail it is no less


class Route(msgspec.Struct, frozen=True):
    """Shortest known way of one unit to another."""

    places: tuple[Waypoint, ...]  # its corners, both ends among them
    distance_m: float  # walked distance, with the addition for stairs
    std_m: float  # of its end as seen from its begin, in one direction
    crosses_walls: bool  # a trail on it leads through a wall of the plan
