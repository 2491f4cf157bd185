"""Thinning of lines by Douglas and Peucker (1973)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]


def corners(places_m: Floats, tolerance_m: float) -> Flags:
    """Flags of the points (n, 2) to keep: both ends, and those without which the line would be more
    than ``tolerance_m`` away from a point that is left out.
    """
    kept = np.zeros(len(places_m), dtype=np.bool_)
    kept[[0, -1]] = True
    parts = [(0, len(places_m) - 1)]
    while parts:
        begin, end = parts.pop()
        if end - begin < 2:
            continue
        off_m = _distances_m(places_m[begin + 1 : end], places_m[begin], places_m[end])
        worst = int(off_m.argmax())
        if off_m[worst] > tolerance_m:
            middle = begin + 1 + worst
            kept[middle] = True
            parts += [(begin, middle), (middle, end)]
    return kept


def _distances_m(places_m: Floats, begin_m: Floats, end_m: Floats) -> Floats:
    """Distances of places (n, 2) from a straight line between two."""
    way_m, from_begin_m = end_m - begin_m, places_m - begin_m
    length2_m2 = float(way_m @ way_m)
    along = (from_begin_m @ way_m) / length2_m2 if length2_m2 > 0.0 else np.zeros(len(places_m))
    off_m: Floats = from_begin_m - np.clip(along, 0.0, 1.0)[:, None] * way_m
    return np.asarray(np.hypot(off_m[:, 0], off_m[:, 1]))
