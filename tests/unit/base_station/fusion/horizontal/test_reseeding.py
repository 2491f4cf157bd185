"""A cloud that walls have confirmed in the wrong rooms is compared with particles from
elsewhere.
"""

from __future__ import annotations

import math

import msgspec
import numpy as np
import pytest
from numpy.typing import NDArray

from base_station.fusion.horizontal.compass_aided import CompassAidedFilter
from base_station.fusion.horizontal.map_aided import MapAidedFilter
from base_station.fusion.horizontal.map_particle_filter import (
    SPLIT_STD_M,
    MapParticleFilter,
    SavedMapParticles,
)
from base_station.fusion.horizontal.motion_window import (
    COSTS,
    KEPT_M,
    REPEATED_WALL,
    MotionStep,
    MotionWindow,
)
from base_station.fusion.horizontal.sampling import draw
from base_station.fusion.kernels import STATES, HorizontalEstimate
from base_station.fusion.parameters import Parameters
from base_station.fusion.position_quality import quality_of
from base_station.site.floor_grid import FloorGrid
from base_station.site.wall_crossing import BESIDE, WALL
from shared.quality import Quality
from tests.rig.walled_plan import walled_grid

Floats = NDArray[np.float64]

WIDTH_M, DEPTH_M = 24.0, 12.0
CORRIDOR_M = 5.0, 7.0  # north of its walls
DOOR_M = 3.0, 15.0  # east of their middles, in the corridor's northern wall
BEGIN_M = 6.0, 9.0
NOISE = 0.03**2, 0.004**2
STEP_M = 0.5
KNOWN_STD_M = 2.0
# East along the corridor, through the second door, about in the room behind it, and out again.
WALK = [(0.0, 1.0)] * 12 + [(1.0, 0.0)] * 7 + [(0.0, 1.0)] * 12 + [(0.0, -1.0)] * 24
WALK += [(0.0, 1.0)] * 12 + [(-1.0, 0.0)] * 7 + [(0.0, 1.0)] * 8


def building(*doors_m: float, aside_m: float = 0.0) -> FloorGrid:
    """A corridor from west to east, and rooms to the north of it; ``aside_m``: drawn so much too
    far east.
    """
    (south_m, north_m), ends_m = CORRIDOR_M, [0.0]
    for door_m in doors_m:
        ends_m += [door_m - 0.5, door_m + 0.5]
    ends_m.append(WIDTH_M)
    ring = [[0.0, south_m], [WIDTH_M, south_m], [WIDTH_M, DEPTH_M], [0.0, DEPTH_M]]
    ring.append(ring[0])
    walls = [ring]
    walls += [[[a, north_m], [b, north_m]] for a, b in zip(ends_m[::2], ends_m[1::2], strict=True)]
    walls += [[[east_m, north_m], [east_m, DEPTH_M]] for east_m in (8.5, 21.5)]
    moved = [[[east_m + aside_m, up_m] for east_m, up_m in line] for line in (ring, *walls)]
    return walled_grid(moved[0], moved[1:])


def known(place_m: Floats, std_m: float) -> tuple[Floats, Floats]:
    """Moments of a filter that uses the path alone."""
    mean, covariance = np.zeros(STATES), np.diag([*[1e-4] * 4, *[1.0] * 4, 1e-10])
    mean[:3] = *place_m, 1.0
    covariance[[0, 1], [0, 1]] = std_m**2
    return mean, covariance


def walked(
    grid: FloorGrid, off_east_m: float, *, looks: bool = True
) -> tuple[MapParticleFilter, Floats]:
    """The walk from an assumed begin this far off, and its true path."""
    place_m = np.array(BEGIN_M)
    taken_m = place_m + np.array((0.0, off_east_m))
    cloud = MapParticleFilter(*known(taken_m, 0.4), 1)
    for direction in WALK:
        step_m = STEP_M * np.array(direction)
        place_m, taken_m = place_m + step_m, taken_m + step_m
        cloud.predict((*step_m.tolist(), 0.5, 0.0), NOISE, grid, 0)
        if looks and cloud.is_doubtful:
            cloud.try_relocalise(known(taken_m, KNOWN_STD_M), grid)
    return cloud, place_m


def off_m(cloud: MapParticleFilter, place_m: Floats) -> float:
    return math.dist(cloud.moments()[0][:2], place_m)


def std_m(cloud: MapParticleFilter) -> float:
    _, covariance = cloud.moments()
    return math.sqrt(covariance[0, 0] + covariance[1, 1])


@pytest.mark.parametrize("off_east_m", [-4.0, 4.0])
def test_cloud_held_beside_the_door_comes_to_the_right_room(off_east_m: float) -> None:
    held, place_m = walked(building(*DOOR_M), off_east_m, looks=False)
    assert off_m(held, place_m) > 2.0 * std_m(held)
    found, place_m = walked(building(*DOOR_M), off_east_m)
    assert off_m(found, place_m) < 1.5


def test_unit_misled_by_a_shifted_plan_recovers_with_the_right_one() -> None:
    """The walls of the shifted plan all fitted; by the right one the path crosses some."""
    cloud, place_m = walked(building(*DOOR_M, aside_m=4.0), 4.0)
    right = building(*DOOR_M)
    assert off_m(cloud, place_m) > 3.0
    cloud.set_map(right)
    place_m = place_m + np.array((0.0, STEP_M))
    cloud.predict((0.0, STEP_M, 0.5, 0.0), NOISE, right, 0)
    assert cloud.is_doubtful
    cloud.try_relocalise(known(place_m, KNOWN_STD_M), right)
    assert off_m(cloud, place_m) < 1.8  # by chance 1.4 to 1.6


def test_same_plan_again_keeps_the_likelihood_of_walls() -> None:
    grid = building(*DOOR_M)
    cloud, _ = walked(grid, 0.0)
    before, place_m = cloud.save(), cloud.moments()[0][:2].copy()
    cloud.set_map(grid)
    after = cloud.save()
    assert sum(move.log_likelihood for move in after.window) == pytest.approx(
        sum(move.log_likelihood for move in before.window), abs=1.5
    )
    assert off_m(cloud, place_m) == 0.0
    assert after.particles == before.particles


def test_likelihood_of_a_window_without_any_is_spread_evenly() -> None:
    last = MotionWindow([MotionStep(0.5, 0.0, 0.5, False, 0, 0.0)] * 4)
    last.set_log_likelihood(-8.0)
    assert [move.log_likelihood for move in last.save()] == [-2.0] * 4
    empty = MotionWindow([])
    empty.set_log_likelihood(-8.0)
    assert empty.save() == []


def test_restored_filter_compares_its_cloud_with_a_changed_plan() -> None:
    cloud, _ = walked(building(*DOOR_M, aside_m=4.0), 4.0)
    kind = Parameters()
    walled = MapAidedFilter(
        CompassAidedFilter(kind.scale_std, kind.linear_rad, kind.drift_wander_radps)
    )
    walled.load(msgspec.structs.replace(walled.save(), cloud=cloud.save()))
    walled.set_map(building(*DOOR_M, aside_m=4.0))
    assert walled.save().cloud == cloud.save()
    walled.set_map(building(*DOOR_M))
    again = walled.save().cloud
    assert again is not None
    assert sum(move.log_likelihood for move in again.window) < -10.0


def test_cloud_of_two_places_is_split_with_both() -> None:
    """Two rooms alike; the estimate without walls lies between them."""
    grid, place_m = building(3.5, 12.5), np.array((6.0, 8.0))
    cloud, taken_m, opened = MapParticleFilter(*known(place_m, 0.15), 1), place_m, False
    for direction in [(1.0, 0.0)] * 7 + [(-1.0, 0.0)] * 7 + [(1.0, 0.0)] * 7:
        step_m = STEP_M * np.array(direction)
        taken_m = taken_m + step_m
        cloud.predict((*step_m.tolist(), 0.5, 0.0), NOISE, grid, 0)
        if cloud.is_doubtful:
            cloud.try_relocalise(known(taken_m, KNOWN_STD_M), grid)
            opened = True
    assert opened
    assert cloud.is_split
    assert std_m(cloud) > SPLIT_STD_M


def test_two_places_reduce_the_trust_in_one() -> None:
    placed = HorizontalEstimate(0.0, 0.0, 0.5, 0.5, 0.0, 0.0, 0.01)
    sure = quality_of(Parameters(), placed, None, assumed=False, split=False)
    split = quality_of(Parameters(), placed, None, assumed=False, split=True)
    assert sure == (Quality.GOOD, "")
    assert split == (Quality.DEGRADED, "walls leave more than one place open")


@pytest.mark.parametrize("drawn_m", [DOOR_M, DOOR_M[:1]], ids=["plan right", "a door not drawn"])
def test_cloud_in_the_right_place_is_left_alone(drawn_m: tuple[float, ...]) -> None:
    grid = building(*drawn_m)
    plain, _ = walked(grid, 0.0, looks=False)
    looking, place_m = walked(grid, 0.0)
    assert looking.save() == plain.save()
    assert off_m(looking, place_m) < 2.0


def test_way_back_crosses_the_same_walls_as_the_way_there() -> None:
    grid, rng = building(*DOOR_M), np.random.default_rng(3)
    begin = draw(*known(np.array(BEGIN_M), 1.0), rng, np.ones(50)).particles
    particles, last, logs = begin.copy(), MotionWindow([]), np.zeros(50)
    costs = np.array(COSTS)
    costs[BESIDE] = -0.3  # of these steps
    for direction in WALK[:50]:
        step_m = STEP_M * np.array(direction)
        particles[:, 2] += particles[:, 3] * 0.5
        scale, turn_rad = particles[:, 4], particles[:, 2]
        cosine, sine = scale * np.cos(turn_rad), scale * np.sin(turn_rad)
        from_m = particles[:, :2].copy()
        particles[:, 0] += cosine * step_m[0] - sine * step_m[1]
        particles[:, 1] += sine * step_m[0] + cosine * step_m[1]
        logs += costs[grid.crossings(0, from_m, particles[:, :2])]
        north_m, east_m = step_m.tolist()
        last.append(MotionStep(north_m, east_m, 0.5, False, 0, 0.0, costs[BESIDE]))
    back = last.wall_log_likelihood(particles, grid, -math.inf) + last.repeated_wall_log_ratio(
        particles, grid
    )
    assert np.mean(np.abs(back - logs) < 1e-6) > 0.9  # except squares that a rounding misses
    assert (logs < COSTS[WALL]).any()
    assert ((logs > COSTS[WALL]) & (logs < 0.0)).any()


def test_door_that_is_not_drawn_is_one_wall_in_and_out() -> None:
    in_and_out = [(1.0, 0.0)] * 6 + [(-1.0, 0.0)] * 6
    last = MotionWindow(
        [MotionStep(STEP_M * n, STEP_M * e, 0.5, False, 0, 0.0) for n, e in in_and_out]
    )
    particles, grid = np.array([[6.2, 15.0, 0.0, 0.0, 1.0]]), building()
    once = last.wall_log_likelihood(particles, grid, -math.inf)[0]
    twice = last.repeated_wall_log_ratio(particles, grid)[0]
    assert twice == pytest.approx(COSTS[WALL] - REPEATED_WALL)
    assert COSTS[WALL] > once > 2.0 * COSTS[WALL]


def test_fitting_path_in_little_room_is_stronger_evidence() -> None:
    last = MotionWindow([MotionStep(0.0, STEP_M, 0.5, False, 0, 0.0)] * 20)
    narrow, wide = [6.0, 12.0, 0.0, 0.0, 1.0], [9.5, 20.0, 0.0, 0.0, 1.0]
    in_corridor, in_room = last.log_free_fraction(np.array([narrow, wide]), building())
    assert in_corridor < in_room - 1.0 < 0.0


def test_only_the_recent_window_is_kept() -> None:
    last = MotionWindow([])
    for _ in range(400):
        last.append(MotionStep(0.5, 0.0, 0.5, False, 0, -0.1))
    assert sum(move.north_m for move in last.save()) <= KEPT_M
    assert last.log_likelihood == pytest.approx(-0.1 * len(last.save()))
    assert MotionWindow(last.save()).save() == last.save()


def test_unknown_floor_has_no_walls() -> None:
    last = MotionWindow(
        [MotionStep(0.0, 6.0, 6.0, False, None, 0.0), MotionStep(6.0, 0.0, 6.0, False, 7, 0.0)]
    )
    particles = np.array([[6.0, 9.0, 0.0, 0.0, 1.0]])
    assert last.wall_log_likelihood(particles, building(), -math.inf) == pytest.approx([0.0])


def test_filter_saved_with_both_open_continues_with_identical_numbers() -> None:
    grid = building(*DOOR_M)
    cloud, place_m = walked(grid, 4.0)
    saved = msgspec.msgpack.encode(cloud.save())
    again = MapParticleFilter.restore(msgspec.msgpack.decode(saved, type=SavedMapParticles))
    for one in (cloud, again):
        for _ in range(8):
            one.predict((0.0, STEP_M, 0.5, 0.0), NOISE, grid, 0)
        one.try_relocalise(known(place_m, KNOWN_STD_M), grid)
    assert again.save() == cloud.save()
