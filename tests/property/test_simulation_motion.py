"""The simulated motion is consistent: rates and accelerations are derivatives."""

from __future__ import annotations

from functools import cache
from typing import get_args

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace

from edge.samples import Floats
from edge.simulation.curve import Curve
from edge.simulation.factory import find_scenario
from edge.simulation.jet import Jet, oscillation, sine_and_cosine
from edge.simulation.legs import Segment
from edge.simulation.scenario import Scenario
from edge.simulation.simulation import Simulation

STEP_S = 1e-4
TIMES_S = st.floats(1.0, 120.0)
SEEDS = st.integers(0, 2**32)


def scenario_named(name: str) -> Scenario:
    return replace(find_scenario(name), duration_s=130.0)


@cache
def simulated(name: str, segment: Segment) -> Simulation:
    return Simulation(replace(scenario_named(name), worn_on=segment), seed=11)


NAMES = ("climbs-stairs", "gets-hot", "goes-down", "gaits", "track-400m")
SIMULATED = st.builds(simulated, st.sampled_from(NAMES), st.sampled_from(get_args(Segment)))


def central(values: Floats) -> Floats:
    """Fourth-order derivative from five values at equal steps."""
    slope = values[0] - 8.0 * values[1] + 8.0 * values[3] - values[4]
    return np.asarray(slope / (12.0 * STEP_S), dtype=np.float64)


def around(t_s: float) -> Floats:
    return t_s + STEP_S * np.arange(-2.0, 3.0)


@given(SIMULATED, TIMES_S)
def test_velocity_is_the_derivative_of_position(simulation: Simulation, t_s: float) -> None:
    motion = simulation.truth(around(t_s))
    assert central(motion.position_n_m) == pytest.approx(motion.velocity_n_mps[2], abs=1e-6)


@given(SIMULATED, TIMES_S)
def test_acceleration_is_the_derivative_of_velocity(simulation: Simulation, t_s: float) -> None:
    motion = simulation.truth(around(t_s))
    assert central(motion.velocity_n_mps) == pytest.approx(motion.accel_n_mps2[2], abs=1e-3)


@given(SIMULATED, TIMES_S)
def test_angular_rate_is_the_derivative_of_attitude(simulation: Simulation, t_s: float) -> None:
    motion = simulation.truth(around(t_s))
    turning = motion.rotation_nb[2].T @ central(motion.rotation_nb)
    rate_radps = [turning[2, 1], turning[0, 2], turning[1, 0]]
    assert rate_radps == pytest.approx(motion.rate_b_radps[2], abs=1e-5)


@given(SIMULATED, TIMES_S)
def test_attitude_is_a_rotation(simulation: Simulation, t_s: float) -> None:
    rotation_nb = simulation.truth(np.array([t_s])).rotation_nb[0]
    assert rotation_nb @ rotation_nb.T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(rotation_nb) == pytest.approx(1.0)


@given(
    st.lists(
        st.tuples(st.floats(0.0, 2.0), st.floats(0.05, 2.0), st.floats(-5.0, 5.0)), max_size=6
    ),
    st.floats(0.0, 20.0),
)
def test_curve_is_smooth_and_reaches_its_values(
    moves: list[tuple[float, float, float]], t_s: float
) -> None:
    curve = Curve(1.0)
    for pause_s, move_s, value in moves:
        start_s = curve.end_s + pause_s
        curve.move(start_s, start_s + move_s, value)
        assert curve.jet(np.array([curve.end_s])).value[0] == pytest.approx(value)
    jet = curve.jet(t_s + 2 * STEP_S + around(0.0))
    assert central(jet.value) == pytest.approx(jet.rate[2], abs=1e-4)
    # The jerk of a move of 10 in 0.05 s exceeds 10^6; the test is that nothing jumps.
    assert central(jet.rate) == pytest.approx(jet.accel[2], abs=1.0, rel=1e-4)


@given(st.floats(0.0, 1.9), st.floats(0.1, 2.0))
def test_overlapping_moves_are_refused(start_s: float, duration_s: float) -> None:
    curve = Curve(0.0)
    curve.move(1.0, 2.0, 5.0)
    with pytest.raises(ValueError, match="no move from"):
        curve.move(start_s, start_s + duration_s, 0.0)
    assert (curve.end_s, curve.last) == (2.0, 5.0)


@given(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), st.floats(-3.0, 3.0))
def test_jets_follow_product_and_chain_rules(value: float, rate: float, accel: float) -> None:
    t_s = around(0.0)
    x = Jet(value + rate * t_s + 0.5 * accel * t_s**2, rate + accel * t_s, np.full_like(t_s, accel))
    wave = oscillation(t_s, 0.7, 1.3, 0.4)
    for jet in (x * wave, *sine_and_cosine(x), x + wave, x - wave, x.scaled(2.0).shifted(1.0)):
        assert central(jet.value) == pytest.approx(jet.rate[2], abs=1e-6)
        assert central(jet.rate) == pytest.approx(jet.accel[2], abs=1e-5)


@pytest.mark.slow
@given(SEEDS)
def test_equal_seeds_give_equal_samples_in_any_batching(seed: int) -> None:
    scenario = scenario_named("climbs-stairs")
    whole = next(iter(Simulation(scenario, seed).batches(batch_s=2.0)))
    parts = Simulation(scenario, seed).batches(batch_s=0.05)
    some = [next(parts) for _ in range(40)]
    for name in ("accel_mps2", "gyro_radps", "mag_ut", "pressure_pa", "imu_temperature_degc"):
        expected = getattr(whole.imu, name)
        assert np.concatenate([getattr(part.imu, name) for part in some]).tobytes() == (
            expected.tobytes()
        )
    assert repr(sum((part.others for part in some), ())) == repr(whole.others)


@pytest.mark.slow
@given(SEEDS)
def test_different_seeds_give_different_samples(seed: int) -> None:
    scenario = scenario_named("straight")
    one = next(iter(Simulation(scenario, seed).batches()))
    other = next(iter(Simulation(scenario, seed + 1).batches()))
    assert not np.array_equal(one.imu.accel_mps2, other.imu.accel_mps2)
