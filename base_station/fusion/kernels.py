"""Compiled filter steps that every position of every unit goes through.

Symbols: ``x`` (n,) is a record's ``mean``, ``P`` (n, n) its ``covariance``, ``F`` the Jacobian of a
prediction, ``Q`` its noise, ``H`` the Jacobian of a measurement, ``R`` its variance.  Metres,
seconds and radians; north, east and down of the incident frame unless stated otherwise.

The state of each filter is one record, so that a position finds it in a few pieces of memory.
Steps that run five times a second for each unit are here and work in place; each equals filterpy's
``predict`` or ``update`` with the matrices of its docstring.  Fixes, their heights and storeys,
which come less often, go through ``filterpy`` itself.

Signatures are declared, so that nothing is compiled while the station is live: numba compiles at
the first import and keeps the result on disk (``muster base compile``).
"""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import msgspec
import numpy as np
from numba import from_dtype, njit
from numba.core.types import UniTuple, boolean, float64, void
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Record = NDArray[Any]  # (1,): a record of one of the types below

# Of the state of ``HorizontalFilter``, see ``horizontal.state``.
STATES = 9
DRIFT = 8

_LEAST_SCALE2 = 0.05  # smallest squared scale with a meaningful turn

# Elements of the memory of ``predict_height``.
LEVEL_M = 0  # walked since it last climbed
CLIMBED_M = 1  # net, in these metres
REST_VAR_M2 = 2  # stated variance of the own height when the wearer last walked
RIDE_VAR_M2 = 3  # growth of that variance since
RIDDEN_M = 4  # climbed while the wearer rests
PATH = 5

PLANE = np.dtype([("mean", np.float64, STATES), ("covariance", np.float64, (STATES, STATES))])
HEIGHT = np.dtype(
    [("mean", np.float64, 3), ("covariance", np.float64, (3, 3)), ("path", np.float64, PATH)]
)
ODOMETRY = np.dtype(  # memory of ``integrate_increment``
    [
        ("north_m", np.float64),  # where it was last
        ("east_m", np.float64),
        ("down_m", np.float64),
        ("std_m", np.float64),  # as stated, along the worse axis
        ("heading_std_rad", np.float64),
        ("step_rad", np.float64),  # direction of the last increment; NaN: there was none
        ("moved_heading_std_rad", np.float64),  # when it moved last; NaN: none was stated yet
        ("moving_s", np.float64),
        ("heading_std_growth_radps", np.float64),  # recent growth of that, while moving
        ("drift_radps", np.float64),  # how fast its heading may drift
    ]
)
PARAMS = np.dtype(  # of ``Parameters``
    [
        (name, np.float64)
        for name in (
            "walk_m_per_sqrt_m",
            "turn_rad_per_sqrt_m",
            "turn_part",
            "drift_radps",
            "drift_least_radps",
            "drift_most_radps",
            "drift_inflation",
            "fastest_mps",
        )
    ]
)
MOVING_MPS = 0.1
MIN_DIRECTION_M = 0.1  # of way that has a direction
DRIFT_LEARNING_S = 10.0  # moved, after which the unit's own heading gives its drift
DRIFT_WINDOW_S = 60.0  # moved, over which that is judged
SUDDEN_GROWTH = 3.0  # so much faster than that, a heading's uncertainty has grown by something else


class HorizontalEstimate(msgspec.Struct, frozen=True, gc=False):
    """Place of a unit and turn of its own frame, from a state of ``HorizontalFilter``."""

    north_m: float
    east_m: float
    std_north_m: float
    std_east_m: float
    correlation_ne: float
    turn_rad: float
    turn_std_rad: float  # pi: not known

    def inflated(self, variance_m2: float) -> HorizontalEstimate:
        """Estimate with this much more variance of the place, each axis."""
        std_north_m = math.sqrt(self.std_north_m**2 + variance_m2)
        std_east_m = math.sqrt(self.std_east_m**2 + variance_m2)
        product = std_north_m * std_east_m
        shared = self.correlation_ne * self.std_north_m * self.std_east_m
        return msgspec.structs.replace(
            self,
            std_north_m=std_north_m,
            std_east_m=std_east_m,
            correlation_ne=shared / product if product > 0.0 else 0.0,
        )


class OdometryIncrement(msgspec.Struct, frozen=True, gc=False):
    """Movement from one position to the next, in the unit's own frame."""

    north_m: float
    east_m: float
    down_m: float
    length_m: float
    moving_s: float
    place_var_m2: float  # variance added to the place, each axis
    turn_var: float
    drift_radps: float  # deviation of the drift rate, from the stated heading deviation


_VECTOR, _MATRIX = float64[:], float64[:, :]  # of any layout
_PLANE, _HEIGHT, _ODOMETRY, _PARAMS = (
    from_dtype(one)[::1] for one in (PLANE, HEIGHT, ODOMETRY, PARAMS)
)
_THREE = UniTuple(float64, 3)  # type: ignore[no-untyped-call]
_HORIZONTAL_ESTIMATE = UniTuple(float64, len(HorizontalEstimate.__struct_fields__))  # type: ignore[no-untyped-call]
_INCREMENT = UniTuple(float64, len(OdometryIncrement.__struct_fields__))  # type: ignore[no-untyped-call]
_compiled = partial(njit, cache=True, error_model="numpy")


@_compiled(float64(_VECTOR, _MATRIX, _VECTOR))
def _covariance_of(one: Floats, covariance: Floats, other: Floats) -> float:
    """Covariance of two linear combinations of the first states: one' P other."""
    total = 0.0
    for i in range(len(one)):
        for j in range(len(other)):
            total += one[i] * covariance[i, j] * other[j]
    return total


@_compiled(_INCREMENT(_ODOMETRY, _PARAMS, _THREE, _THREE, float64, boolean))
def integrate_increment(
    own: Record,
    params: Record,
    to_m: tuple[float, float, float],
    stds: tuple[float, float, float],
    duration_s: float,
    sure: bool,
) -> tuple[float, ...]:
    """Fields of ``OdometryIncrement``: movement in the own frame and the noise that it adds.

    From the last position ``p`` (at first the frame's origin) to ``to_m`` (north, east, down):

        d = to_m - p,  l = |d_ne|
        place variance  q_l l + min(max(0, s^2 - s_last^2), (v_max dt)^2), the second where not sure
        turn variance   q_t l + growth of the stated heading variance beyond the drift + (k turn)^2

    with ``q_l``, ``q_t``, ``k``, ``v_max`` of ``params``.  ``stds``: stated deviations of north and
    east (``s``: the larger) in metres and of the heading in radians; ``sure``: quality of the path
    is good.  The drift rate is what the stated heading deviation grows by while the wearer moves.
    """
    last, values = own[0], params[0]
    std_m, heading_std_rad = max(stds[0], stds[1]), stds[2]
    drift_var = excess_m2 = turned_rad = 0.0
    if math.isnan(last.moved_heading_std_rad):
        last.moved_heading_std_rad, duration_s = heading_std_rad, 0.0
    else:
        if heading_std_rad > last.heading_std_rad:  # by more than it drifts
            usual_rad = SUDDEN_GROWTH * last.drift_radps * duration_s
            grown = heading_std_rad**2 - last.heading_std_rad**2
            drift_var = max(0.0, grown - 2.0 * heading_std_rad * usual_rad)
        if not sure:
            added_m2 = max(0.0, std_m**2 - last.std_m**2)
            excess_m2 = min(added_m2, (values.fastest_mps * duration_s) ** 2)
    north_m, east_m, down_m = to_m[0] - last.north_m, to_m[1] - last.east_m, to_m[2] - last.down_m
    length_m = math.hypot(north_m, east_m)
    moving_s = duration_s if length_m > MOVING_MPS * duration_s else 0.0
    if length_m >= MIN_DIRECTION_M:
        step_rad = math.atan2(east_m, north_m)
        if not math.isnan(last.step_rad):
            turned_rad = (step_rad - last.step_rad + math.pi) % (2.0 * math.pi) - math.pi
        last.step_rad = step_rad
    last.north_m, last.east_m, last.down_m = to_m
    last.std_m, last.heading_std_rad = std_m, heading_std_rad
    if moving_s > 0.0:
        last.moving_s += moving_s
        grown_rad = heading_std_rad - last.moved_heading_std_rad
        of_late_s = min(last.moving_s, DRIFT_WINDOW_S)
        last.heading_std_growth_radps += (
            grown_rad - moving_s * last.heading_std_growth_radps
        ) / of_late_s
        last.moved_heading_std_rad = heading_std_rad
    last.drift_radps = values.drift_radps
    if last.moving_s >= DRIFT_LEARNING_S:
        stated_radps = values.drift_inflation * last.heading_std_growth_radps
        last.drift_radps = min(max(stated_radps, values.drift_least_radps), values.drift_most_radps)
    place_var_m2 = values.walk_m_per_sqrt_m**2 * length_m + excess_m2
    turn_var = (
        values.turn_rad_per_sqrt_m**2 * length_m + drift_var + (values.turn_part * turned_rad) ** 2
    )
    return (north_m, east_m, down_m, length_m, moving_s, place_var_m2, turn_var, last.drift_radps)


@_compiled(void(_PLANE, float64, float64, float64, float64, float64, float64))
def predict_horizontal(
    plane: Record,
    north_m: float,
    east_m: float,
    moving_s: float,
    place_var_m2: float,
    turn_var: float,
    drift_var: float,
) -> None:
    """Predict the state of ``HorizontalFilter``: x = f(x, d), P = F P F' + Q.

    ``d = (dn, de)``: increment of the own path in metres, ``t``: seconds moving.  The drift turns
    ``(c, s)`` by ``w t``, with cosine and sine ``(a, b)``; then

        north += c dn - s de        east += s dn + c de

    ``F`` is the identity but for

        north  [1, 0, dn, -de, 0 ...    0]        c  [0, 0, a, -b, 0 ... -s t]
        east   [0, 1, de,  dn, 0 ...    0]        s  [0, 0, b,  a, 0 ...  c t]

    and ``Q`` is ``place_var_m2`` of north and east, ``turn_var`` across ``(c, s)`` and
    ``drift_var`` of the drift rate ``w``.
    """
    mean, covariance = plane[0].mean, plane[0].covariance
    drifted_rad = mean[DRIFT] * moving_s
    cosine, sine = math.cos(drifted_rad), math.sin(drifted_rad)
    c = cosine * mean[2] - sine * mean[3]
    s = sine * mean[2] + cosine * mean[3]
    by_drift_c, by_drift_s = -s * moving_s, c * moving_s
    for column in range(DRIFT + 1):
        of_c, of_s = covariance[2, column], covariance[3, column]
        of_drift = covariance[DRIFT, column]
        covariance[0, column] += north_m * of_c - east_m * of_s
        covariance[1, column] += east_m * of_c + north_m * of_s
        covariance[2, column] = cosine * of_c - sine * of_s + by_drift_c * of_drift
        covariance[3, column] = sine * of_c + cosine * of_s + by_drift_s * of_drift
    for row in range(DRIFT + 1):
        of_c, of_s = covariance[row, 2], covariance[row, 3]
        of_drift = covariance[row, DRIFT]
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
    covariance[DRIFT, DRIFT] += drift_var
    mean[0] += c * north_m - s * east_m
    mean[1] += s * north_m + c * east_m
    mean[2], mean[3] = c, s


@_compiled(void(_HEIGHT, _THREE, boolean, _THREE))
def predict_height(
    height: Record,
    increment: tuple[float, float, float],
    moves: bool,
    params: tuple[float, float, float],
) -> None:
    """Predict the state of ``HeightFilter``: x[0] += d, P[0, 0] += q_c |d| + q_w l.

    ``increment``: ``d`` metres down, ``l`` metres walked, and the stated deviation of the own
    height in metres; ``moves``: the wearer moves; ``params``: ``q_c`` and ``q_w``, variance a metre
    climbed and a metre walked, and the climb in metres that changes floor.  ``path`` is the memory
    of earlier increments: a unit that rests while its stated deviation grows may ride a lift, and
    then that growth is the noise.
    """
    mean, covariance, path = height[0].mean, height[0].covariance, height[0].path
    down_m, walked_m, own_std_m = increment
    per_climb_m2, per_walk_m2, level_m = params
    grown_m2 = max(0.0, own_std_m * own_std_m - path[REST_VAR_M2])
    ridden_m2 = 0.0
    if moves:
        ridden_m2 = grown_m2  # the rest of an ended ride
        path[REST_VAR_M2] = own_std_m * own_std_m
        path[RIDE_VAR_M2] = path[RIDDEN_M] = 0.0
    else:
        path[RIDE_VAR_M2] = grown_m2
        path[RIDDEN_M] += down_m
    stairs_m2 = per_climb_m2 * abs(down_m) + per_walk_m2 * walked_m
    mean[0] += down_m
    if path[RIDE_VAR_M2] < stairs_m2:  # else the unit knows of the ride, and how well
        covariance[0, 0] += max(stairs_m2, ridden_m2)
    path[LEVEL_M] += walked_m
    path[CLIMBED_M] += down_m
    if abs(path[CLIMBED_M]) > level_m:
        path[LEVEL_M] = path[CLIMBED_M] = 0.0


@_compiled(void(_HEIGHT, float64, float64, float64, float64))
def update_barometer(
    height: Record,
    down_m: float,
    wander_m2: float,
    noise_m2: float,
    gate2: float,
) -> None:
    """Update the state of ``HeightFilter`` with a barometric height: H = [1, 0, 1], R = noise_m2.

    The bias of the barometer ``x[2]`` is predicted first, as a random walk of ``wander_m2``.  An
    innovation beyond ``gate2`` (squared standard deviations) is a step of pressure: its square is
    added to the variance of the bias before the update.  ``P`` is updated in Joseph form.
    """
    mean, covariance = height[0].mean, height[0].covariance
    covariance[2, 2] += wander_m2
    innovation_m = down_m - mean[0] - mean[2]
    spread_m2 = covariance[0, 0] + covariance[0, 2] + covariance[2, 0] + covariance[2, 2] + noise_m2
    if innovation_m * innovation_m > gate2 * spread_m2:
        covariance[2, 2] += innovation_m * innovation_m
        spread_m2 += innovation_m * innovation_m
    gain = np.empty(3)
    for i in range(3):
        gain[i] = (covariance[i, 0] + covariance[i, 2]) / spread_m2
        mean[i] += gain[i] * innovation_m
    for column in range(3):  # (1 - K H) P
        seen = covariance[0, column] + covariance[2, column]
        for i in range(3):
            covariance[i, column] -= gain[i] * seen
    for row in range(3):  # the same from the right, and K R K'
        seen = covariance[row, 0] + covariance[row, 2]
        for j in range(3):
            covariance[row, j] += gain[j] * (noise_m2 * gain[row] - seen)


@_compiled(_HORIZONTAL_ESTIMATE(_VECTOR, _MATRIX, float64, float64))
def estimate_before(
    mean: Floats, covariance: Floats, north_m: float, east_m: float
) -> tuple[float, ...]:
    """Fields of ``HorizontalEstimate``, from a state of ``HorizontalFilter``.

    The place is the one before the own path went on by ``(dn, de)`` metres: ``H x`` with variance
    ``H P H'``, where ``H`` has the rows ``[1, 0, -dn, de, 0 ...]`` and ``[0, 1, -de, -dn, 0 ...]``.
    The turn is ``atan2(s, c)``; its variance is that across ``(c, s)`` over the squared scale.
    """
    c, s = mean[2], mean[3]
    north = np.array([1.0, 0.0, -north_m, east_m])
    east = np.array([0.0, 1.0, -east_m, -north_m])
    across = np.array([0.0, 0.0, -s, c])
    std_north_m = math.sqrt(max(_covariance_of(north, covariance, north), 0.0))
    std_east_m = math.sqrt(max(_covariance_of(east, covariance, east), 0.0))
    product = std_north_m * std_east_m
    scale2 = c * c + s * s
    turn_rad, turn_std_rad = 0.0, math.pi
    if scale2 >= _LEAST_SCALE2:
        turn_rad = math.atan2(s, c)
        turn_var = max(_covariance_of(across, covariance, across), 0.0) / (scale2 * scale2)
        turn_std_rad = min(math.sqrt(turn_var), math.pi)
    return (
        mean[0] - c * north_m + s * east_m,
        mean[1] - s * north_m - c * east_m,
        std_north_m,
        std_east_m,
        _covariance_of(north, covariance, east) / product if product > 0.0 else 0.0,
        turn_rad,
        turn_std_rad,
    )
