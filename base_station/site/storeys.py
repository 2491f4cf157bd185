"""Storey of a person by height, among the storeys of a plan or learnt storeys."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache, partial

import msgspec
import numpy as np
from numba import njit
from numba.core.types import float64, int64
from numpy.typing import NDArray

Floats = NDArray[np.float64]

FLOOR_HYSTERESIS_M = 0.4  # past the middle between two storeys before the floor changes
FLOOR_STD_M = 0.5  # of a wearer's height on a storey: steps, crawling, how the plan is measured
_NOTHING = 12.0  # exp(-12): a smaller probability makes no difference

_compiled = partial(njit, cache=True, error_model="numpy")
_TABLE = float64[:, ::1]


class Storey(msgspec.Struct, frozen=True, cache_hash=True):
    """Level of a building; down in the incident frame."""

    floor: int  # 0 is the ground floor
    down_m: float
    std_m: float = 0.0  # how well the height is known; a plan's is
    numbered: float = 1.0  # probability that the number is right
    seen: bool = True  # on the plan, or walked on; not: only to be expected


def floor_at(storeys: tuple[Storey, ...], down_m: float, floor: int | None) -> int | None:
    """Number of the nearest storey; ``floor`` is kept until another is clearly nearer."""
    if not storeys:
        return None
    row = _nearest(_table(storeys), down_m, math.nan if floor is None else floor)
    return floor if row < 0 else storeys[row].floor


def floor_probability(
    storeys: tuple[Storey, ...], floor: int, down_m: float, std_down_m: float
) -> float:
    """Probability of a floor among all storeys; 0 for one that does not exist."""
    sure: float = _floor_probability(_table(storeys), floor, down_m, std_down_m)
    return sure


@lru_cache
def _table(storeys: tuple[Storey, ...]) -> Floats:
    """Rows of number, height, its variance, and probability of the number."""
    rows = [(one.floor, one.down_m, one.std_m * one.std_m, one.numbered) for one in storeys]
    return np.array(rows).reshape(-1, 4)


@_compiled(int64(_TABLE, float64, float64))
def _nearest(storeys: Floats, down_m: float, held: float) -> int:
    """Row of the nearest storey; -1 if the held one stays."""
    nearest, nearest_m, held_m = 0, math.inf, math.inf
    for row in range(len(storeys)):
        apart_m = abs(storeys[row, 1] - down_m)
        if storeys[row, 0] == held:
            held_m = apart_m
        if apart_m < nearest_m:
            nearest, nearest_m = row, apart_m
    return -1 if held_m - nearest_m <= 2.0 * FLOOR_HYSTERESIS_M else nearest


@_compiled(float64(_TABLE, float64, float64, float64))
def _floor_probability(storeys: Floats, floor: float, down_m: float, std_down_m: float) -> float:
    own_var_m2 = std_down_m * std_down_m + FLOOR_STD_M * FLOOR_STD_M
    least, total, found = math.inf, 0.0, 0.0
    for row in range(len(storeys)):
        off_m = storeys[row, 1] - down_m
        var_m2 = own_var_m2 + storeys[row, 2]
        exponent = 0.5 * off_m * off_m / var_m2
        if exponent < least:  # weights are relative to the likeliest
            fading = math.exp(exponent - least)
            total, found, least = total * fading, found * fading, exponent
        if exponent - least < _NOTHING:
            weight = math.exp(least - exponent) / math.sqrt(var_m2)
            total += weight
            if storeys[row, 0] == floor:
                found = storeys[row, 3] * weight
    return found / total


def storey_of(storeys: Sequence[Storey], floor: int | None) -> Storey | None:
    """Storey with this number, if it is on the plan or was walked on."""
    return next((one for one in storeys if one.floor == floor and one.seen), None)
