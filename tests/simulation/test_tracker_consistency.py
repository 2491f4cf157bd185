"""Stances that contradict the motion between them: the tracker reports that its height is lost.

Feet that are raised slowly are such a motion for a tracker that believes every stance.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from edge.samples import SensorDescription
from edge.simulation.legs import Crawl, Kneel, Ride, StairsLeg, Stand, Walk
from edge.simulation.scenario import Scenario
from edge.simulation.simulation import CONSUMER_SENSORS, UNCALIBRATED_SENSORS, Simulation
from edge.tracker.foot.config import EskfConfig, StanceAcceptanceConfig
from edge.tracker.foot.eskf import EskfTracker
from edge.tracker.interface import Quality, Reason
from edge.tracker.track_rows import join_rows
from tests.bench.tracker.walk_errors import track
from tests.rig.exact_strides import walk
from tests.rig.raised_foot import DESCRIPTION, raised_slowly

RAISED = 12
BELIEVING = EskfConfig(acceptance=StanceAcceptanceConfig(reject_longest_s=0.0))
SEED = 101  # with which kneeling on toes and getting up is taken for a contradiction most easily
LEGS = {
    "walks": (Walk(((15.0, 0.0), (15.0, 8.0), (0.0, 8.0))),),
    "runs": (Walk(((40.0, 0.0), (0.0, 0.0)), "run"),),
    "ladder": (StairsLeg((0.2, 0.0), 4.2, 14), Stand(2.0), StairsLeg((0.0, 0.0), -4.2, 14)),
    "stairs": (StairsLeg((2.5, 0.0), 1.6, 9), Stand(1.0), StairsLeg((0.0, 0.0), -1.6, 9)),
    "crawls and kneels": (Crawl(((5.0, 0.0), (0.0, 0.0))), Kneel(20.0)),
}


@cache
def raised_rows():
    return believed(raised_slowly(RAISED))


def believed(imu):
    tracker = EskfTracker(DESCRIPTION, BELIEVING)
    return join_rows([tracker.push(imu), tracker.finish()])


def inconsistent(rows):
    return (rows.reasons & Reason.INCONSISTENT) != 0


def test_slowly_raised_feet_are_reported_as_lost_height():
    rows = raised_rows()
    off_m = np.abs(rows.position_n_m[-1, 2])  # they stand where they stood
    std_m = np.sqrt(rows.position_cov_m2[-1, 2, 2])
    assert off_m > 1.0  # else this motion tests nothing
    assert off_m < 3.0 * std_m
    assert rows.quality[-1] == Quality.LOST
    assert inconsistent(rows)[-1]


def test_row_with_a_height_error_of_half_a_storey_is_not_good():
    rows = raised_rows()
    off_m = np.abs(rows.position_n_m[:, 2])
    wrong = rows.stationary & (off_m > 1.5)  # in mid-air a height is no error
    assert wrong.any()
    assert not np.any(wrong & (rows.quality == Quality.GOOD))


def test_lost_height_stays_lost_during_later_good_steps():
    imu, more = raised_slowly(RAISED), walk(strides=15).imu
    tracker = EskfTracker(DESCRIPTION, BELIEVING)
    later_ns = imu.t_ns[-1] + 5_000_000
    rows = join_rows(
        [
            tracker.push(imu),
            tracker.push(type(more)(more.t_ns + later_ns, more.accel_mps2, more.gyro_radps)),
            tracker.finish(),
        ]
    )
    lost = rows.quality == Quality.LOST
    first = int(np.argmax(lost))
    assert lost[first:].all()
    assert inconsistent(rows)[first:].all()
    assert rows.position_cov_m2[-1, 2, 2] >= rows.position_cov_m2[first, 2, 2]


def test_single_contradiction_marks_rows_without_losing_the_height():
    """Once is doubt of a decimetre or two, which stay stated, and no lost height."""
    rows = believed(raised_slowly(1, height_m=0.45))
    assert inconsistent(rows).any()
    assert not np.any(rows.quality == Quality.LOST)
    plain = believed(raised_slowly(0))
    assert rows.position_cov_m2[-1, 2, 2] > plain.position_cov_m2[-1, 2, 2] + 0.05**2


@pytest.mark.parametrize("calibrated", [True, False], ids=["calibrated", "data sheet"])
@pytest.mark.parametrize("legs", LEGS)
def test_walkers_runners_climbers_and_crawlers_are_consistent(legs, calibrated):
    sensors = CONSUMER_SENSORS if calibrated else UNCALIBRATED_SENSORS
    rows = simulated(Scenario(legs, legs, (Stand(4.0), *LEGS[legs], Stand(2.0))), sensors)
    assert not inconsistent(rows).any()


def test_lift_ride_with_a_barometer_is_consistent():
    legs = (Stand(4.0), Walk(((6.0, 0.0),)), Ride(9.0), Walk(((0.0, 0.0),)), Stand(2.0))
    rows = simulated(Scenario("lift", "rides", legs), CONSUMER_SENSORS)
    assert rows.position_n_m[-1, 2] == pytest.approx(-9.0, abs=0.6)
    assert not inconsistent(rows).any()


def simulated(scenario, sensors):
    simulation = Simulation(scenario, SEED, sensors)
    tracker = EskfTracker(simulation.description)
    batches = [tracker.push(batch.imu) for batch in simulation.batches(2.0)]
    return join_rows([*batches, tracker.finish()])


def test_steep_exact_strides_are_consistent():
    """A ladder without a foot's own give: 0.3 m up and 5 cm ahead at each stride."""
    climb = walk(strides=12, stride_m=0.05, rise_m=0.3)
    rows = track(SensorDescription("synthetic", 200.0), climb.imu, "eskf")
    assert rows.position_n_m[-1, 2] == pytest.approx(climb.position_n_m[-1, 2], abs=0.2)
    assert not inconsistent(rows).any()
