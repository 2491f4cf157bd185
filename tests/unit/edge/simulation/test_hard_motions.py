"""Hard motions have their features: pauses in mid-air, slides, short stances, clipped samples."""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from math import radians

import numpy as np
import pytest

from edge.samples import Floats
from edge.simulation.body_plan import SENSOR_HEIGHT_M
from edge.simulation.hard_motions import HARD_MOTIONS
from edge.simulation.imu import GRAVITY_MPS2
from edge.sources.recording import RecordingSource
from shared.messages.status import Activity
from tests.rig.inertial_walk import InertialWalk, inertial_walk
from tests.rig.stillness import clipped, stillest_of_strides_m2ps4, stillness_m2ps4

NAMES = [scenario.name for scenario in HARD_MOTIONS]
SEED = 5
_ACCEL_MPS2, _GYRO_RADPS = 16.0 * GRAVITY_MPS2, radians(500.0)


@cache
def walk(name: str) -> InertialWalk:
    return inertial_walk(name, SEED)


def height_m(walk: InertialWalk) -> Floats:
    """Return how far the foot is above where it lies flat on the first floor."""
    return -walk.truth.position_n_m[:, 2] - SENSOR_HEIGHT_M


def speed_mps(walk: InertialWalk) -> Floats:
    speeds: Floats = np.linalg.norm(walk.truth.velocity_n_mps, axis=1)
    return speeds


def strides_of(walk: InertialWalk, activity: Activity) -> list[float]:
    """Return the times of the footfalls in an activity."""
    plan = walk.simulation.plan
    return [t_s for t_s in plan.footfall_s if plan.activity(t_s - 0.01) is activity]


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_the_truth_is_its_own_integral_and_ends_on_its_floor(name: str) -> None:
    simulation = walk(name).simulation
    t_s = np.arange(0.0, simulation.duration_s, 1.0 / 4000.0)
    truth = simulation.truth(t_s)
    steps_s = np.diff(t_s)[:, np.newaxis]
    for rates, values in (
        (truth.velocity_n_mps, truth.position_n_m),
        (truth.accel_n_mps2, truth.velocity_n_mps),
    ):
        way = np.cumsum(0.5 * (rates[1:] + rates[:-1]) * steps_s, axis=0)
        np.testing.assert_allclose(way, values[1:] - values[0], atol=2e-3)
    assert height_m(walk(name))[-1] == pytest.approx(0.0, abs=0.03)
    assert speed_mps(walk(name))[-1] < 0.01


def test_raised_feet_are_put_down_slowly_and_hardly_turn_in_mid_air() -> None:
    raised = walk("raised-feet")
    spot = slice(0, np.searchsorted(raised.t_s, raised.simulation.plan.footfall_s[7] + 0.1))
    height, speed = height_m(raised)[spot], speed_mps(raised)[spot]
    still = stillness_m2ps4(raised.imu, 200.0)[spot]
    swings = np.flatnonzero(np.diff((height > 0.03).astype(int)))
    lasted_s = np.diff(raised.t_s[swings])[::2]
    assert len(lasted_s) == 8
    assert 1.2 < np.median(lasted_s) < 2.2
    assert 0.4 < height.max() < 1.0
    in_air = (height > 0.03) & (speed > 0.1) & (speed < 1.0)
    assert np.mean(in_air) > 0.3
    # What passes for a stance elsewhere: a careful walker's are as restless.
    assert np.percentile(still[in_air], 5) < 6.0


def test_careful_feet_swing_for_more_than_a_second_and_a_half() -> None:
    careful = walk("careful-steps")
    footfalls_s = careful.simulation.plan.footfall_s
    begins, ends = np.searchsorted(careful.t_s, [footfalls_s[0], footfalls_s[7]])
    moving = speed_mps(careful)[begins:ends] > 0.1
    strides = ends - begins
    swing_s = float(moving.sum()) / 7.0 / 200.0
    assert strides / 7.0 / 200.0 == pytest.approx(3.0, abs=0.3)
    assert 1.3 < swing_s < 2.0
    assert height_m(careful)[:ends].max() > 0.15
    assert np.ptp(careful.truth.position_n_m[:, 2]) > 3.0, "two flights"


def test_a_dragged_foot_never_leaves_the_floor_and_glides_without_turning() -> None:
    dragged = walk("dragged-foot")
    footfalls_s = strides_of(dragged, Activity.WALKING)
    rows = slice(*np.searchsorted(dragged.t_s, [footfalls_s[0], footfalls_s[20]]))
    assert height_m(dragged)[rows].max() < 0.03
    speed, turning_radps = speed_mps(dragged)[rows], np.linalg.norm(dragged.imu.gyro_radps, axis=1)
    assert np.mean(speed > 0.1) > 0.4
    assert 0.5 < np.percentile(speed, 90) < 1.5
    assert np.percentile(turning_radps[rows], 99) < 0.6
    still = stillness_m2ps4(dragged.imu, 200.0)[rows]
    assert np.percentile(still[speed > 0.3], 5) < 3.0, "it glides as still as others stand"


def test_gaits_change_from_one_stride_to_the_next() -> None:
    plan = walk("changing-gaits").simulation.plan
    moving = {Activity.WALKING, Activity.RUNNING}
    changes = [{a, b} for a, b in pairwise(plan.activities)]
    assert changes.count(moving) == 8
    lasts_s = np.diff(plan.footfall_s)
    ratios = np.maximum(lasts_s[1:] / lasts_s[:-1], lasts_s[:-1] / lasts_s[1:])
    assert np.sum(ratios > 1.4) >= 6


@pytest.mark.parametrize("name", ["sprint-800hz", "sprint-500dps"])
def test_sprinters_hardly_stop_and_their_sensors_clip(name: str) -> None:
    sprint = walk(name)
    still = stillness_m2ps4(sprint.imu, 800.0)
    running_s = strides_of(sprint, Activity.RUNNING)
    least = [
        still[(sprint.t_s > t_s + 0.02) & (sprint.t_s < t_s + 0.12)].min() for t_s in running_s
    ]
    assert 500.0 < np.median(least) < 1700.0
    assert np.percentile(least, 10) > 300.0
    rows = slice(*np.searchsorted(sprint.t_s, [running_s[0], running_s[-1]]))
    assert 0.005 < clipped(sprint.imu.accel_mps2[rows], _ACCEL_MPS2) < 0.05
    gyro = clipped(sprint.imu.gyro_radps[rows], _GYRO_RADPS)
    assert np.abs(sprint.imu.gyro_radps).max() > _GYRO_RADPS - 1e-3
    assert gyro > 0.15
    if name == "sprint-800hz":
        assert clipped(sprint.imu.gyro_radps, radians(2000.0)) == 0.0
    else:
        assert np.abs(sprint.imu.gyro_radps).max() < _GYRO_RADPS + 1e-3
        assert sprint.description.gyro_full_scale_radps == pytest.approx(_GYRO_RADPS)
    speed = np.ptp(sprint.truth.position_n_m[rows], axis=0)
    assert np.hypot(speed[0], speed[1]) / (running_s[-1] - running_s[0]) > 5.0


def test_a_struck_foot_stops_within_hundredths_of_a_second() -> None:
    sprint = walk("sprint-800hz")
    for t_s in strides_of(sprint, Activity.RUNNING)[3:20]:
        struck = sprint.simulation.truth(t_s + np.linspace(0.0, 0.014, 15))
        assert struck.velocity_n_mps[0, 2] > 0.8, "down"
        assert struck.accel_n_mps2[:, 2].min() < -100.0


@pytest.mark.parametrize(("name", "rate_hz"), [("run-100hz", 100.0), ("stairs-500hz", 500.0)])
def test_other_rates_are_those_that_are_promised(name: str, rate_hz: float) -> None:
    sampled = walk(name)
    assert sampled.description.rate_hz == rate_hz
    np.testing.assert_allclose(np.diff(sampled.t_s), 1.0 / rate_hz, atol=2e-9)
    climbs_m = 8 * 9 * 0.17 if name == "stairs-500hz" else 0.0
    assert height_m(sampled).max() == pytest.approx(climbs_m, abs=0.3)


@pytest.mark.parametrize(
    ("name", "trials"),
    [
        ("run-100hz", [("walks", trial) for trial in ("34", "35", "43", "44")]),
        ("sprint-800hz", [("hard", "53")]),
    ],
)
def test_runners_are_as_restless_as_recorded_ones(walks, hard_walks, name, trials) -> None:
    """The stillest moments of all strides are within a factor of three of the recorded medians."""
    folders = {"walks": walks, "hard": hard_walks}
    recorded = []
    for folder, trial in trials:
        source = RecordingSource(folders[folder] / "footprints" / trial)
        recorded.append(
            np.median(stillest_of_strides_m2ps4(source.imu, source.description.rate_hz))
        )
    simulated = np.median(stillest_of_strides_m2ps4(walk(name).imu, walk(name).description.rate_hz))
    assert np.median(recorded) / 3.0 < simulated < 3.0 * np.median(recorded)
