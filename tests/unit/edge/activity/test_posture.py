"""Posture of a foot: standing, tipped, lying, crawling, collapsed."""

from __future__ import annotations

import math

import numpy as np
import pytest

from edge.activity.body_motion import WINDOW_NS, BodyMotionWindow
from edge.activity.posture import Posture
from edge.activity.strides import Stride
from edge.samples import Floats

WEIGHT_MPS2 = 9.81
KNEELING_DEG, ON_THE_BACK_DEG = 80.0, -90.0


class Foot:
    """A foot held at an angle to standing, half a second at a time."""

    def __init__(self, stands_s: float = 1.0) -> None:
        self.posture = Posture()
        self.now_ns = 0
        self.still = 0  # windows
        self.held(0.0, stands_s)

    def held(self, angle_deg: float, duration_s: float, rate_radps: float | None = None) -> None:
        """Still, or moving at a rate."""
        for _ in range(round(2.0 * duration_s)):
            self.now_ns += WINDOW_NS
            moving = rate_radps is not None
            self.still = 0 if moving else self.still + 1
            window = BodyMotionWindow(
                self.now_ns, moving, WEIGHT_MPS2 * up(angle_deg), rate_radps or 0.01
            )
            self.posture.take_window(window, self.still / 2.0)

    def steps(self, angle_deg: float, length_m: float = 0.4) -> None:
        stride = Stride(self.now_ns, 1.0, length_m, 0.0, up(angle_deg))
        self.posture.take_stride(stride)


def up(angle_deg: float) -> Floats:
    angle_rad = math.radians(angle_deg)
    return np.array([math.sin(angle_rad), 0.0, math.cos(angle_rad)])


@pytest.fixture
def foot() -> Foot:
    return Foot()


@pytest.mark.parametrize(
    ("angle_deg", "still_s", "lying"),
    [(60.0, 2.0, True), (60.0, 1.5, False), (50.0, 20.0, False), (-60.0, 2.0, True)],
)
def test_foot_at_rest_and_tipped_for_two_seconds_is_lying(
    foot: Foot, angle_deg: float, still_s: float, lying: bool
) -> None:
    foot.held(angle_deg, 3.0, 1.0)
    foot.held(angle_deg, still_s)
    assert foot.posture.lying is lying


def test_turning_over_stays_lying_and_standing_up_ends_it(foot: Foot) -> None:
    foot.held(80.0, 3.0)
    foot.held(80.0, 3.0, 1.5)
    lying = [foot.posture.lying]
    foot.held(10.0, 0.5, 1.5)
    lying.append(foot.posture.lying)
    assert lying == [True, False]


@pytest.mark.parametrize(
    ("rate_radps", "going_down_s", "still_s", "collapsed"),
    [
        (3.0, 1.0, 1.0, True),
        (3.0, 1.0, 0.5, False),  # not at rest yet
        (2.0, 1.0, 4.0, False),  # as in lying down
        (3.0, 2.0, 1.0, True),
        (3.0, 3.0, 4.0, False),  # crouched for a while: it was no collapse
    ],
)
def test_sudden_descent_without_motion_is_a_collapse(
    foot: Foot, rate_radps: float, going_down_s: float, still_s: float, collapsed: bool
) -> None:
    foot.held(70.0, going_down_s, rate_radps)
    foot.held(90.0, still_s)
    assert foot.posture.collapsed is collapsed


def test_one_quick_moment_on_the_way_down_is_a_collapse(foot: Foot) -> None:
    foot.held(30.0, 0.5, 1.0)
    foot.held(70.0, 0.5, 3.0)
    foot.held(90.0, 1.0)
    assert foot.posture.collapsed


def test_descent_from_a_long_crouch_is_no_collapse(
    foot: Foot,
) -> None:
    """The heel is up by thirty degrees, which is not upright."""
    foot.held(30.0, 3.0, 1.0)
    foot.held(70.0, 1.0, 3.0)
    foot.held(90.0, 4.0)
    assert not foot.posture.collapsed


def test_collapse_in_mid_walk_begins_upright_at_the_last_step(foot: Foot) -> None:
    """A walking foot is hardly ever held as when standing."""
    foot.held(25.0, 5.0, 1.0)
    foot.steps(10.0, length_m=1.3)
    foot.held(70.0, 1.0, 3.0)
    foot.held(90.0, 1.0)
    assert foot.posture.collapsed


def test_missing_samples_of_the_rest_undo_no_collapse(foot: Foot) -> None:
    """A blow may cost some seconds of samples."""
    foot.held(70.0, 1.0, 3.0)
    foot.held(90.0, 0.5)
    foot.now_ns += 10 * WINDOW_NS
    collapsed = []
    for _ in range(7):
        foot.held(90.0, 0.5)
        collapsed.append(foot.posture.collapsed)
    assert collapsed == [True] * 7


@pytest.mark.parametrize("by_step", [False, True])
def test_clock_set_back_hides_no_collapse(by_step: bool) -> None:
    foot = Foot()
    foot.now_ns += 2000 * WINDOW_NS
    foot.held(0.0, 1.0)
    foot.steps(0.0, length_m=1.3)
    foot.now_ns = 0
    foot.held(25.0 if by_step else 0.0, 2.0, 1.0)
    if by_step:
        foot.steps(10.0, length_m=1.3)
    foot.held(70.0, 1.0, 3.0)
    foot.held(90.0, 1.0)
    assert foot.posture.collapsed


def test_late_step_changes_no_known_state(foot: Foot) -> None:
    """Rows that the tracker delayed by a second."""
    late = Stride(foot.now_ns, 1.0, 1.3, 0.0, up(10.0))
    foot.held(0.0, 1.0)
    foot.posture.take_stride(late)
    foot.held(70.0, 1.5, 3.0)
    foot.held(90.0, 1.0)
    assert foot.posture.collapsed


def test_strides_are_quick_and_lying_down_after_them_is_no_collapse(foot: Foot) -> None:
    foot.held(0.0, 2.0, 6.0)
    foot.held(70.0, 1.0, 1.0)
    foot.held(90.0, 4.0)
    assert not foot.posture.collapsed
    assert foot.posture.lying


def test_motion_ends_a_collapse(foot: Foot) -> None:
    foot.held(70.0, 1.0, 3.0)
    foot.held(90.0, 2.0)
    collapsed = [foot.posture.collapsed]
    foot.held(90.0, 0.5, 1.0)
    collapsed.append(foot.posture.collapsed)
    assert collapsed == [True, False]


def test_unit_that_was_never_seen_standing_gives_no_posture() -> None:
    posture = Posture()
    for second in range(1, 20):
        window = BodyMotionWindow(second * WINDOW_NS, True, WEIGHT_MPS2 * up(90.0), 9.0)
        posture.take_window(window, 0.0)
    assert not any((posture.lying, posture.collapsed, posture.tipped))


def test_one_tipped_step_is_a_stumble_and_two_alike_are_crawling(foot: Foot) -> None:
    reported = [(foot.posture.tipped_step, foot.posture.crawling)]
    for angle_deg in (KNEELING_DEG, KNEELING_DEG, -KNEELING_DEG, -KNEELING_DEG, 10.0):
        foot.steps(angle_deg)
        reported.append((foot.posture.tipped_step, foot.posture.crawling))
    crawling = [(True, False), (True, True)]
    assert reported == [(False, False), *crawling, *crawling, (False, False)]


def test_two_tipped_steps_fifty_degrees_apart_are_lying_down(foot: Foot) -> None:
    foot.steps(50.0)
    foot.steps(100.0)
    assert not foot.posture.crawling


@pytest.mark.parametrize(("angle_deg", "tipped"), [(35.0, False), (45.0, True)])
def test_shoe_rolls_by_some_forty_degrees(foot: Foot, angle_deg: float, tipped: bool) -> None:
    foot.steps(angle_deg)
    assert foot.posture.tipped_step is tipped


@pytest.mark.parametrize(("length_m", "crawls"), [(0.75, True), (0.85, False)])
def test_long_strides_are_no_crawling(foot: Foot, length_m: float, crawls: bool) -> None:
    foot.steps(KNEELING_DEG)
    foot.steps(KNEELING_DEG)
    foot.steps(KNEELING_DEG, length_m=length_m)
    assert foot.posture.crawling is crawls


@pytest.mark.parametrize(
    ("rests_deg", "still_s", "lying"),
    [
        (KNEELING_DEG, 5.5, False),
        (KNEELING_DEG, 6.0, True),
        (ON_THE_BACK_DEG, 1.5, False),
        (ON_THE_BACK_DEG, 2.0, True),
    ],
)
def test_crawling_may_rest_on_hands_and_knees_and_not_on_the_back(
    foot: Foot, rests_deg: float, still_s: float, lying: bool
) -> None:
    foot.held(KNEELING_DEG, 4.0, 1.0)
    foot.steps(KNEELING_DEG)
    foot.steps(KNEELING_DEG)
    foot.held(rests_deg, still_s)
    assert foot.posture.lying is lying


def test_stumbling_and_lying_down_is_no_crawling(foot: Foot) -> None:
    foot.held(KNEELING_DEG, 2.0, 1.0)
    foot.steps(KNEELING_DEG)
    foot.held(KNEELING_DEG, 2.0)
    assert foot.posture.lying


def test_dropping_to_the_knees_and_crawling_is_no_collapse(foot: Foot) -> None:
    foot.held(KNEELING_DEG, 1.0, 4.0)
    foot.steps(KNEELING_DEG)
    foot.steps(KNEELING_DEG)
    foot.held(KNEELING_DEG, 4.0)
    assert not foot.posture.collapsed


@pytest.mark.parametrize(("length_m", "lying"), [(0.08, True), (0.12, False)])
def test_crawling_after_a_long_rest_is_no_lying(foot: Foot, length_m: float, lying: bool) -> None:
    """Small motions without progress are."""
    foot.held(KNEELING_DEG, 3.0)
    assert foot.posture.lying
    for _ in range(3):
        foot.held(KNEELING_DEG, 1.0, 1.0)
        foot.steps(KNEELING_DEG, length_m)
    assert foot.posture.lying is lying


def test_steps_without_progress_neither_begin_nor_end_a_crawl(foot: Foot) -> None:
    """A lying wearer may move, and a tracker may report steps of it."""
    reported = []
    for length_m in (0.05, 0.05, 0.4, 0.05, 0.4, 0.05):
        foot.steps(KNEELING_DEG, length_m)
        reported.append((foot.posture.tipped_step, foot.posture.crawling))
    assert reported == [(True, False)] * 4 + [(True, True)] * 2


def test_sudden_descent_with_small_motions_is_a_collapse(foot: Foot) -> None:
    foot.held(KNEELING_DEG, 1.0, 3.0)
    foot.steps(KNEELING_DEG, 0.05)
    foot.steps(KNEELING_DEG, 0.05)
    foot.held(KNEELING_DEG, 1.0)
    assert foot.posture.collapsed


def test_one_tipped_step_is_no_getting_up(foot: Foot) -> None:
    foot.held(KNEELING_DEG, 3.0)
    foot.held(KNEELING_DEG, 1.0, 1.0)
    foot.steps(KNEELING_DEG)
    assert foot.posture.lying


@pytest.mark.parametrize("stood_up", [True, False])
def test_collapse_after_standing_up_from_a_crawl_is_found(foot: Foot, stood_up: bool) -> None:
    foot.steps(KNEELING_DEG)
    foot.steps(KNEELING_DEG)
    foot.held(KNEELING_DEG, 1.0, 1.0)
    foot.held(0.0, 1.0, None if stood_up else 1.0)
    foot.held(70.0, 1.0, 3.0)
    foot.held(KNEELING_DEG, 1.0)
    assert foot.posture.collapsed is stood_up


def test_tipped_is_longer_than_a_swing(foot: Foot) -> None:
    tipped = []
    for _ in range(4):
        foot.held(70.0, 0.5, 1.0)
        tipped.append(foot.posture.tipped)
    foot.held(0.0, 0.5, 1.0)
    tipped.append(foot.posture.tipped)
    assert tipped == [False, False, False, True, False]


def test_clock_set_back_is_no_getting_up(foot: Foot) -> None:
    foot.now_ns += 100 * WINDOW_NS
    foot.held(70.0, 3.0, 1.0)
    foot.now_ns = 0
    foot.held(70.0, 0.5, 1.0)
    assert foot.posture.tipped


def test_standing_attitude_is_learnt_from_long_strides() -> None:
    """The unit was strapped on while its wearer sat, thirty degrees aside."""
    foot = Foot()
    foot.held(30.0, 0.5, 1.0)
    for _ in range(30):
        foot.steps(30.0, length_m=1.3)
    foot.held(-40.0, 3.0)
    assert foot.posture.lying, "seventy degrees from how it stands"


def test_standing_attitude_is_learnt_from_strides_before_any_rest() -> None:
    foot = Foot(stands_s=0.0)
    foot.held(25.0, 2.0, 1.0)
    foot.steps(0.0, length_m=1.3)
    foot.held(90.0, 3.0)
    assert foot.posture.lying


def test_long_crawl_does_not_become_standing(foot: Foot) -> None:
    for _ in range(50):
        foot.steps(KNEELING_DEG)
    assert foot.posture.crawling


def test_moving_foot_does_not_show_its_standing_attitude() -> None:
    """For example while the unit is strapped on."""
    foot = Foot(stands_s=0.0)
    foot.held(90.0, 1.0, 2.0)
    foot.held(0.0, 1.0)
    foot.held(90.0, 3.0)
    assert foot.posture.lying


def test_unit_switched_on_in_its_bag_knows_its_attitude_after_five_strides() -> None:
    foot = Foot(stands_s=0.0)
    foot.held(120.0, 3.0)
    for _ in range(5):
        foot.held(10.0, 0.5, 2.0)
        foot.steps(0.0, length_m=1.3)
    foot.held(0.0, 3.0)
    assert not foot.posture.lying


def test_zeros_of_a_starting_sensor_show_no_attitude() -> None:
    foot = Foot(stands_s=0.0)
    foot.posture.take_window(BodyMotionWindow(WINDOW_NS, False, np.zeros(3), 0.0), 0.5)
    foot.held(0.0, 1.0)
    foot.held(90.0, 3.0)
    assert foot.posture.lying


@pytest.mark.parametrize("held_deg", [0.0, 38.0])
def test_one_odd_footfall_does_not_make_standing_lying(foot: Foot, held_deg: float) -> None:
    foot.steps(-70.0, length_m=1.3)
    foot.held(held_deg, 5.0)
    assert not foot.posture.lying
