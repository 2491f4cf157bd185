"""A path's points and fixes: as they come, packed in rows, and as arrays in SI units.

A packed point is 56 bytes; lengths are in millimetres, which saturate and never wrap.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import msgspec
import numpy as np
from numpy.typing import NDArray

_MOST_MM = 2**31 - 1  # what a column holds
_TURN_RAD = 2.0 * math.pi

Records = NDArray[np.void]
Floats = NDArray[np.float64]
POINT_ROW = np.dtype(
    [
        ("t_ns", "<i8"),
        ("north_mm", "<i4"),  # own frame
        ("east_mm", "<i4"),
        ("std_mm", "<i4"),  # as the tracker states it
        ("heading_e4", "<i4"),  # own frame, 1e-4 rad
        ("moving_ms", "<i4"),  # since the point before
        ("shown_north_mm", "<i4"),  # in the incident frame, as estimated then without any pin
        ("shown_east_mm", "<i4"),
        ("shown_std_mm", "<i4"),  # along the longer axis
        ("shown_down_mm", "<i4"),
        ("shown_down_std_mm", "<i4"),
        ("floor", "<i4"),
        ("flags", "<i4"),
    ]
)
FIX_ROW = np.dtype([("t_ns", "<i8"), ("north_mm", "<i4"), ("east_mm", "<i4"), ("std_mm", "<i4")])
NO_FLOOR = -(2**31)
BREAK, RESTART, DOUBTFUL = 1, 2, 4  # flags: the path before and after do not join


class Point(msgspec.Struct, array_like=True):
    """One place of the own path; fields as in the packed rows, not rounded yet."""

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
    """Points in their order, fixes in any."""
    fixes = fixes[np.argsort(fixes["t_ns"], kind="stable")]
    metres = {name: rows[f"{name}_mm"] * 1e-3 for name in ("north", "east", "std")}
    return PathArrays(
        t_ns=rows["t_ns"].astype(np.int64),
        own_m=np.column_stack((metres["north"], metres["east"])),
        std_m=metres["std"],
        heading_rad=rows["heading_e4"] * 1e-4,
        moving_s=rows["moving_ms"] * 1e-3,
        shown_m=np.column_stack((rows["shown_north_mm"], rows["shown_east_mm"])) * 1e-3,
        shown_std_m=rows["shown_std_mm"] * 1e-3,
        down_m=rows["shown_down_mm"] * 1e-3,
        down_std_m=rows["shown_down_std_mm"] * 1e-3,
        floor=rows["floor"].astype(np.int64),
        flags=rows["flags"].astype(np.int64),
        fix_t_ns=fixes["t_ns"].astype(np.int64),
        fix_m=np.column_stack((fixes["north_mm"], fixes["east_mm"])) * 1e-3,
        fix_std_m=fixes["std_mm"] * 1e-3,
    )


def pack(points: list[Point]) -> Records:
    rows = np.zeros(len(points), POINT_ROW)
    columns = zip(*map(msgspec.structs.astuple, points), strict=True)
    for name, column in zip(POINT_ROW.names or (), columns, strict=False):
        values = np.array(column)
        if name == "heading_e4":  # whatever it says
            values = np.rint(values % _TURN_RAD * 1e4)
        elif name.endswith("_mm"):
            values = saturated(values * 1e3)
        rows[name] = values
    return rows


def move(
    rows: Records, north: str, east: str, turn_rad: float, north_m: float, east_m: float
) -> None:
    cosine, sine = np.cos(turn_rad), np.sin(turn_rad)
    north_mm, east_mm = rows[north].astype(float), rows[east].astype(float)
    rows[north] = saturated(cosine * north_mm - sine * east_mm + north_m * 1e3)
    rows[east] = saturated(sine * north_mm + cosine * east_mm + east_m * 1e3)


def saturated(millimetres: Floats) -> Floats:
    """An anchor on the other side of the Earth moves everything farther than a number holds."""
    return np.rint(np.clip(millimetres, -_MOST_MM, _MOST_MM))


def thinned(rows: Records) -> Records:
    """Every other point of the older half goes, but not where the path does not join."""
    half = len(rows) // 2
    keep = np.ones(len(rows), bool)
    keep[1:half:2] = (rows["flags"][1:half:2] & (BREAK | RESTART)) != 0
    after = np.flatnonzero(~keep) + 1
    thinned = rows.copy()
    thinned["moving_ms"][after] += rows["moving_ms"][after - 1]
    return thinned[keep]
