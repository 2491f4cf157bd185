"""Feet that are raised and put down slowly: their stillest moment in mid-air is no stance."""

from __future__ import annotations

import numpy as np
import pytest

from edge.samples import SensorDescription
from edge.simulation.legs import StairsLeg, Stand, Walk
from edge.simulation.scenario import Scenario
from edge.simulation.simulation import UNCALIBRATED_SENSORS, Simulation
from edge.sources.recording import RecordingSource, read_truth
from edge.sources.registry import open_source
from edge.sources.simulated import SimulatedSource
from edge.tracker.foot.eskf import EskfTracker
from edge.tracker.interface import Quality, Reason
from edge.tracker.track_rows import join_rows
from tests.bench.tracker.scoring import score_track
from tests.bench.tracker.walk_errors import track
from tests.rig.exact_strides import walk
from tests.rig.raised_foot import DESCRIPTION, raised_slowly


@pytest.mark.parametrize("height_m", [0.3, 0.6, 0.9])
def test_slowly_raised_and_lowered_feet_keep_their_height(height_m):
    rows = track(DESCRIPTION, raised_slowly(12, height_m), "eskf")
    std_m = np.sqrt(rows.position_cov_m2[-1, 2, 2])
    assert abs(rows.position_n_m[-1, 2]) < min(0.1, 3.0 * std_m + 0.01)
    assert rows.quality[-1] == Quality.GOOD
    assert not np.any(rows.reasons & Reason.INCONSISTENT)


def test_raised_foot_is_not_stationary():
    rows = track(DESCRIPTION, raised_slowly(6), "eskf")
    high = rows.position_n_m[:, 2] < -0.2
    assert np.mean(high) > 0.1
    assert not np.any(rows.stationary & high)


@pytest.mark.parametrize("trial", ["2018-02-09-11-16-53", "2018-02-09-11-19-39"])
def test_height_error_of_slowly_raised_recorded_feet_is_small(hard_walks, trial):
    source = RecordingSource(hard_walks / "vicon" / trial)
    rows = track(source.description, source.imu, "eskf")
    score = score_track(rows, read_truth(hard_walks / "vicon" / trial), closed_loop=False)
    assert score.vertical_rms_m is not None
    assert score.vertical_rms_m < 0.1  # 1.5 where mid-air is believed
    assert score.ate_m is not None
    assert score.ate_m < 0.06
    assert score.coverage_95_vertical is not None
    assert score.coverage_95_vertical > 0.9
    assert score.silently_wrong == 0.0


@pytest.mark.parametrize(
    ("legs", "rise_m"),
    [
        ((Walk(((12.0, 0.0),)), Walk(((40.0, 0.0), (12.0, 0.0)), "run")), 0.0),
        ((StairsLeg((0.2, 0.0), 4.2, 14), Stand(2.0), Walk(((6.0, 0.0),), "search")), 4.2),
        ((Walk(((6.0, 0.0),), "laden"), StairsLeg((9.0, 0.0), -1.6, 9)), -1.6),
    ],
    ids=["a walk becomes a run", "a ladder and a search", "laden down stairs"],
)
def test_stances_of_another_gait_are_accepted_directly_after_a_rest(legs, rise_m):
    scenario = Scenario("gaits", "changes", (Stand(5.0), *legs, Stand(3.0)))
    simulation = Simulation(scenario, 3, UNCALIBRATED_SENSORS)
    tracker = EskfTracker(simulation.description)
    batches = [tracker.push(batch.imu) for batch in simulation.batches(2.0)]
    rows = join_rows([*batches, tracker.finish()])
    assert not np.any(rows.reasons & Reason.NO_STANCE)
    assert -rows.position_n_m[-1, 2] == pytest.approx(rise_m, abs=0.4)


def test_restless_stances_after_short_steps_are_accepted():
    """On a landing, less still than those before: the filter is off along the floor only."""
    source = open_source("simulated:stairs?seed=71")
    assert isinstance(source, SimulatedSource)
    tracker = EskfTracker(source.description)
    batches = [tracker.push(batch.imu) for batch in source.batches()]
    rows = join_rows([*batches, tracker.finish()])
    t_s = (rows.t_ns - rows.t_ns[0]) * 1e-9
    for footfall_s in source.simulation.plan.footfall_s:
        assert rows.stationary[(t_s > footfall_s) & (t_s < footfall_s + 0.3)].any(), footfall_s


def test_horizontal_velocity_error_is_corrected_by_a_stance():
    """A swing with a fault of the gyroscope: its velocity is wrong, and the stance is true."""
    made = walk(strides=10)
    imu = made.imu
    fault = slice(1500, 1520)
    gyro_radps = imu.gyro_radps.copy()
    gyro_radps[fault] += [2.0, 2.0, 0.0]
    turned = type(imu)(imu.t_ns, imu.accel_mps2, gyro_radps)
    rows = track(SensorDescription("synthetic", 200.0), turned, "eskf")
    assert not np.any(rows.reasons & Reason.NO_STANCE)
