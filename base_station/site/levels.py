"""Storeys out of the heights at which people walked about, where no plan lists them.

Heights gather in levels; between two levels there is one storey or several.  The height of a storey
of this building is unknown, too, so every height from ``LEAST_M`` to ``MOST_M`` is tried (Bayes
over a grid), and the most probable numbers of floors between levels over all of them are taken.
The probability of each floor's number comes out of the same sum.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from base_station.site.storeys import Storey

Floats = NDArray[np.float64]

LEAST_M, MOST_M = 2.4, 6.0  # of a storey
USUAL_M, LOWER_STD_M, HIGHER_STD_M = 3.1, 0.3, 0.45  # dwellings and offices
HALL_M, HALL_STD_M, HALLS = 1.3, 0.8, 0.25  # higher ground floors: by how much, how many
UNEVEN_M = 0.35  # by which one storey of a building differs from the others
SAME_M = 1.6  # heights nearer than this are one level
GROUND_M = 1.4  # a level so near to the ground outside is the ground floor
LEVEL_STD_M = 0.2  # how level a storey is
EXPECTED_ABOVE, EXPECTED_BELOW = 8, 3  # storeys beyond the last one with landings
SKIPPED = 0.4  # probability that a storey between two others is not walked on
REPORTED_SURE = 0.97  # probability that a floor number reported by a person is right

_STOREY_M = np.arange(LEAST_M, MOST_M + 0.01, 0.1)
_USUAL_STD_M = np.where(_STOREY_M < USUAL_M, LOWER_STD_M, HIGHER_STD_M)
_USUAL = np.exp(-0.5 * ((_STOREY_M - USUAL_M) / _USUAL_STD_M) ** 2)
_MOST_BETWEEN = 12
_BIN_M = 0.25


@dataclass(frozen=True, slots=True)
class Height:
    """Height of a walk on the level."""

    down_m: float
    std_m: float


@dataclass(frozen=True, slots=True)
class Level:
    down_m: float
    std_m: float
    weight: float


def levels_of(heights: Sequence[Height]) -> list[Level]:
    """The levels at which heights gather, lowest first."""
    bins: dict[int, list[Height]] = {}
    for height in heights:
        bins.setdefault(round(height.down_m / _BIN_M), []).append(height)
    groups = [bins[key] for key in sorted(bins, reverse=True)]
    middles = [_mean(group) for group in groups]
    while len(groups) > 1:
        gaps = [below[0] - above[0] for below, above in pairwise(middles)]
        nearest = min(range(len(gaps)), key=gaps.__getitem__)
        if gaps[nearest] >= SAME_M:
            break
        (one_m, weight), (other_m, more) = middles[nearest], middles.pop(nearest + 1)
        together = weight + more
        middles[nearest] = ((one_m * weight + other_m * more) / together, together)
        groups[nearest] = groups[nearest] + groups.pop(nearest + 1)
    return _apart([_level(group) for group in groups])


def number_levels(
    levels: Sequence[Level], ground: Height, reported: Sequence[tuple[float, int]] = ()
) -> tuple[Storey, ...]:
    """Storeys of a building, lowest first: those walked on, those between and some beyond.
    ``reported``: heights (down) and floors that people reported.
    """
    known, at = _with_ground(levels, ground)
    numbers = {at: (0, 1.0)}
    for down_m, floor in reported:
        row = min(range(len(known)), key=lambda one: abs(known[one].down_m - down_m))
        if abs(known[row].down_m - down_m) < SAME_M and _fits(numbers, row, floor):
            numbers[row] = (floor, REPORTED_SURE)
    storey_odds, between = _between(known, numbers)
    storey_m = float(storey_odds @ _STOREY_M)
    std_m = math.sqrt(float(storey_odds @ (_STOREY_M - storey_m) ** 2))
    return _filled(known, _count(len(known), numbers, between), storey_m, std_m)


def _fits(numbers: Mapping[int, tuple[int, float]], row: int, floor: int) -> bool:
    """True where a number can be that of a level, beside the known ones."""
    return row not in numbers and all(
        (floor - number) * (1 if row > other else -1) >= abs(row - other)
        for other, (number, _) in numbers.items()
    )


def _mean(group: Sequence[Height]) -> tuple[float, float]:
    """Weighted mean of heights, and its weight."""
    weights = [1.0 / (one.std_m**2 + LEVEL_STD_M**2) for one in group]
    total = sum(weights)
    return sum(w * one.down_m for w, one in zip(weights, group, strict=True)) / total, total


def _middle_m(group: Sequence[Height]) -> float:
    """The weighted median: one who is wrong by a flight moves it little."""
    order = sorted(group, key=lambda one: one.down_m)
    weights = np.cumsum([1.0 / (one.std_m**2 + LEVEL_STD_M**2) for one in order])
    return order[int(np.searchsorted(weights, 0.5 * weights[-1]))].down_m


def _level(group: Sequence[Height]) -> Level:
    """Level of a group, no better known than by its best height: repeated visits have the same
    error.
    """
    best_m = min(one.std_m for one in group)
    weight = sum(1.0 / (one.std_m**2 + LEVEL_STD_M**2) for one in group)
    return Level(_middle_m(group), math.hypot(best_m, LEVEL_STD_M), weight)


def _apart(levels: list[Level]) -> list[Level]:
    """Levels nearer than any two storeys are: the one with less behind it is none."""
    kept = list(levels)
    while True:
        near = [
            row
            for row, (below, above) in enumerate(pairwise(kept))
            if below.down_m - above.down_m < LEAST_M
        ]
        if not near:
            return kept
        row = near[0]
        del kept[row if kept[row].weight < kept[row + 1].weight else row + 1]


def _with_ground(levels: Sequence[Level], ground: Height) -> tuple[list[Level], int]:
    """Levels with that of the ground, and its row; the ground exists in any case."""
    std_m = math.hypot(ground.std_m, LEVEL_STD_M)
    nearest = min(levels, key=lambda one: abs(one.down_m - ground.down_m), default=None)
    if nearest is not None and abs(nearest.down_m - ground.down_m) < GROUND_M:
        there = replace(nearest, std_m=min(nearest.std_m, std_m))
        others = [one for one in levels if one is not nearest]
    else:
        there = Level(ground.down_m, std_m, 0.0)
        others = [one for one in levels if abs(one.down_m - ground.down_m) >= LEAST_M]
    known = sorted([there, *others], key=lambda one: -one.down_m)
    return known, known.index(there)


def _between(
    levels: Sequence[Level], numbers: Mapping[int, tuple[int, float]]
) -> tuple[Floats, list[Floats]]:
    """The odds of each height of a storey; for each gap between levels, the odds of 0, 1, 2 ...
    storeys in it.
    """
    odds = _USUAL.copy()
    fits = _gap_fits(levels, numbers)
    for fit in fits:
        odds *= fit.sum(axis=1)
        odds /= odds.sum()
    odds /= odds.sum()
    parts = [odds @ (fit / fit.sum(axis=1, keepdims=True)) for fit in fits]
    return odds, [np.concatenate(([0.0], part)) for part in parts]


def _gap_fits(levels: Sequence[Level], numbers: Mapping[int, tuple[int, float]]) -> list[Floats]:
    """Fit of each storey height (rows) and each number of storeys, from 1, for each gap."""
    counts = np.arange(1, _MOST_BETWEEN + 1)
    common_m2 = min(level.std_m**2 for level in levels)  # everybody's, from the ground
    fits: list[Floats] = []
    for row, (below, above) in enumerate(pairwise(levels)):
        both_m2 = below.std_m**2 + above.std_m**2 - 2.0 * common_m2 + LEVEL_STD_M**2
        var_m2 = np.asarray(both_m2 + counts * UNEVEN_M**2, dtype=np.float64)
        off_m = below.down_m - above.down_m - np.outer(_STOREY_M, counts)
        fit = _normal(off_m, var_m2)
        if numbers.get(row) == (0, 1.0):
            hall = _normal(off_m - HALL_M, var_m2 + HALL_STD_M**2)
            fit = (1.0 - HALLS) * fit + HALLS * hall
        fit *= (1.0 - SKIPPED) * SKIPPED ** (counts - 1)
        if row in numbers and row + 1 in numbers:
            fit[:, counts != numbers[row + 1][0] - numbers[row][0]] = 0.0
        fits.append(fit + 1e-12)
    return fits


def _normal(off_m: Floats, var_m2: Floats) -> Floats:
    return np.asarray(
        np.exp(-0.5 * off_m**2 / var_m2) / np.sqrt(math.tau * var_m2), dtype=np.float64
    )


def _count(
    levels: int, numbers: Mapping[int, tuple[int, float]], between: Sequence[Floats]
) -> list[tuple[int, float]]:
    """Each level's number and how sure that is, counted from those whose number is known."""
    floors: list[tuple[int, float]] = []
    anchors = sorted(numbers)
    for row in range(levels):
        below = max((one for one in anchors if one <= row), default=None)
        above = min((one for one in anchors if one >= row), default=None)
        if below is not None and below == above:
            floors.append(numbers[row])
            continue
        odds = np.zeros(0)
        base, sign, sure = 0, 1, 1.0
        if below is not None:
            base, sure = numbers[below]
            odds = _sum_of(between[below:row])
        if above is not None:
            down, sure = _sum_of(between[row:above]), min(sure, numbers[above][1])
            if below is None:
                base, sign, odds = numbers[above][0], -1, down
            else:
                left = numbers[above][0] - base - np.arange(len(odds))
                inside = (left >= 0) & (left < len(down))
                odds = np.where(inside, odds * down[np.clip(left, 0, len(down) - 1)], 0.0)
        best = int(odds.argmax())
        floors.append((base + sign * best, sure * float(odds[best] / odds.sum())))
    return _rising(floors)


def _sum_of(parts: Sequence[Floats]) -> Floats:
    """The odds of a sum of storeys."""
    odds = np.ones(1)
    for part in parts:
        odds = np.convolve(odds, part)
    return odds


def _rising(floors: list[tuple[int, float]]) -> list[tuple[int, float]]:
    """Each is most probable by itself; together they have to rise."""
    for row in range(1, len(floors)):
        if floors[row][0] <= floors[row - 1][0]:
            floors[row] = (floors[row - 1][0] + 1, 1.0 - REPORTED_SURE)
    return floors


def _filled(
    levels: Sequence[Level], floors: Sequence[tuple[int, float]], storey_m: float, std_m: float
) -> tuple[Storey, ...]:
    """Levels with the storeys on which no one has walked yet."""
    first, last = levels[0], levels[-1]
    storeys = [
        _expected(first, floors[0], -count, storey_m, std_m)
        for count in range(EXPECTED_BELOW, 0, -1)
    ]
    for row, level in enumerate(levels):
        storeys.append(Storey(floors[row][0], level.down_m, level.std_m, floors[row][1]))
        if row + 1 < len(levels):
            count = floors[row + 1][0] - floors[row][0]
            each_m = (level.down_m - levels[row + 1].down_m) / count
            sure = min(floors[row][1], floors[row + 1][1])
            spread_m = math.hypot(level.std_m, UNEVEN_M)
            storeys += [
                Storey(floors[row][0] + k, level.down_m - k * each_m, spread_m, sure, seen=False)
                for k in range(1, count)
            ]
    storeys += [
        _expected(last, floors[-1], count, storey_m, std_m)
        for count in range(1, EXPECTED_ABOVE + 1)
    ]
    return tuple(storeys)


def _expected(
    level: Level, floor: tuple[int, float], count: int, storey_m: float, std_m: float
) -> Storey:
    """So many storeys above this level, negative below."""
    apart = abs(count)
    spread_m = math.hypot(level.std_m, apart * std_m, math.sqrt(apart) * UNEVEN_M)
    return Storey(floor[0] + count, level.down_m - count * storey_m, spread_m, floor[1], seen=False)
