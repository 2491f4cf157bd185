"""Activity of the wearer from strides, rests and blows: where one kind ends and the next begins."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from edge.activity.monitor import ActivityMonitor
from edge.samples import ImuBatch
from edge.tracker.interface import TrackBatch
from edge.tracker.track_rows import empty_rows
from shared.clock import NS_PER_S
from shared.messages import Activity

RATE_HZ = 100
SWING_SHARE = 0.6  # of a stride
TIPPED_DEG = 80.0


def pitched(angle_deg: float) -> tuple[float, float, float]:
    """Direction of up in the sensor axes of a foot with its toes this far down; level: along -z."""
    angle_rad = math.radians(angle_deg)
    return -math.sin(angle_rad), 0.0, -math.cos(angle_rad)


class Wearer:
    """One motion after another; the unit gets each at once."""

    def __init__(self, stands_s: float = 3.0) -> None:
        self.monitor = ActivityMonitor()
        self.now_s = 100.0
        self.falls = 0
        self._height_m = 0.0  # by pressure
        if stands_s:
            self.rests(stands_s)

    def output(self) -> Activity:
        return self.monitor.activity(round(self.now_s * NS_PER_S))

    def cadence_hz(self) -> float:
        return self.monitor.cadence_hz(round(self.now_s * NS_PER_S))

    def rests(self, seconds: float, angle_deg: float = 0.0) -> None:
        self._feels(seconds, 9.81, angle_deg, 0.0)

    def stirs(self, seconds: float, angle_deg: float = 0.0, rate_radps: float = 1.0) -> None:
        self._feels(seconds, 9.81, angle_deg, rate_radps)

    def falls_down(self) -> None:
        """Half a metre, and a blow."""
        self._feels(0.35, 0.5, 0.0, 0.0)
        self._feels(0.15, 60.0, 0.0, 1.0)

    def strides(
        self,
        count: int,
        length_m: float,
        *,
        period_s: float = 1.0,
        rise_m: float = 0.0,
        angle_deg: float = 0.0,
        climbed_m: float | None = None,
    ) -> None:
        """``climbed_m``: the climb of each stride by barometer; None: there is none."""
        for _ in range(count):
            began_s, before_m = self.now_s, self._height_m
            self._feels(period_s, 9.81, angle_deg, 1.0, (before_m, climbed_m))
            rows = [
                (began_s + 0.01, 0.0, True),
                (began_s + (1.0 - SWING_SHARE) * period_s, 0.0, True),
                (began_s + (1.0 - SWING_SHARE / 2.0) * period_s, 0.5, False),
                (self.now_s, 1.0, True),
            ]
            track = self._rows(rows, length_m, rise_m, angle_deg)
            self.falls += self.monitor.push(_nothing(), track)
            self._height_m += climbed_m or 0.0

    def is_stated_to_step(self, ago_s: float, angle_deg: float = 0.0) -> None:
        """The tracker missed a stance while the foot rested."""
        lifted_s = self.now_s - ago_s
        rows = [(lifted_s, 0.0, True), (lifted_s + 0.1, 0.0, False), (lifted_s + 0.5, 0.0, True)]
        self.falls += self.monitor.push(_nothing(), self._rows(rows, 0.0, 0.0, angle_deg))

    def _feels(
        self,
        seconds: float,
        force_mps2: float,
        angle_deg: float,
        rate_radps: float,
        air: tuple[float, float | None] = (0.0, None),
    ) -> None:
        count = round(seconds * RATE_HZ)
        t_ns = np.arange(count) * (NS_PER_S // RATE_HZ) + round(self.now_s * NS_PER_S)
        shakes = np.where(np.arange(count) % 2, 1.0, -1.0)[:, None] * rate_radps
        pressure_pa = None
        if air[1] is not None:
            height_m = air[0] + air[1] * np.arange(count) / count
            pressure_pa = 101_325.0 - 12.0 * height_m
        imu = ImuBatch(
            t_ns,
            force_mps2 * np.tile(pitched(angle_deg), (count, 1)),
            np.hstack((np.zeros((count, 1)), shakes, np.zeros((count, 1)))),
            pressure_pa=pressure_pa,
        )
        self.falls += self.monitor.push(imu, empty_rows())
        self.now_s += seconds

    def _rows(
        self,
        reported: list[tuple[float, float, bool]],
        length_m: float,
        rise_m: float,
        angle_deg: float,
    ) -> TrackBatch:
        count = len(reported)
        t_s, share, standing = (np.array(column) for column in zip(*reported, strict=True))
        half_rad = math.radians(angle_deg) / 2.0
        return replace(
            empty_rows(),
            t_ns=np.rint(t_s * NS_PER_S).astype(np.int64),
            position_n_m=np.column_stack((length_m * share, np.zeros(count), -rise_m * share)),
            quaternion_nb=np.tile([math.cos(half_rad), 0.0, -math.sin(half_rad), 0.0], (count, 1)),
            stationary=standing.astype(bool),
            steps=np.zeros(count, np.int64),
        )


def _nothing() -> ImuBatch:
    return ImuBatch(np.empty(0, np.int64), np.empty((0, 3)), np.empty((0, 3)))


@pytest.fixture
def wearer() -> Wearer:
    return Wearer()


@pytest.mark.parametrize(
    ("length_m", "period_s", "kind"),
    [
        (1.9, 1.0, Activity.WALKING),
        (2.1, 1.0, Activity.RUNNING),  # faster than anybody walks
        (1.0, 0.74, Activity.RUNNING),  # on narrow ways, and quick
        (1.0, 0.86, Activity.WALKING),
        (0.8, 0.74, Activity.WALKING),  # hurries with short steps
    ],
)
def test_running_is_fast_or_quick_with_strides_of_some_length(
    wearer: Wearer, length_m: float, period_s: float, kind: Activity
) -> None:
    wearer.strides(4, length_m, period_s=period_s)
    assert wearer.output() is kind


@pytest.mark.parametrize(
    ("rise_m", "length_m", "kind"),
    [
        (0.34, 0.6, Activity.STAIRS_UP),
        (-0.34, 0.6, Activity.STAIRS_DOWN),
        (0.12, 0.4, Activity.STAIRS_UP),
        (0.10, 0.3, Activity.WALKING),  # over a hose
        (0.27, 1.0, Activity.STAIRS_UP),
        (0.23, 1.0, Activity.WALKING),  # a ramp
        (-0.23, 1.0, Activity.WALKING),
    ],
)
def test_stairs_are_steeper_than_ramps_and_higher_than_obstacles(
    wearer: Wearer, rise_m: float, length_m: float, kind: Activity
) -> None:
    wearer.strides(4, length_m, rise_m=rise_m)
    assert wearer.output() is kind


@pytest.mark.parametrize(("climbed_m", "kind"), [(0.14, Activity.STAIRS_UP), (0.06, None)])
def test_pressure_must_show_a_third_of_the_climb_of_the_strides(
    wearer: Wearer, climbed_m: float, kind: Activity | None
) -> None:
    wearer.strides(8, 0.6, rise_m=0.34, climbed_m=climbed_m)
    assert wearer.output() is (kind or Activity.WALKING)


def test_pressure_does_not_judge_less_than_a_metre(wearer: Wearer) -> None:
    wearer.strides(3, 0.6, rise_m=0.34, climbed_m=0.0)
    assert wearer.output() is Activity.STAIRS_UP
    wearer.strides(2, 0.6, rise_m=0.34, climbed_m=0.0)
    assert wearer.output() is Activity.WALKING


def test_turn_on_the_stairs_is_judged_by_the_later_part(wearer: Wearer) -> None:
    wearer.strides(8, 0.6, rise_m=0.34, climbed_m=0.34)
    wearer.strides(4, 0.6, rise_m=-0.34, climbed_m=0.0)
    assert wearer.output() is Activity.WALKING, "the tracker sinks and the air does not"


def test_flight_ends_on_a_landing(wearer: Wearer) -> None:
    wearer.strides(5, 0.6, rise_m=0.34, climbed_m=0.34)
    wearer.strides(3, 1.2, climbed_m=0.0)
    assert wearer.output() is Activity.WALKING
    wearer.strides(4, 0.6, rise_m=0.34, climbed_m=0.0)
    assert wearer.output() is Activity.WALKING, "the flight before is no witness for this one"


@pytest.mark.parametrize(("length_m", "kind"), [(11.0, Activity.RUNNING), (13.0, None)])
def test_lost_tracker_makes_no_runner(
    wearer: Wearer, length_m: float, kind: Activity | None
) -> None:
    wearer.strides(3, 1.3)
    wearer.strides(1, length_m)
    assert wearer.output() is (kind or Activity.WALKING)


def test_one_tipped_step_is_a_stumble_and_two_are_crawling(wearer: Wearer) -> None:
    wearer.strides(3, 2.1)
    wearer.strides(1, 0.4, angle_deg=TIPPED_DEG)
    stated = [wearer.output()]
    wearer.strides(2, 0.4, angle_deg=TIPPED_DEG)
    stated.append(wearer.output())
    assert stated == [Activity.RUNNING, Activity.CRAWLING]


def test_crawling_on_the_balls_of_the_feet_is_crawling(wearer: Wearer) -> None:
    """Fifty degrees are more than a shoe rolls in a stride and less than a foot that lies."""
    wearer.strides(4, 0.4, angle_deg=50.0)
    assert wearer.output() is Activity.CRAWLING


def test_crawling_continues_after_a_rest_and_becomes_lying_after_a_long_one(
    wearer: Wearer,
) -> None:
    wearer.strides(5, 0.4, angle_deg=TIPPED_DEG)
    stated = []
    for rest_s in (3.5, 1.0, 3.0):
        wearer.rests(rest_s, TIPPED_DEG)
        stated.append(wearer.output())
    assert stated == [Activity.CRAWLING, Activity.CRAWLING, Activity.LYING]


def test_raised_resting_foot_is_neither_crawling_nor_lying_at_once(
    wearer: Wearer,
) -> None:
    wearer.stirs(3.0, TIPPED_DEG)
    stated = [wearer.output()]
    wearer.rests(1.5, TIPPED_DEG)
    stated.append(wearer.output())
    wearer.rests(1.5, TIPPED_DEG)
    stated.append(wearer.output())
    assert stated == [Activity.CRAWLING, Activity.STILL, Activity.LYING]


def test_foot_at_rest_for_a_second_has_stopped(wearer: Wearer) -> None:
    wearer.strides(5, 1.3)
    wearer.rests(0.8)
    assert wearer.output() is Activity.WALKING
    assert wearer.cadence_hz() > 0.0
    wearer.rests(0.8)
    assert wearer.output() is Activity.STILL
    assert wearer.cadence_hz() == 0.0


def test_motion_of_a_second_is_walking_before_the_first_stride(wearer: Wearer) -> None:
    wearer.stirs(0.8)
    assert wearer.output() is Activity.STILL
    wearer.stirs(0.8)
    assert wearer.output() is Activity.WALKING
    wearer.rests(1.1)
    assert wearer.output() is Activity.STILL


def test_first_samples_in_mid_walk_are_walking_and_unknown_before() -> None:
    wearer = Wearer(stands_s=0.0)
    assert wearer.output() is Activity.UNKNOWN
    wearer.stirs(1.6)
    assert wearer.output() is Activity.WALKING


def test_activity_is_unknown_after_two_seconds_without_samples(wearer: Wearer) -> None:
    """Nothing is known of the last half second before its end."""
    wearer.now_s += 1.4
    assert wearer.output() is Activity.STILL
    wearer.now_s += 0.2
    assert wearer.output() is Activity.UNKNOWN


def test_cadence_is_that_of_the_last_four_seconds(wearer: Wearer) -> None:
    wearer.strides(10, 1.3)
    assert wearer.cadence_hz() == pytest.approx(2.0)
    wearer.strides(4, 1.0, period_s=0.8)
    assert wearer.cadence_hz() == pytest.approx(2.0 * 5 / (1.0 + 4 * 0.8))
    assert wearer.monitor.steps == 28


def test_blow_after_a_drop_is_one_fall_in_any_final_posture(wearer: Wearer) -> None:
    wearer.falls_down()
    wearer.stirs(0.5, 70.0, 3.0)
    assert wearer.output() is Activity.FALLING
    wearer.rests(20.0, 90.0)
    assert wearer.falls == 1
    assert wearer.output() is Activity.LYING


def test_second_fall_after_getting_up_counts(wearer: Wearer) -> None:
    for _ in range(2):
        wearer.falls_down()
        wearer.rests(5.0, 90.0)
        wearer.strides(3, 1.3)
        wearer.rests(2.0)
    assert wearer.falls == 2


@pytest.mark.parametrize(("still_s", "falls"), [(3.4, 0), (4.6, 1), (30.0, 1)])
def test_sudden_descent_is_a_fall_after_four_seconds_without_motion(
    wearer: Wearer, still_s: float, falls: int
) -> None:
    wearer.stirs(1.0, 70.0, 3.0)
    wearer.rests(still_s, 90.0)
    assert wearer.falls == falls


def test_long_standing_and_lying_down_are_no_fall(wearer: Wearer) -> None:
    wearer.rests(30.0)
    wearer.stirs(2.0, 70.0, 1.0)
    wearer.rests(30.0, 90.0)
    assert wearer.output() is Activity.LYING
    assert wearer.falls == 0


def test_collapsed_wearer_is_falling_until_lying(wearer: Wearer) -> None:
    wearer.stirs(1.0, 85.0, 3.0)
    stated = []
    for _ in range(3):
        wearer.rests(0.8, 90.0)
        stated.append(wearer.output())
    assert stated == [Activity.STILL, Activity.FALLING, Activity.LYING]


def test_jump_from_the_engine_is_no_fall(wearer: Wearer) -> None:
    wearer.falls_down()
    stated = [wearer.output()]
    wearer.strides(3, 1.3)
    stated.append(wearer.output())
    wearer.rests(4.0)
    stated.append(wearer.output())
    assert stated == [Activity.FALLING, Activity.WALKING, Activity.STILL]
    assert wearer.falls == 0


@pytest.mark.parametrize(
    ("length_m", "angle_deg"),
    [(0.7, 0.0), (1.3, TIPPED_DEG), (13.0, 0.0)],
    ids=["stumbles on", "is dragged away", "a tracker that is lost"],
)
def test_only_long_strides_on_the_feet_show_getting_up(
    wearer: Wearer, length_m: float, angle_deg: float
) -> None:
    wearer.falls_down()
    wearer.strides(2, length_m, angle_deg=angle_deg)
    wearer.rests(4.0)
    assert wearer.falls == 1


def test_some_steps_after_a_blow_and_lying_down_is_a_fall(wearer: Wearer) -> None:
    wearer.falls_down()
    wearer.strides(2, 1.3)
    wearer.stirs(1.0, 80.0)
    wearer.rests(3.0, 90.0)
    assert wearer.falls == 1


def test_stride_without_motion_does_not_count(wearer: Wearer) -> None:
    wearer.strides(2, 1.3)
    for _ in range(3):
        wearer.rests(2.5)
        wearer.is_stated_to_step(ago_s=1.5)
    assert wearer.monitor.steps == 4
    wearer.stirs(2.5)
    wearer.is_stated_to_step(ago_s=1.5)
    assert wearer.monitor.steps == 6


def test_stride_reported_before_its_motion_could_be_seen_counts() -> None:
    wearer = Wearer(stands_s=0.0)
    wearer.is_stated_to_step(ago_s=1.0)
    assert wearer.monitor.steps == 2


def test_standing_since_the_start_has_no_strides() -> None:
    wearer = Wearer(stands_s=4.0)
    wearer.is_stated_to_step(ago_s=2.0)
    assert wearer.monitor.steps == 0


def test_kneeling_and_then_crawling_is_crawling(wearer: Wearer) -> None:
    wearer.stirs(1.0, TIPPED_DEG)
    wearer.rests(3.0, TIPPED_DEG)
    stated = [wearer.output()]
    wearer.strides(4, 0.4, angle_deg=TIPPED_DEG)
    stated.append(wearer.output())
    assert stated == [Activity.LYING, Activity.CRAWLING]
