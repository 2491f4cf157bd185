"""A person who leaves an upper floor by a window, onto a ladder or a roof, is not held in the
building for long by a plan that has no floor there, and until then their region holds them.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from base_station.fusion import FUSERS
from base_station.fusion.interface import Start
from base_station.site.floor_grid import FloorGrid
from shared.messages import Header
from shared.path_noise import PathNoise
from tests.rig.incident.scores import CHI2_95_2DOF, normalised2
from tests.rig.message_factory import position
from tests.rig.walled_plan import Line, walled_grid

WIDE_M, LONG_M, STEP_M = 20.0, 30.0, 0.2
PERIOD_NS = 200_000_000
FOOT = PathNoise(0.005, 0.02, 0.003)  # which trackers of a foot do not state
HAND = PathNoise(0.08, 0.28, 0.014)


def upper_floor() -> FloorGrid:
    """A corridor from south to north in the middle, and rooms with doors on both sides of it."""
    ring = [[0.0, 0.0], [WIDE_M, 0.0], [WIDE_M, LONG_M], [0.0, LONG_M], [0.0, 0.0]]
    walls: list[Line] = [ring]
    for north in np.arange(0.0, LONG_M, 5.0).tolist():
        walls += [[[0.0, north], [9.0, north]], [[11.0, north], [WIDE_M, north]]]
        for east in (9.0, 11.0):
            walls += [
                [[east, north], [east, north + 2.0]],
                [[east, north + 3.0], [east, north + 5]],
            ]
    return walled_grid(ring, walls, floor=1)


def places(metres_outside: float) -> list[tuple[float, float]]:
    """North and east along the corridor, through a room and straight out of its window."""
    corridor = [(north, 10.0) for north in np.arange(1.0, 17.5, STEP_M).tolist()]
    east = np.arange(10.0, WIDE_M + metres_outside, STEP_M)
    return corridor + [(17.5, one) for one in east.tolist()]


def along_the_facade(metres_outside: float, away_m: float) -> list[tuple[float, float]]:
    """Through the window, so far from the wall, and along it."""
    north = np.arange(17.5, 17.5 + away_m - metres_outside, -STEP_M)
    return places(away_m) + [(one, WIDE_M + away_m) for one in north.tolist()]


def tracked(way: list[tuple[float, float]], noise: PathNoise, seed: int) -> list[complex]:
    """Own path of a tracker with errors of that size; north is the real part."""
    rng, true = np.random.default_rng(seed), np.array(way) @ np.array([1.0, 1.0j])
    scale_std, place_std = noise.scale_std, noise.place_std_m_per_sqrt_m
    turn_std = noise.turn_std_rad_per_sqrt_m
    assert scale_std is not None
    assert place_std is not None
    assert turn_std is not None
    steps = np.diff(true)
    root_m = np.sqrt(np.abs(steps))
    turn_rad = np.cumsum(turn_std * root_m * rng.normal(size=len(steps)))
    steps = steps * (1.0 + scale_std * rng.normal()) * np.exp(1j * turn_rad)
    north, east = rng.normal(size=(2, len(steps)))
    steps = steps + place_std * root_m * (north + 1j * east)
    return [0j, *np.cumsum(steps).tolist()]


def held_outside(
    way: list[tuple[float, float]], noise: PathNoise | None, seed: int, first_m: float
) -> list[bool]:
    """Return for each place of the first metres outside whether the stated region holds it."""
    fuser, own = FUSERS[0].new(), tracked(way, noise or FOOT, seed)
    fuser.set_map(upper_floor())
    heading_rad = 0.05 * np.random.default_rng(100 + seed).normal()
    fuser.start(Start(*way[0], -3.0, heading_rad, 0.3, 0.05))
    outside = next(row for row, (_, east_m) in enumerate(way) if east_m > WIDE_M)
    held = []
    for row, (north_m, east_m) in enumerate(way[: outside + round(first_m / STEP_M)]):
        header = Header("FF-01", 1, row + 1, row * PERIOD_NS)
        moved = {"north_m": own[row].real, "east_m": own[row].imag, "path_noise": noise}
        fuser.predict(position(header, **moved))
        estimate = fuser.estimate()
        assert estimate is not None
        error_m = np.array([estimate.north_m - north_m, estimate.east_m - east_m])
        held.append(normalised2(estimate, error_m) < CHI2_95_2DOF)
    return held[outside:]


@pytest.mark.parametrize(
    ("noise", "released_m"), [(None, 6.0), (HAND, 14.0)], ids=["on a foot", "in a hand"]
)
def test_person_outside_of_an_upper_floor_is_released_by_the_plan(
    noise: PathNoise | None, released_m: float
) -> None:
    fuser, way = FUSERS[0].new(), places(25.0)
    fuser.set_map(upper_floor())
    fuser.start(Start(*way[0], -3.0, 0.0, 0.3, 0.05))
    for row, (north_m, east_m) in enumerate(way):
        header = Header("FF-01", 1, row + 1, row * PERIOD_NS)
        moved = {"north_m": north_m - way[0][0], "east_m": east_m - way[0][1], "path_noise": noise}
        fuser.predict(position(header, **moved))
        estimate = fuser.estimate()
        assert estimate is not None
        error_m = np.array([estimate.north_m - north_m, estimate.east_m - east_m])
        if east_m > WIDE_M + released_m:
            assert math.hypot(*error_m) < 1.0
            assert normalised2(estimate, error_m) < CHI2_95_2DOF


@pytest.mark.parametrize("way", [places(8.0), along_the_facade(8.0, 3.0)], ids=["out", "facade"])
@pytest.mark.parametrize(
    ("noise", "first_m", "least"),
    [(None, 5.0, 0.92), (HAND, 8.0, 0.8)],
    ids=["on a foot", "in a hand"],
)
def test_region_holds_a_person_outside_until_the_plan_releases_them(
    noise: PathNoise | None, first_m: float, least: float, way: list[tuple[float, float]]
) -> None:
    """It held a fifth of these metres while the cloud alone was stated."""
    held = [flag for seed in range(4) for flag in held_outside(way, noise, seed, first_m)]
    assert np.mean(held) > least
