"""Model of a building without a plan, learnt from paths: its stairs and the directions of its
walls.
"""

from __future__ import annotations

import math

import msgspec
import numpy as np
import pytest

from base_station.fusion.building_model.building import MOST_STAIRS, KnownStairs, LearntBuilding
from base_station.fusion.building_model.dominant_direction import DominantDirectionFilter
from base_station.fusion.building_model.stairs import Climb, ClimbDetector, LearntStairs
from base_station.fusion.building_model.straight_segments import (
    Axis,
    Drift,
    SegmentDetector,
    StraightSegment,
    wrap_quarter,
)
from base_station.fusion.gaussian import conservative_fusion, jeffrey_update

STAIRS = LearntStairs(10.0, 5.0, (1.0, 0.0, 1.0), 0.0, -3.0, turns=True, shared_m2=0.5)

FOUND = KnownStairs((("FF-01", STAIRS),))


def test_climb_is_reported_at_its_end_with_its_middle() -> None:
    watch, climbs = ClimbDetector(), []
    for row in range(60):  # on the level, up 3 m of stairs northwards, on the level again
        climbing = 20 <= row < 40
        down_m = -0.15 * min(max(row - 19, 0), 20)
        climbs.append(watch.update(0.25 if climbing else 0.5, 0.0, down_m))
    over = [(row, climb) for row, climb in enumerate(climbs) if climb is not None]
    assert len(over) == 1
    row, climb = over[0]
    assert row > 40
    here_m = 0.5 * 20 + 0.25 * 20 + 0.5 * (row - 39)
    assert here_m - climb.since_north_m == pytest.approx(12.5, abs=0.6)
    assert (climb.low_m, climb.high_m) == pytest.approx((0.0, -3.0), abs=0.2)
    assert not climb.turns


def test_kerb_is_no_climb() -> None:
    watch = ClimbDetector()
    assert not any(watch.update(0.5, 0.0, -0.2 * (row > 20)) for row in range(60))


def test_stairs_nearby_are_the_same_and_distant_ones_are_others() -> None:
    learnt = LearntBuilding((FOUND,))
    near = msgspec.structs.replace(STAIRS, north_m=11.5, covariance_m2=(4.0, 0.0, 4.0))
    far = msgspec.structs.replace(STAIRS, north_m=35.0, covariance_m2=(4.0, 0.0, 4.0))
    between = msgspec.structs.replace(STAIRS, north_m=18.0, covariance_m2=(9.0, 0.0, 9.0))
    lost = msgspec.structs.replace(STAIRS, covariance_m2=(49.0, 0.0, 49.0))
    assert learnt.match(near) == 0
    assert learnt.match(far) == -1
    assert learnt.match(between) is None
    assert learnt.match(lost) is None


def test_straight_stairs_lie_above_each_other_only_by_chance() -> None:
    straight = msgspec.structs.replace(STAIRS, turns=False)
    next_storey = msgspec.structs.replace(straight, low_m=-3.0, high_m=-6.0)
    assert LearntBuilding((KnownStairs((("FF-01", straight),)),)).match(next_storey) == -1
    above = msgspec.structs.replace(STAIRS, low_m=-3.0, high_m=-6.0)
    assert LearntBuilding((FOUND,)).match(above) == 0


def test_first_observation_of_stairs_by_each_unit_counts_once() -> None:
    learnt = LearntBuilding((FOUND,))
    again = msgspec.structs.replace(STAIRS, north_m=14.0)
    assert learnt.with_stairs(0, "FF-01", again) is learnt
    two = learnt.with_stairs(0, "FF-02", msgspec.structs.replace(STAIRS, north_m=12.0))
    assert two.stairs[0].mean.north_m == pytest.approx(11.0)
    assert two.stairs[0].mean.variance_m2 == pytest.approx(2.0 * (0.5 + 0.5 / 2.0))
    assert len(two.with_stairs(-1, "FF-02", again).stairs) == 2


def test_common_errors_do_not_average_away() -> None:
    def of_six(shared_m2: float) -> float:
        word = msgspec.structs.replace(STAIRS, shared_m2=shared_m2)
        return KnownStairs(tuple((f"FF-0{n}", word) for n in range(6))).mean.variance_m2 / 2.0

    assert of_six(0.0) == pytest.approx(1.0 / 6.0)
    assert of_six(0.3) == pytest.approx(0.3 + 0.7 / 6.0)
    assert of_six(0.8) == pytest.approx(0.8 + 0.2 / 6.0)


def test_axis_is_the_direction_of_most_segments() -> None:
    learnt = LearntBuilding()
    assert learnt.axis is None
    for number, stated_rad in enumerate((0.1, 0.12, 0.08, 0.6)):
        learnt = learnt.with_axis(
            f"FF-0{number}", Axis(stated_rad + number * math.pi / 2.0, 0.03**2)
        )
    assert learnt.axis is not None
    assert wrap_quarter(learnt.axis.direction_rad) == pytest.approx(0.1, abs=0.01)
    assert learnt.axis.variance == pytest.approx(0.03**2 / 3.0)


def test_repeated_use_makes_no_unit_surer_than_the_first_was() -> None:
    known, spread = np.array([3.0, 0.0]), np.diag([1.0, 4.0])
    place, own = np.array([0.0, 0.0]), np.diag([9.0, 2.0])
    for _ in range(20):
        place, own = conservative_fusion(place, own, known, spread, 0.25 * np.eye(2))
    assert own[0, 0] >= 1.0
    assert own[1, 1] == pytest.approx(2.0)  # it was surer already
    assert place[0] == pytest.approx(3.0, abs=0.3)
    assert place[1] == pytest.approx(0.0)


def test_conditioning_moves_correlated_states() -> None:
    mean, covariance = np.array([0.0, 0.0]), np.array([[4.0, 2.0], [2.0, 4.0]])
    first = np.array([[1.0, 0.0]])
    moved, left = jeffrey_update(mean, covariance, first, np.array([2.0]), np.array([[1.0]]))
    assert moved == pytest.approx([2.0, 1.0])
    assert left[0, 0] == pytest.approx(1.0)
    assert left[1, 1] == pytest.approx(4.0 - 0.5**2 * 3.0)


def test_certain_part_of_a_state_stays_as_it_is() -> None:
    mean, covariance = np.array([1.0, 2.0]), np.zeros((2, 2))
    moved, left = jeffrey_update(mean, covariance, np.eye(2), np.array([9.0, 9.0]), covariance)
    assert moved.tolist() == mean.tolist()
    assert not left.any()


def test_straight_legs_are_cut_at_corners() -> None:
    watch = SegmentDetector()
    ways = [(0.5, 0.0)] * 10 + [(0.0, 0.5)] * 10 + [(-0.5, 0.0)] * 2
    segments = [segment for way in ways if (segment := watch.update(*way)) is not None]
    assert [segment.direction_rad for segment in segments] == pytest.approx([0.0, math.pi / 2.0])
    assert [segment.length_m for segment in segments] == pytest.approx([5.0, 5.0])


@pytest.mark.parametrize("axis_rad", [0.0, 0.6, -0.7])
def test_walls_correct_a_heading_that_drifts(axis_rad: float) -> None:
    """Legs at right angles, of a path whose own heading drifts; one in four fits no wall."""
    rng, axis = np.random.default_rng(3), DominantDirectionFilter()
    turn_rad, variance = 0.0, 0.05**2
    for number in range(60):
        drifted_rad = 0.005 * number
        along = axis_rad + int(rng.integers(4)) * math.pi / 2.0 + float(rng.normal(0.0, 0.03))
        if number % 4 == 3:
            along = rng.uniform(-math.pi, math.pi)
        variance += 0.015**2
        segment = StraightSegment(along - drifted_rad, 5.0)
        turn_rad, variance = axis.update(segment, turn_rad, variance)
    assert turn_rad == pytest.approx(0.295, abs=0.15)
    assert 0.04**2 < variance < 0.12**2


@pytest.mark.parametrize("off_deg", [35.0, 45.0])
def test_legs_that_contradict_the_axis_together_leave_both_open(
    off_deg: float,
) -> None:
    """Something has turned the heading, or these walls stand at another angle."""
    axis, turn_rad, variance = DominantDirectionFilter(), 0.0, 0.03**2
    known, off_rad = Axis(0.0, 0.02**2), math.radians(off_deg)
    for number in range(40):
        direction_rad = number % 2 * math.pi / 2.0 + (0.0 if number < 6 else off_rad)
        segment = StraightSegment(direction_rad, 5.0)
        turn_rad, variance = axis.update(
            segment, turn_rad, variance, None if axis.is_contradicted else known
        )
    assert axis.is_contradicted
    assert turn_rad == pytest.approx(0.0, abs=0.05)
    assert math.sqrt(variance) == pytest.approx(off_rad / 2.0, rel=0.2)
    assert axis.axis is not None, "these walls hold it, too"
    assert wrap_quarter(axis.axis.direction_rad - off_rad) == pytest.approx(0.0, abs=0.05)


# Angle to the walls of a walk that crosses rooms as often as not, leg by leg.
CROSSING_DEG = (0, -12, 2, 3, 11, 18, -1, 16, 4, 0, -14, 17, 16, -21, 0, 0, 41, 24, 23, 0,
                45, 0, 39, 1, -5, -1, 2, 0, 0, -4)  # fmt: skip


def test_diagonal_walk_misleads_the_heading_only_briefly() -> None:
    """Legs that are wrongly taken to be along walls pull the heading; later legs along walls must
    correct it, and the reported doubt is larger meanwhile.
    """
    axis, variance, drift_radps = DominantDirectionFilter(), 0.08**2, -0.0006
    turn_rad = true_rad = 0.0
    sigmas = []
    for number, off_deg in enumerate(CROSSING_DEG):
        true_rad += drift_radps * 10.0
        variance += 0.015**2
        along_rad = math.radians(off_deg) + number % 2 * math.pi / 2.0
        segment = StraightSegment(along_rad - true_rad, 5.0, moved_s=10.0 * number)
        drift = Drift(0.0, 0.0006**2)
        turn_rad, variance = axis.update(segment, turn_rad, variance, Axis(0.0, 0.04**2), drift)
        sigmas.append((turn_rad - true_rad) / math.sqrt(variance))
    assert max(abs(one) for one in sigmas) < 3.0
    assert abs(turn_rad - true_rad) < math.radians(8.0)


def test_uncertain_heading_is_not_turned_to_the_nearest_wall() -> None:
    """Thirty degrees of doubt, and legs nearer to the wrong wall than to the right one."""
    axis = DominantDirectionFilter()
    for number in range(6):
        axis.update(StraightSegment(number % 2 * math.pi / 2.0, 5.0), 0.0, 0.05**2)
    turn_rad, variance = 0.9, 0.6**2
    for number in range(8):
        turn_rad, variance = axis.update(
            StraightSegment(number % 2 * math.pi / 2.0, 5.0), turn_rad, variance
        )
    assert abs(turn_rad) < 2.0 * math.sqrt(variance)


def test_without_right_angles_there_is_no_axis() -> None:
    rng, axis = np.random.default_rng(1), DominantDirectionFilter()
    for _ in range(100):
        axis.update(StraightSegment(rng.uniform(-math.pi, math.pi), 4.0), 0.0, 0.01)
    assert axis.axis is None
    for number in range(20):  # a line there and back gives none either
        axis.update(StraightSegment(0.3 + number % 2 * math.pi, 4.0), 0.0, 0.01)
    assert axis.axis is None


def test_worse_heading_is_improved_by_directions_of_others() -> None:
    axis = DominantDirectionFilter()
    turn_rad, variance = 0.2, 0.2**2
    for number in range(6):
        segment = StraightSegment(number % 2 * math.pi / 2.0 - 0.2, 5.0)
        turn_rad, variance = axis.update(segment, turn_rad, variance)
    assert (turn_rad, math.sqrt(variance)) == pytest.approx((0.2, 0.2), abs=0.02)
    turn_rad, variance = axis.fuse_shared(Axis(0.1, 0.02**2), turn_rad, variance)
    assert turn_rad == pytest.approx(0.3, abs=0.02)
    assert 0.02 < math.sqrt(variance) < 0.06


def test_uncertain_heading_takes_no_walls_a_quarter_turn_off() -> None:
    axis = DominantDirectionFilter()
    turn_rad, variance = 0.9, 0.6**2
    for number in range(8):
        segment = StraightSegment(number % 2 * math.pi / 2.0, 5.0)
        turn_rad, variance = axis.update(segment, turn_rad, variance)
    turn_rad, variance = axis.fuse_shared(Axis(0.0, 0.02**2), turn_rad, variance)
    assert abs(turn_rad) < 2.0 * math.sqrt(variance)


def legs_until_an_axis(known: Axis | None) -> tuple[int, float, float]:
    """Number of legs until an axis of a heading that gets worse and drifts, and the axis."""
    axis, turn_rad, variance = DominantDirectionFilter(), 0.0, 0.05**2
    for number in range(12):
        segment = StraightSegment(0.2 + number % 2 * math.pi / 2.0 - 0.01 * number, 5.0)
        turn_rad, variance = axis.update(segment, 0.0, 0.05**2 + 0.04**2 * number, known)
        if axis.axis is not None:
            return number + 1, turn_rad - 0.01 * number, math.sqrt(variance)
    raise AssertionError("no axis")


def test_axis_is_as_good_as_the_heading_at_its_first_leg() -> None:
    count, off_rad, std_rad = legs_until_an_axis(None)
    assert std_rad < 0.9 * math.sqrt(0.05**2 + 0.04**2 * (count - 1))
    assert abs(off_rad) < std_rad


def test_axis_known_by_others_shows_earlier_and_another_does_not() -> None:
    by_itself, _, _ = legs_until_an_axis(None)
    reported, _, _ = legs_until_an_axis(Axis(0.2, 0.03**2))
    other, _, _ = legs_until_an_axis(Axis(0.2 + math.pi / 4.0, 0.03**2))
    assert reported < by_itself == other


def test_erased_unit_leaves_nothing_in_the_building_model() -> None:
    learnt = (
        LearntBuilding((FOUND,)).with_stairs(0, "FF-02", STAIRS).with_axis("FF-01", Axis(0.1, 1.0))
    )
    assert learnt.without("FF-01") == LearntBuilding((KnownStairs((("FF-02", STAIRS),)),))
    assert learnt.without("FF-01").without("FF-02") == LearntBuilding()
    other = LearntBuilding().with_axis("FF-02", Axis(0.3, 1.0))
    assert other.with_axis("FF-01", Axis(0.1, 1.0)).without("FF-01") == other


def test_model_is_saved_and_restored_to_the_last_bit() -> None:
    learnt = LearntBuilding((FOUND,)).with_axis("FF-01", Axis(0.1, 1e-3))
    saved = msgspec.msgpack.encode(learnt)
    assert msgspec.msgpack.decode(saved, type=LearntBuilding) == learnt


def test_endless_slopes_take_bounded_memory() -> None:
    learnt = LearntBuilding()
    for number in range(100):
        far = msgspec.structs.replace(STAIRS, north_m=100.0 * number)
        learnt = learnt.with_stairs(-1, "FF-01", far)
    assert len(learnt.stairs) == MOST_STAIRS


def test_reframed_model_is_the_same_building() -> None:
    learnt = LearntBuilding((FOUND,), (("FF-01", Axis(0.1, 1e-3)),))
    moved = learnt.reframed(math.pi / 2.0, 1.0, 2.0)
    assert (moved.stairs[0].mean.north_m, moved.stairs[0].mean.east_m) == pytest.approx(
        (-4.0, 12.0)
    )
    assert moved.axis is not None
    assert wrap_quarter(moved.axis.direction_rad - 0.1) == pytest.approx(0.0)
    assert moved.axis.variance == pytest.approx(1e-3)
    climb = Climb(0.0, 0.0, 0.0, -3.0, turns=True)
    seen = LearntStairs.at(climb, np.array([-4.0, 12.0]), np.eye(2), 0.3)
    assert moved.match(seen) == 0


def test_reframing_turns_walls_and_uncertainties_of_stairs_with_the_frame() -> None:
    """The direction in which these stairs are known worst turns by a third of a right angle to the
    east.
    """
    stairs = msgspec.structs.replace(STAIRS, covariance_m2=(4.0, 0.0, 1.0))
    learnt = LearntBuilding((KnownStairs((("FF-01", stairs),)),), (("FF-01", Axis(0.1, 1e-3)),))
    moved = learnt.reframed(math.pi / 6.0, 0.0, 0.0)
    assert moved.axis is not None
    assert moved.axis.direction_rad == pytest.approx(0.1 + math.pi / 6.0)
    cross_m2 = 3.0 * math.sin(math.pi / 6.0) * math.cos(math.pi / 6.0)
    assert moved.stairs[0].mean.covariance_m2 == pytest.approx((3.25, cross_m2, 1.75))
