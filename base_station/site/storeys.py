"""Which storey somebody is on, by height: those of a plan, or those that were learnt."""

from __future__ import annotations

import math
from collections.abc import Sequence

import msgspec

FLOOR_HYSTERESIS_M = 0.4  # past the middle between two storeys before the floor changes
FLOOR_STD_M = 0.5  # of somebody's height on a storey: steps, crawling, how the plan is measured


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
    nearest = min(storeys, key=lambda storey: abs(storey.down_m - down_m))
    held = next((storey for storey in storeys if storey.floor == floor), None)
    if held is None:
        return nearest.floor
    gain_m = abs(held.down_m - down_m) - abs(nearest.down_m - down_m)
    return nearest.floor if gain_m > 2.0 * FLOOR_HYSTERESIS_M else held.floor


def sureness(storeys: Sequence[Storey], floor: int, down_m: float, std_down_m: float) -> float:
    """The probability of a floor, of all the storeys that there are; 0 of one that is not."""
    exponents, wide_m, numbered = {}, {}, {}
    for storey in storeys:
        std_m = math.hypot(std_down_m, FLOOR_STD_M, storey.std_m)
        exponents[storey.floor] = 0.5 * (storey.down_m - down_m) ** 2 / std_m**2
        wide_m[storey.floor], numbered[storey.floor] = std_m, storey.numbered
    if floor not in exponents:
        return 0.0
    least = min(exponents.values())
    weights = {
        number: math.exp(least - exponent) / wide_m[number]
        for number, exponent in exponents.items()
    }
    return numbered[floor] * weights[floor] / sum(weights.values())


def storey_of(storeys: Sequence[Storey], floor: int | None) -> Storey | None:
    """The one with this number, where it is more than to be expected."""
    return next((one for one in storeys if one.floor == floor and one.seen), None)
