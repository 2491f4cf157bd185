"""Contract of every tracker in ``TRACKERS``."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import cache

import msgspec
import numpy as np
import pytest

from edge.samples import ImuBatch, SensorDescription
from edge.simulation.legs import Stand, Walk
from edge.simulation.scenario import Scenario
from edge.simulation.scenarios import SCENARIOS
from edge.simulation.simulation import Simulation
from edge.tracker.interface import FOOT, Quality
from edge.tracker.registry import TRACKERS, find_tracker, make_tracker
from edge.tracker.track_rows import join_rows
from shared.earth_field import EarthField
from shared.errors import ConfigError
from tests.rig.exact_strides import part, walk

STRAIGHT = next(scenario for scenario in SCENARIOS if scenario.name == "straight")  # 50 m
SHORT = Scenario("short", "7 m", (Stand(2.0), Walk(((6.8, 0.0),)), Stand(1.5)))
# Error of a length that a tracker may have, as a share: a simulated person steps unlike a real one.
LENGTH_TOLERANCE = {"body": 0.13}


@dataclass(frozen=True)
class WornSamples:
    """Samples of five strides straight on at a tracker's place on the body."""

    description: SensorDescription
    imu: ImuBatch
    length_m: float
    tolerance: float  # of the length, as a share


@cache
def worn(part):
    if part == FOOT:
        feet = walk(strides=5)
        return WornSamples(feet.description, feet.imu, 5 * 1.3, 0.1)
    simulation = Simulation(msgspec.structs.replace(SHORT, worn_on=part), seed=0)
    (batch,) = simulation.batches(simulation.duration_s)
    imu = ImuBatch(batch.imu.t_ns, batch.imu.accel_mps2, batch.imu.gyro_radps)
    return WornSamples(simulation.description, imu, 6.8, 0.15)  # one step more or less


@pytest.fixture(params=[entry.name for entry in TRACKERS])
def name(request):
    return request.param


@pytest.fixture
def five_strides(name):
    return worn(find_tracker(name).worn_on[0])


def run(name, five_strides, rows=50, imu=None):
    tracker = make_tracker(name, five_strides.description)
    imu = five_strides.imu if imu is None else imu
    batches = [
        tracker.push(part(imu, slice(first, first + rows))) for first in range(0, len(imu), rows)
    ]
    return join_rows([*batches, tracker.finish()])


def test_each_sample_gets_one_row_in_order(name, five_strides):
    rows = run(name, five_strides)
    assert np.array_equal(rows.t_ns, five_strides.imu.t_ns)


def test_batching_does_not_change_a_bit(name, five_strides):
    whole = run(name, five_strides, rows=len(five_strides.imu))
    live = run(name, five_strides, rows=1)
    for field in fields(whole):
        assert np.array_equal(getattr(whole, field.name), getattr(live, field.name)), field.name


@pytest.mark.parametrize("share", [0.0, 0.5])
def test_learned_earth_field_changes_no_earlier_row(name, five_strides, share):
    tracker, without = make_tracker(name, five_strides.description), run(name, five_strides)
    at = round(share * len(five_strides.imu))
    field = EarthField(0.3, 0.01, 18.0, 45.0, 0.1, 0.1)
    before = tracker.push(part(five_strides.imu, slice(0, at)))
    tracker.set_earth_field(field, int(five_strides.imu.t_ns[at]))
    rows = join_rows(
        [before, tracker.push(part(five_strides.imu, slice(at, None))), tracker.finish()]
    )
    assert np.array_equal(rows.t_ns, without.t_ns)
    assert np.array_equal(rows.position_n_m[: len(before)], without.position_n_m[: len(before)])
    assert not np.isnan(rows.magnetic_north_std_rad).any()


def test_rows_are_final_within_a_second(name, five_strides):
    tracker = make_tracker(name, five_strides.description)
    last_ns = -1
    for k in range(len(five_strides.imu)):
        rows = tracker.push(part(five_strides.imu, slice(k, k + 1)))
        if len(rows):
            last_ns = int(rows.t_ns[-1])
        assert last_ns >= five_strides.imu.t_ns[k] - 1_000_000_000


def test_shapes_and_units_are_plausible(name, five_strides):
    rows = run(name, five_strides)
    n = len(rows)
    assert rows.position_n_m.shape == rows.velocity_n_mps.shape == (n, 3)
    assert rows.quaternion_nb.shape == (n, 4)
    assert rows.position_cov_m2.shape == (n, 3, 3)
    np.testing.assert_allclose(np.linalg.norm(rows.quaternion_nb, axis=1), 1.0, atol=1e-9)
    assert np.isfinite(rows.heading_std_rad).all()
    assert np.linalg.eigvalsh(rows.position_cov_m2).min() > -1e-9
    assert set(np.unique(rows.quality)) <= {int(quality) for quality in Quality}
    assert np.all(np.diff(rows.distance_m) >= 0.0)
    assert np.all(np.diff(rows.steps) >= 0)


def test_straight_walk_is_straight_and_of_its_length(name, five_strides):
    rows = run(name, five_strides)
    reached_m = np.linalg.norm(rows.position_n_m[-1, :2])
    assert reached_m == pytest.approx(five_strides.length_m, rel=five_strides.tolerance)
    assert rows.steps[-1] == 5
    assert rows.distance_m[-1] == pytest.approx(five_strides.length_m, rel=five_strides.tolerance)
    assert abs(rows.position_n_m[-1, 2]) < 0.6


@cache
def straight(part, rate_hz):
    scenario = msgspec.structs.replace(STRAIGHT, rate_hz=rate_hz, worn_on=part)
    simulation = Simulation(scenario, seed=0)
    return simulation.description, [batch.imu for batch in simulation.batches()]


@pytest.mark.slow
@pytest.mark.parametrize("rate_hz", [60.0, 100.0, 200.0, 250.0, 400.0, 820.0])
@pytest.mark.parametrize("described", ["as it is", "four times too low"])
def test_fifty_metres_are_fifty_metres_at_any_rate(name, rate_hz, described):
    description, batches = straight(find_tracker(name).worn_on[0], rate_hz)
    if described == "four times too low":
        description = replace(description, rate_hz=rate_hz / 4.0)
    tracker = make_tracker(name, description)
    rows = join_rows([*map(tracker.push, batches), tracker.finish()])
    tolerance = LENGTH_TOLERANCE.get(name, 0.05)
    assert rows.distance_m[-1] == pytest.approx(50.0, rel=tolerance)
    away_m = np.hypot(*(rows.position_n_m[-1] - rows.position_n_m[0])[:2])
    assert away_m == pytest.approx(50.0, rel=tolerance)


def test_noise_of_its_path_is_stated_where_it_is_not_a_foot_s(name, five_strides):
    noise = make_tracker(name, five_strides.description).path_noise
    if FOOT in find_tracker(name).worn_on:
        assert noise is None
        return
    assert noise is not None
    assert noise.scale_std is not None
    assert noise.place_std_m_per_sqrt_m is not None
    assert 0.03 < noise.scale_std < 0.3
    assert 0.1 < noise.place_std_m_per_sqrt_m < 0.5


def test_no_samples_give_no_rows(name, five_strides):
    tracker = make_tracker(name, five_strides.description)
    empty = ImuBatch(np.zeros(0, np.int64), np.zeros((0, 3)), np.zeros((0, 3)))
    assert len(tracker.push(empty)) == 0
    assert len(tracker.finish()) == 0


def test_single_sample_suffices_to_finish(name, five_strides):
    tracker = make_tracker(name, five_strides.description)
    tracker.push(part(five_strides.imu, slice(0, 1)))
    assert len(tracker.finish()) == 1


def test_samples_with_all_values_missing_get_rows(name, five_strides):
    imu = ImuBatch(
        five_strides.imu.t_ns[:300], np.full((300, 3), np.nan), np.full((300, 3), np.nan)
    )
    rows = run(name, five_strides, imu=imu)
    assert len(rows) == 300
    assert np.isfinite(rows.position_n_m).all()
    assert not np.any(rows.quality == Quality.GOOD)


def test_any_array_layout_is_accepted(name, five_strides):
    whole = run(name, five_strides)
    views = np.zeros((len(five_strides.imu), 7))
    views[:, 1:4], views[:, 4:7] = five_strides.imu.accel_mps2, five_strides.imu.gyro_radps
    views.setflags(write=False)
    rows = run(
        name, five_strides, imu=ImuBatch(five_strides.imu.t_ns, views[:, 1:4], views[:, 4:7])
    )
    assert np.array_equal(rows.position_n_m, whole.position_n_m)


@pytest.mark.parametrize("rate_hz", [0.0, -1.0, np.nan, np.inf])
def test_description_without_rate_is_refused(name, rate_hz):
    with pytest.raises(ConfigError, match="rate"):
        make_tracker(name, SensorDescription("odd", rate_hz))


def test_unknown_name_is_refused_with_the_known_ones(five_strides):
    with pytest.raises(ConfigError, match="eskf"):
        make_tracker("no-such-tracker", five_strides.description)
