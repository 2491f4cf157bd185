"""A path's points and fixes: as they come, in rows of whole numbers, and as arrays in SI units.

Lengths in rows are centimetres, which saturate and never wrap.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import msgspec
import numpy as np
from numpy.typing import NDArray

from base_station.fusion.interface import Estimate, PlaceFix
from base_station.fusion.odometry.packed_rows import Records
from shared.clock import NS_PER_MS
from shared.messages import Position

_MOST_CM = 2**31 - 1  # the other side of the Earth is nearer
_TURN_RAD = 2.0 * math.pi

Floats = NDArray[np.float64]
_POINT = (
    "t_ms",
    "north_cm",  # own frame
    "east_cm",
    "std_cm",  # as the tracker states it
    "heading_e3",  # own frame, 1e-3 rad
    "moving_ms",  # since the point before
    "shown_north_cm",  # in the incident frame, as estimated then without any pin
    "shown_east_cm",
    "shown_std_cm",  # along the longer axis
    "shown_down_cm",
    "shown_down_std_cm",
    "floor",
    "flags",
)
_FIX = ("t_ms", "north_cm", "east_cm", "std_cm")
POINT_ROW = np.dtype([(name, "<i8") for name in _POINT])
FIX_ROW = np.dtype([(name, "<i8") for name in _FIX])
NO_FLOOR = -(2**31)
BREAK, RESTART, DOUBTFUL = 1, 2, 4  # flags: the path before and after do not join


class Point(msgspec.Struct, array_like=True, gc=False):
    """One place of the own path; fields as in the rows, not rounded yet."""

    t_ns: int = 0
    north_m: float = 0.0
    east_m: float = 0.0
    std_m: float = 0.0
    heading_rad: float = 0.0
    moving_ms: int = 0
    shown_north_m: float = 0.0
    shown_east_m: float = 0.0
    shown_std_m: float = 0.0
    shown_down_m: float = 0.0
    shown_down_std_m: float = 0.0
    floor: int = NO_FLOOR
    flags: int = 0

    @staticmethod
    def of(position: Position, t_ns: int, flags: int) -> Point:
        """Point at a position, not estimated yet."""
        point = Point(t_ns, flags=flags)
        point.follow(position)
        return point

    def follow(self, position: Position) -> None:
        """The point is where the own path is now."""
        self.north_m, self.east_m = position.north_m, position.east_m
        self.std_m = max(position.std_north_m, position.std_east_m)
        self.heading_rad = position.heading_rad

    def set_live_estimate(self, estimate: Estimate, floor: int | None) -> None:
        """Set the live estimate; a place that is only assumed counts as unknown."""
        self.shown_north_m, self.shown_east_m = estimate.north_m, estimate.east_m
        stated_m = max(estimate.std_north_m, estimate.std_east_m)
        self.shown_std_m = 0.0 if estimate.assumed else stated_m
        self.shown_down_m, self.shown_down_std_m = estimate.down_m, estimate.std_down_m
        self.floor = NO_FLOOR if floor is None else floor

    def continued(self) -> Point:
        """A point about which nothing is known but where this one was shown."""
        return Point(
            shown_north_m=self.shown_north_m,
            shown_east_m=self.shown_east_m,
            shown_std_m=self.shown_std_m,
            shown_down_m=self.shown_down_m,
            shown_down_std_m=self.shown_down_std_m,
            floor=self.floor,
        )


@dataclass(frozen=True)
class PathArrays:
    """A history in SI units; every array has one row a point."""

    t_ns: NDArray[np.int64]
    own_m: Floats  # (n, 2) north, east in the unit's own frame
    std_m: Floats  # (n,) as stated, growing
    heading_rad: Floats  # (n,) own frame
    moving_s: Floats  # (n,) since the point before
    shown_m: Floats  # (n, 2) north, east in the incident frame, as estimated then without any pin
    shown_std_m: Floats  # (n,) along the longer axis
    down_m: Floats  # (n,) incident frame, as estimated then
    down_std_m: Floats
    floor: NDArray[np.int64]  # NO_FLOOR: not known
    flags: NDArray[np.int64]
    fix_t_ns: NDArray[np.int64]
    fix_m: Floats  # (m, 2) north, east in the incident frame
    fix_std_m: Floats  # (m,)

    def __len__(self) -> int:
        return len(self.t_ns)


def arrays_of(rows: Records, fixes: Records) -> PathArrays:
    """Both by time."""
    return PathArrays(
        t_ns=rows["t_ms"] * NS_PER_MS,
        own_m=_metres(rows, "north_cm", "east_cm"),
        std_m=rows["std_cm"] * 1e-2,
        heading_rad=rows["heading_e3"] * 1e-3,
        moving_s=rows["moving_ms"] * 1e-3,
        shown_m=_metres(rows, "shown_north_cm", "shown_east_cm"),
        shown_std_m=rows["shown_std_cm"] * 1e-2,
        down_m=rows["shown_down_cm"] * 1e-2,
        down_std_m=rows["shown_down_std_cm"] * 1e-2,
        floor=rows["floor"].copy(),
        flags=rows["flags"].copy(),
        fix_t_ns=fixes["t_ms"] * NS_PER_MS,
        fix_m=_metres(fixes, "north_cm", "east_cm"),
        fix_std_m=fixes["std_cm"] * 1e-2,
    )


def rows_of(points: Sequence[Point]) -> Records:
    rows = np.zeros(len(points), POINT_ROW)
    columns = zip(*map(msgspec.structs.astuple, points), strict=True)
    for name, column in zip(_POINT, columns, strict=False):
        values = np.array(column)
        if name == "t_ms":
            values //= NS_PER_MS
        elif name == "heading_e3":  # any value
            values = np.rint(values % _TURN_RAD * 1e3)
        elif name.endswith("std_cm"):  # none is stated smaller than it is
            values = saturated(np.ceil(values * 1e2))
        elif name.endswith("_cm"):
            values = saturated(values * 1e2)
        rows[name] = values
    return rows


def fix_row(fix: PlaceFix, t_ns: int) -> Records:
    seen_cm = saturated(np.array([fix.north_m, fix.east_m]) * 1e2)
    std_cm = saturated(np.ceil(np.array([fix.horizontal_std_m]) * 1e2))
    return np.array([(t_ns // NS_PER_MS, *seen_cm, *std_cm)], FIX_ROW)


def saturated(centimetres: Floats) -> Floats:
    """An anchor on the other side of the Earth moves everything farther than a number holds."""
    return np.rint(np.clip(centimetres, -_MOST_CM, _MOST_CM))


def thinned(rows: Records) -> Records:
    """Rows without every other point; the last one and begins of frames stay. Times and flags of a
    dropped point go to the next one.
    """
    keep = np.ones(len(rows), bool)
    keep[1:-1:2] = (rows["flags"][1:-1:2] & RESTART) != 0
    after = np.flatnonzero(~keep) + 1
    thinned = rows.copy()
    thinned["moving_ms"][after] += rows["moving_ms"][after - 1]
    thinned["flags"][after] |= rows["flags"][after - 1]
    return thinned[keep]


def _metres(rows: Records, north: str, east: str) -> Floats:
    return np.column_stack((rows[north], rows[east])) * 1e-2
