"""The height of one unit's trail: as it was estimated then, shifted by what places say of it.

The shift wanders as fast as the estimate's own uncertainty grew; a tridiagonal problem.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

from base_station.fusion.path.points import PathArrays
from base_station.fusion.smoother.port import PlaceSeen

Floats = NDArray[np.float64]

PLACE_DOWN_STD_M = 0.4  # of somebody on a floor that is known
WANDER_M_PER_SQRT_S = 0.02


def solve_heights(
    path: PathArrays, places: Sequence[PlaceSeen]
) -> tuple[Floats, Floats, tuple[float, float | None]]:
    """Down and its standard deviation of every point, and the shift at the last one with its
    standard deviation, None where no place says anything.
    """
    told = [place for place in places if place.down_m is not None]
    std = np.maximum(path.down_std_m, 0.1)
    if not told:
        return path.down_m, std, (0.0, None)
    rows = np.searchsorted(path.t_ns, [place.t_ns for place in told]).clip(0, len(path) - 1)
    seconds = np.diff(path.t_ns) * 1e-9
    grown = np.maximum(np.diff(std**2), 0.0) + WANDER_M_PER_SQRT_S**2 * seconds + 1e-6
    diagonal, right = np.zeros(len(path)), np.zeros(len(path))
    diagonal[0] += 1.0 / std[0] ** 2
    diagonal[:-1] += 1.0 / grown
    diagonal[1:] += 1.0 / grown
    for row, place in zip(rows, told, strict=True):
        assert place.down_m is not None
        diagonal[row] += 1.0 / PLACE_DOWN_STD_M**2
        right[row] += (place.down_m - path.down_m[row]) / PLACE_DOWN_STD_M**2
    banded = np.vstack((np.concatenate(([0.0], -1.0 / grown)), diagonal))
    shift = solveh_banded(banded[-len(path) :], right)  # a single point has nothing beside it
    variance = _variances(diagonal, -1.0 / grown)
    return path.down_m + shift, np.sqrt(variance), (float(shift[-1]), float(np.sqrt(variance[-1])))


def _variances(diagonal: Floats, beside: Floats) -> Floats:
    """Diagonal of the inverse of a symmetric tridiagonal matrix."""
    count = len(diagonal)
    ahead, behind = np.empty(count), np.empty(count)
    ahead[0] = diagonal[0]
    for row in range(1, count):
        ahead[row] = diagonal[row] - beside[row - 1] ** 2 / ahead[row - 1]
    behind[-1] = diagonal[-1]
    for row in range(count - 2, -1, -1):
        behind[row] = diagonal[row] - beside[row] ** 2 / behind[row + 1]
    return 1.0 / (ahead + behind - diagonal)
