"""Which storey somebody is on, by height: those of a plan, or those that were learnt."""

from __future__ import annotations

import math
from collections.abc import Sequence

import msgspec

FLOOR_HYSTERESIS_M = 0.4  # past the middle between two storeys before the floor changes
FLOOR_STD_M = 0.5  # of somebody's height on a storey: steps, crawling, how the plan is measured
_NOTHING = 12.0  # exp(-12): what is so improbable makes no difference


class Storey(msgspec.Struct, frozen=True):
    """One level of a building; down in the incident frame."""

    floor: int  # 0 is the ground floor
    down_m: float
    std_m: float = 0.0  # how well the height is known; a plan's is
    numbered: float = 1.0  # probability that the number is right
    seen: bool = True  # on the plan, or somebody walked there; not: only to be expected


def floor_at(storeys: Sequence[Storey], down_m: float, floor: int | None) -> int | None:
    """The nearest storey's number, staying on ``floor`` until another is clearly nearer."""
    if not storeys:
        return None
    nearest, nearest_m, held_m = None, math.inf, math.inf
    for storey in storeys:
        apart_m = abs(storey.down_m - down_m)
        if storey.floor == floor:
            held_m = apart_m
        if apart_m < nearest_m:
            nearest, nearest_m = storey.floor, apart_m
    return floor if held_m - nearest_m <= 2.0 * FLOOR_HYSTERESIS_M else nearest


def sureness(storeys: Sequence[Storey], floor: int, down_m: float, std_down_m: float) -> float:
    """The probability of a floor, of all the storeys that there are; 0 of one that is not."""
    own_var_m2 = std_down_m * std_down_m + FLOOR_STD_M * FLOOR_STD_M
    least, total, found = math.inf, 0.0, 0.0
    for storey in storeys:
        off_m = storey.down_m - down_m
        var_m2 = own_var_m2 + storey.std_m * storey.std_m
        exponent = 0.5 * off_m * off_m / var_m2
        if exponent < least:  # weights are told by how much less likely than the likeliest
            fading = math.exp(exponent - least)
            total, found, least = total * fading, found * fading, exponent
        if exponent - least < _NOTHING:
            weight = math.exp(least - exponent) / math.sqrt(var_m2)
            total += weight
            if storey.floor == floor:
                found = storey.numbered * weight
    return found / total if found else 0.0


def storey_of(storeys: Sequence[Storey], floor: int | None) -> Storey | None:
    """The one with this number, where it is more than to be expected."""
    return next((one for one in storeys if one.floor == floor and one.seen), None)
