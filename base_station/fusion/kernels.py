"""The arithmetic that every position of every unit goes through, compiled.

The filters are ``filterpy``'s, and whatever is fused into the path (fixes, their heights, storeys)
goes through its update.  What happens five times a second a unit is done here, in place, on the
arrays of those filters: ``mean`` (n, 1) and ``covariance`` (n, n).  Each of these equals filterpy's
``predict`` or ``update`` with the matrices that its text names.

The types stand with the functions, so that nothing is ever compiled while the station is live: it
is done when this is first imported, and kept on the disk (``muster base compile``).
"""

from __future__ import annotations

import math
from functools import partial
from typing import NamedTuple

import numpy as np
from numba import njit
from numba.core.types import UniTuple, boolean, float64, void
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_DRIFT = 8
_LEAST_SCALE2 = 0.05  # of a state whose turn means anything

# What ``climb`` remembers of the own path.
LEVEL_M = 0  # walked since it last climbed
CLIMBED_M = 1  # net, in these metres
SETTLED_M2 = 2  # the unit's own variance of its height when its wearer last walked
DOUBT_M2 = 3  # by how much it is larger now
RODE_M = 4  # climbed while the wearer rests
PATH = 5


class Placed(NamedTuple):
    """Where a unit is and how its own frame is turned, out of a state of ``HorizontalFilter``."""

    north_m: float
    east_m: float
    std_north_m: float
    std_east_m: float
    correlation_ne: float
    turn_rad: float
    turn_std_rad: float  # pi: not known

    def widened(self, variance_m2: float) -> Placed:
        """The place less sure by so much, each axis."""
        std_north_m = math.sqrt(self.std_north_m**2 + variance_m2)
        std_east_m = math.sqrt(self.std_east_m**2 + variance_m2)
        product = std_north_m * std_east_m
        shared = self.correlation_ne * self.std_north_m * self.std_east_m
        return self._replace(
            std_north_m=std_north_m,
            std_east_m=std_east_m,
            correlation_ne=shared / product if product > 0.0 else 0.0,
        )


_VECTOR, _MATRIX = float64[:], float64[:, :]  # of any layout: filterpy makes new ones
_THREE = UniTuple(float64, 3)  # type: ignore[no-untyped-call]
_PLACED = UniTuple(float64, len(Placed._fields))  # type: ignore[no-untyped-call]
_compiled = partial(njit, cache=True, error_model="numpy")


@_compiled(float64(_VECTOR, _MATRIX, _VECTOR))
def _between(one: Floats, covariance: Floats, other: Floats) -> float:
    """The covariance of two sums of the first states."""
    total = 0.0
    for i in range(len(one)):
        for j in range(len(other)):
            total += one[i] * covariance[i, j] * other[j]
    return total


@_compiled(void(_MATRIX, _MATRIX, float64, float64, float64, float64, float64, float64))
def walk(
    mean: Floats,
    covariance: Floats,
    north_m: float,
    east_m: float,
    moving_s: float,
    place_var_m2: float,
    turn_var: float,
    drift_var: float,
) -> None:
    """The own path went on: the state of ``HorizontalFilter`` is predicted.

    With ``c, s`` after the drift, ``(a, b)`` cosine and sine of what was drifted and ``t`` the
    time moving, the Jacobian is the identity but for

        north  [1, 0, dn, -de, 0 ...    0]        c  [0, 0, a, -b, 0 ... -s t]
        east   [0, 1, de,  dn, 0 ...    0]        s  [0, 0, b,  a, 0 ...  c t]

    and the noise is that of the place, of the turn across ``(c, s)``, and of the drift rate.
    """
    drifted_rad = mean[_DRIFT, 0] * moving_s
    cosine, sine = math.cos(drifted_rad), math.sin(drifted_rad)
    c = cosine * mean[2, 0] - sine * mean[3, 0]
    s = sine * mean[2, 0] + cosine * mean[3, 0]
    by_drift_c, by_drift_s = -s * moving_s, c * moving_s
    for column in range(_DRIFT + 1):
        of_c, of_s = covariance[2, column], covariance[3, column]
        of_drift = covariance[_DRIFT, column]
        covariance[0, column] += north_m * of_c - east_m * of_s
        covariance[1, column] += east_m * of_c + north_m * of_s
        covariance[2, column] = cosine * of_c - sine * of_s + by_drift_c * of_drift
        covariance[3, column] = sine * of_c + cosine * of_s + by_drift_s * of_drift
    for row in range(_DRIFT + 1):
        of_c, of_s = covariance[row, 2], covariance[row, 3]
        of_drift = covariance[row, _DRIFT]
        covariance[row, 0] += north_m * of_c - east_m * of_s
        covariance[row, 1] += east_m * of_c + north_m * of_s
        covariance[row, 2] = cosine * of_c - sine * of_s + by_drift_c * of_drift
        covariance[row, 3] = sine * of_c + cosine * of_s + by_drift_s * of_drift
    covariance[0, 0] += place_var_m2
    covariance[1, 1] += place_var_m2
    covariance[2, 2] += turn_var * s * s
    covariance[3, 3] += turn_var * c * c
    covariance[2, 3] -= turn_var * c * s
    covariance[3, 2] -= turn_var * c * s
    covariance[_DRIFT, _DRIFT] += drift_var
    mean[0, 0] += c * north_m - s * east_m
    mean[1, 0] += s * north_m + c * east_m
    mean[2, 0], mean[3, 0] = c, s


@_compiled(void(_MATRIX, _MATRIX, _VECTOR, _THREE, boolean, _THREE))
def climb(
    mean: Floats,
    covariance: Floats,
    path: Floats,
    stretch: tuple[float, float, float],
    moves: bool,
    how: tuple[float, float, float],
) -> None:
    """The own height went on: the state of ``HeightFilter`` is predicted.

    ``stretch``: metres down, metres walked, and how sure the unit is of its height; ``moves``:
    whether its wearer goes anywhere; ``how``: the variance by metre climbed and by metre walked,
    and the climb that changes floor.  ``path`` (PATH,) is what is remembered of stretches before:
    a unit that rests and grows less sure of its height may be riding a lift.
    """
    down_m, walked_m, own_std_m = stretch
    per_climb_m2, per_walk_m2, level_m = how
    grown_m2 = max(0.0, own_std_m * own_std_m - path[SETTLED_M2])
    ridden_m2 = 0.0
    if moves:
        ridden_m2 = grown_m2  # what is left of a ride that is over
        path[SETTLED_M2] = own_std_m * own_std_m
        path[DOUBT_M2] = path[RODE_M] = 0.0
    else:
        path[DOUBT_M2] = grown_m2
        path[RODE_M] += down_m
    stairs_m2 = per_climb_m2 * abs(down_m) + per_walk_m2 * walked_m
    mean[0, 0] += down_m
    if path[DOUBT_M2] < stairs_m2:  # else the unit knows of the ride, and how well
        covariance[0, 0] += max(stairs_m2, ridden_m2)
    path[LEVEL_M] += walked_m
    path[CLIMBED_M] += down_m
    if abs(path[CLIMBED_M]) > level_m:
        path[LEVEL_M] = path[CLIMBED_M] = 0.0


@_compiled(void(_MATRIX, _MATRIX, float64, float64, float64, float64))
def feel_air(
    mean: Floats,
    covariance: Floats,
    down_m: float,
    wander_m2: float,
    noise_m2: float,
    gate2: float,
) -> None:
    """A barometer's height into the state of ``HeightFilter``, whose shift wandered meanwhile.

    Measured is ``[1, 0, 1]`` of the state with ``noise_m2``.  What lies farther off than
    ``gate2`` (squared standard deviations) is a step of pressure and widens the shift first.
    """
    covariance[2, 2] += wander_m2
    innovation_m = down_m - mean[0, 0] - mean[2, 0]
    spread_m2 = covariance[0, 0] + covariance[0, 2] + covariance[2, 0] + covariance[2, 2] + noise_m2
    if innovation_m * innovation_m > gate2 * spread_m2:
        covariance[2, 2] += innovation_m * innovation_m
        spread_m2 += innovation_m * innovation_m
    gain = np.empty(3)
    for i in range(3):
        gain[i] = (covariance[i, 0] + covariance[i, 2]) / spread_m2
        mean[i, 0] += gain[i] * innovation_m
    for column in range(3):  # (1 - K H) P
        seen = covariance[0, column] + covariance[2, column]
        for i in range(3):
            covariance[i, column] -= gain[i] * seen
    for row in range(3):  # the same from the right, and K R K'
        seen = covariance[row, 0] + covariance[row, 2]
        for j in range(3):
            covariance[row, j] += gain[j] * (noise_m2 * gain[row] - seen)


@_compiled(_PLACED(_MATRIX, _MATRIX, float64, float64))
def placed_before(
    mean: Floats, covariance: Floats, north_m: float, east_m: float
) -> tuple[float, ...]:
    """What ``Placed`` holds, by a state of ``HorizontalFilter``.  The place is that before so much
    of own path was walked: ``[1, 0, -dn, de, 0 ...]`` and ``[0, 1, -de, -dn, 0 ...]`` of it.
    """
    c, s = mean[2, 0], mean[3, 0]
    north = np.array([1.0, 0.0, -north_m, east_m])
    east = np.array([0.0, 1.0, -east_m, -north_m])
    across = np.array([0.0, 0.0, -s, c])
    std_north_m = math.sqrt(max(_between(north, covariance, north), 0.0))
    std_east_m = math.sqrt(max(_between(east, covariance, east), 0.0))
    product = std_north_m * std_east_m
    scale2 = c * c + s * s
    turn_rad, turn_std_rad = 0.0, math.pi
    if scale2 >= _LEAST_SCALE2:
        turn_rad = math.atan2(s, c)
        turn_var = max(_between(across, covariance, across), 0.0) / (scale2 * scale2)
        turn_std_rad = min(math.sqrt(turn_var), math.pi)
    return (
        mean[0, 0] - c * north_m + s * east_m,
        mean[1, 0] - s * north_m - c * east_m,
        std_north_m,
        std_east_m,
        _between(north, covariance, east) / product if product > 0.0 else 0.0,
        turn_rad,
        turn_std_rad,
    )
