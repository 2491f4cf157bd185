"""Contract of every tracker in ``MULTI_SENSOR_TRACKERS``."""

from __future__ import annotations

from dataclasses import fields
from functools import cache

import numpy as np
import pytest

from edge.activity.monitor import ActivityMonitor
from edge.samples import ImuBatch, SensorDescription
from edge.simulation.legs import Stand, Walk
from edge.simulation.scenario import Scenario
from edge.tracker.interface import MOST_LAG_S, BodyDimensions, Quality, WornSensor
from edge.tracker.registry import (
    MULTI_SENSOR_TRACKERS,
    find_multi_sensor_tracker,
    make_multi_sensor_tracker,
)
from edge.tracker.track_rows import join_rows
from shared.earth_field import EarthField
from shared.errors import ConfigError
from tests.rig.sensors_of_person import in_turn, track_person, walk_with_sensors, worn

SHORT = Scenario("short", "7 m", (Stand(2.0), Walk(((6.8, 0.0),)), Stand(1.5)))
FIFTY = Scenario("fifty", "50 m", (Stand(3.0), Walk(((50.0, 0.0),)), Stand(2.0)))
DIMENSIONS = BodyDimensions(leg_length_m=0.87)  # of the simulated person


@pytest.fixture(params=[entry.name for entry in MULTI_SENSOR_TRACKERS])
def name(request):
    return request.param


def places_of(name):
    return tuple(choices[0] for choices in find_multi_sensor_tracker(name).places)


@cache
def walked(name, scenario, rate_hz=200.0):
    walks = walk_with_sensors(scenario, places_of(name), rate_hz=rate_hz)
    return worn(walks), {place: walk.sensed() for place, walk in walks.items()}


def made(name, scenario=SHORT, rate_hz=200.0):
    sensors, samples = walked(name, scenario, rate_hz)
    return make_multi_sensor_tracker(name, sensors, DIMENSIONS), samples


def assert_same(rows, others):
    for field in fields(rows):
        assert np.array_equal(getattr(rows, field.name), getattr(others, field.name)), field.name


def test_each_sample_of_the_leading_sensor_gets_one_row_in_order(name):
    tracker, samples = made(name)
    rows = track_person(tracker, samples)
    assert np.array_equal(rows.t_ns, samples[places_of(name)[0]].t_ns)


@pytest.mark.parametrize("block_s", [0.005, 0.033, 0.39])
def test_batching_does_not_change_a_bit(name, block_s):
    tracker, samples = made(name)
    usual = track_person(tracker, samples)
    tracker, samples = made(name)
    assert_same(track_person(tracker, samples, block_s), usual)


@pytest.mark.parametrize("late", [0, 1])
def test_interleaving_does_not_change_a_bit(name, late):
    tracker, samples = made(name)
    usual = track_person(tracker, samples)
    tracker, samples = made(name)
    late_ns = round((MOST_LAG_S - 0.1) * 1e9)
    shifts_ns = [late_ns if k == late else 0 for k in range(len(samples))]
    order = sorted(
        (int(batch.t_ns[-1]) + shifts_ns[list(samples).index(sensor)], sensor, k, batch)
        for k, (sensor, batch) in enumerate(in_turn(samples, 0.04))
    )
    batches = [tracker.push(sensor, batch) for _, sensor, _, batch in order]
    assert_same(join_rows([*batches, tracker.finish()]), usual)


def test_rows_are_final_within_a_second(name):
    tracker, samples = made(name)
    last_ns = -1
    for sensor, batch in in_turn(samples, 0.005):
        rows = tracker.push(sensor, batch)
        if len(rows):
            last_ns = int(rows.t_ns[-1])
        assert last_ns >= batch.t_ns[0] - 1_050_000_000


def test_shapes_and_units_are_plausible(name):
    rows = track_person(*made(name))
    n = len(rows)
    assert rows.position_n_m.shape == rows.velocity_n_mps.shape == (n, 3)
    np.testing.assert_allclose(np.linalg.norm(rows.quaternion_nb, axis=1), 1.0, atol=1e-9)
    assert np.isfinite(rows.heading_std_rad).all()
    assert np.linalg.eigvalsh(rows.position_cov_m2).min() > -1e-9
    assert set(np.unique(rows.quality)) <= {int(quality) for quality in Quality}
    assert np.all(np.diff(rows.distance_m) >= 0.0)
    assert np.all(np.diff(rows.steps) >= 0)


@pytest.mark.slow
@pytest.mark.parametrize("rate_hz", [60.0, 100.0, 200.0, 250.0, 400.0, 820.0])
def test_fifty_metres_are_fifty_metres_at_any_rate(name, rate_hz):
    rows = track_person(*made(name, FIFTY, rate_hz))
    assert rows.distance_m[-1] == pytest.approx(50.0, rel=0.05)
    away_m = np.hypot(*(rows.position_n_m[-1] - rows.position_n_m[0])[:2])
    assert away_m == pytest.approx(50.0, rel=0.05)


def test_cadence_of_the_tracker_is_that_of_the_wearer(name):
    tracker, samples = made(name)
    monitor, strides, leading = ActivityMonitor(), 0, places_of(name)[0]
    for sensor, batch in in_turn(samples):
        rows = tracker.push(sensor, batch)
        monitor.push(batch if sensor == leading else batch.part(slice(0)), rows)
        strides = int(rows.steps[-1]) if len(rows) else strides
    assert strides >= 3
    assert monitor.steps == pytest.approx(2 * strides, abs=2)


@pytest.mark.parametrize("gone", [0, 1])
def test_sensor_failure_is_reported_and_tracking_continues_where_possible(name, gone):
    tracker, samples = made(name, FIFTY)
    place = places_of(name)[gone]
    imu = samples[place]
    until_ns = 20_000_000_000
    left = {**samples, place: imu.part(slice(0, int(np.searchsorted(imu.t_ns, until_ns))))}
    rows = track_person(tracker, left)
    after = rows.t_ns > until_ns + 2_000_000_000
    if goes_on(name, gone):
        assert rows.distance_m[-1] == pytest.approx(50.0, rel=0.1)
        assert not np.any(rows.quality[after] == Quality.GOOD)
    else:
        assert not after.any()


def goes_on(name, gone):
    """Tracker continues without the other sensor; a shank alone has no heading of the body."""
    return not (name == "torso_shank" and gone == 0)


def test_rows_continue_while_the_earths_field_is_learned(name):
    tracker, samples = made(name)
    tracker.set_earth_field(EarthField(0.3, 0.01, 18.0, 45.0, 0.1, 0.1), 3_000_000_000)
    rows = track_person(tracker, samples)
    assert np.array_equal(rows.t_ns, samples[places_of(name)[0]].t_ns)


def test_no_samples_give_no_rows(name):
    tracker, samples = made(name)
    empty = ImuBatch(np.zeros(0, np.int64), np.zeros((0, 3)), np.zeros((0, 3)))
    assert all(len(tracker.push(sensor, empty)) == 0 for sensor in samples)
    assert len(tracker.finish()) == 0


def test_samples_with_all_values_missing_get_rows(name):
    tracker, samples = made(name)
    missing = np.full((300, 3), np.nan)
    rows = track_person(
        tracker,
        {sensor: ImuBatch(imu.t_ns[:300], missing, missing) for sensor, imu in samples.items()},
    )
    assert len(rows) == 300
    assert np.isfinite(rows.position_n_m).all()
    assert not np.any(rows.quality == Quality.GOOD)


def test_sensors_that_do_not_fit_are_refused(name):
    with pytest.raises(ConfigError, match=places_of(name)[0]):
        make_multi_sensor_tracker(
            name, {"one": WornSensor(SensorDescription("one", 100.0), "hand")}
        )
