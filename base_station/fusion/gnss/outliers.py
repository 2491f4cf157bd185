"""Rejected fixes, kept until they show a wrong path or a faulty receiver."""

from __future__ import annotations

import cmath
import math

import msgspec
import numpy as np

MIN_FIXES = 20  # so many fixes that draw the shape of the walk are right after all
MAX_FIXES = 60  # fixes: a slow walk leads far enough in a minute, and not in twenty seconds
SPREAD_M = 7.0  # root mean square of that stretch of path
MAX_RESIDUAL_PART = 0.25  # part of the fixes' variance that is not the shape of the walk
SCALES = (0.75, 1.33)


class WalkShape(msgspec.Struct, frozen=True):
    """Turn of the own path that lays it on the fixes."""

    turn_rad: float
    spread_m: float  # root of the sum of squares of the stretch, for the turn's uncertainty


class _Outlier(msgspec.Struct, frozen=True, array_like=True):
    north_m: float
    east_m: float
    own_north_m: float
    own_east_m: float


class Outliers(msgspec.Struct):
    """The latest fixes that were turned away, each with the own path's place."""

    kept: list[_Outlier] = msgspec.field(default_factory=list)

    def clear(self) -> None:
        self.kept.clear()

    def add(self, place_m: tuple[float, float], own_m: tuple[float, float]) -> WalkShape | None:
        """The shape of the walk where the fixes draw it, by least squares of
        ``seen = shift + a own`` over complex numbers (east the imaginary part); a receiver that
        wanders or hangs has no walk in it.
        """
        self.kept.append(_Outlier(*place_m, *own_m))
        del self.kept[:-MAX_FIXES]
        own = np.array([complex(o.own_north_m, o.own_east_m) for o in self.kept])
        seen = np.array([complex(o.north_m, o.east_m) for o in self.kept])
        own, seen = own - own.mean(), seen - seen.mean()
        walked_m2, seen_m2 = np.vdot(own, own).real, np.vdot(seen, seen).real
        if len(own) < MIN_FIXES or walked_m2 < len(own) * SPREAD_M**2:
            return None
        turn = complex(np.vdot(own, seen) / walked_m2)
        residual_part = 1.0 - abs(turn) ** 2 * walked_m2 / seen_m2
        if residual_part > MAX_RESIDUAL_PART or not SCALES[0] < abs(turn) < SCALES[1]:
            return None
        return WalkShape(cmath.phase(turn), math.sqrt(walked_m2))
