"""Properties of the default tracker for every walk."""

from __future__ import annotations

from dataclasses import fields
from functools import cache
from itertools import pairwise

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from edge.samples import ImuBatch
from edge.simulation.legs import Stand, Walk
from edge.simulation.scenario import Scenario
from edge.simulation.simulation import Simulation
from edge.tracker.foot.eskf import EskfTracker
from edge.tracker.mechanization.strapdown import rotation_matrix
from edge.tracker.track_rows import join_rows
from tests.rig.exact_strides import part, walk
from tests.rig.inertial_walk import inertial_samples

WALK = walk(strides=6, gyro_bias_radps=(0.002, -0.004, 0.003), accel_bias_mps2=(0.05, 0.0, -0.1))


def run(imu, description=WALK.description, cuts=()):
    tracker = EskfTracker(description)
    edges = [0, *sorted(cuts), len(imu)]
    batches = [tracker.push(part(imu, slice(a, b))) for a, b in pairwise(edges)]
    return join_rows([*batches, tracker.finish()])


@cache
def whole():
    return run(WALK.imu)


def turned(imu, rotation):
    return ImuBatch(imu.t_ns, imu.accel_mps2 @ rotation.T, imu.gyro_radps @ rotation.T)


def random_rotation(seed):
    q, _ = np.linalg.qr(np.random.default_rng(seed).standard_normal((3, 3)))
    return q * np.linalg.det(q)


@settings(max_examples=15)
@given(cuts=st.lists(st.integers(0, len(WALK.imu)), max_size=40))
def test_batching_does_not_change_a_bit(cuts):
    rows = run(WALK.imu, cuts=cuts)
    for field in fields(rows):
        assert np.array_equal(getattr(rows, field.name), getattr(whole(), field.name)), field.name


@settings(max_examples=5)
@given(cuts=st.lists(st.integers(0, len(WALK.imu)), max_size=40), share=st.floats(0.78, 0.85))
def test_batching_changes_nothing_where_sensors_clip_undeclared(cuts, share):
    """A plateau is marked after its end, and bridged by the samples behind it."""
    accel_mps2, gyro_radps = (
        np.clip(readings, -share * np.abs(readings).max(), share * np.abs(readings).max())
        for readings in (WALK.imu.accel_mps2, WALK.imu.gyro_radps)
    )
    imu = ImuBatch(WALK.imu.t_ns, accel_mps2, gyro_radps)
    rows, whole = run(imu, cuts=cuts), run(imu)
    assert whole.reasons.any()
    for field in fields(rows):
        assert np.array_equal(getattr(rows, field.name), getattr(whole, field.name)), field.name


@settings(max_examples=5)
@given(
    cuts=st.lists(st.integers(0, len(WALK.imu)), max_size=40),
    begin=st.integers(600, len(WALK.imu) - 200),
    lost=st.integers(3, 70),
)
def test_batching_changes_nothing_where_samples_are_lost(cuts, begin, lost):
    """The samples of a hole are found in the kept samples, in any batching."""
    kept = np.r_[0:begin, begin + lost : len(WALK.imu)]
    imu = ImuBatch(WALK.imu.t_ns[kept], WALK.imu.accel_mps2[kept], WALK.imu.gyro_radps[kept])
    rows, whole = run(imu, cuts=[min(cut, len(imu)) for cut in cuts]), run(imu)
    for field in fields(rows):
        assert np.array_equal(getattr(rows, field.name), getattr(whole, field.name)), field.name


def test_single_samples_equal_the_batch_and_are_never_more_than_a_second_late():
    tracker = EskfTracker(WALK.description)
    released = []
    for k in range(len(WALK.imu)):
        rows = tracker.push(part(WALK.imu, slice(k, k + 1)))
        if len(rows):
            assert WALK.imu.t_ns[k] - rows.t_ns[0] <= 1_000_000_000
            released.append(rows)
    live = join_rows([*released, tracker.finish()])
    assert np.array_equal(live.t_ns, WALK.imu.t_ns)
    for field in fields(live):
        assert np.array_equal(getattr(live, field.name), getattr(whole(), field.name)), field.name


@settings(max_examples=10)
@given(seed=st.integers(0, 10_000))
def test_mount_turns_the_track_at_most_about_the_vertical(seed):
    rows = run(turned(WALK.imu, random_rotation(seed)))
    reach_m = np.linalg.norm(rows.position_n_m[:, :2], axis=1)
    expected_m = np.linalg.norm(whole().position_n_m[:, :2], axis=1)
    np.testing.assert_allclose(reach_m, expected_m, atol=2e-3)
    np.testing.assert_allclose(rows.position_n_m[:, 2], whole().position_n_m[:, 2], atol=2e-3)
    assert np.array_equal(rows.stationary, whole().stationary)


def test_other_foot_is_tracked_as_the_mirror_image():
    """The tracker prefers no side: reflected samples give the reflected way with the same
    uncertainty.
    """
    legs = (Stand(2.0), Walk(((6.0, 0.0), (6.0, 5.0))), Stand(1.0))
    simulation = Simulation(Scenario("turn", "turns right", legs), 3)
    imu = inertial_samples(simulation)
    mirror = np.array([1.0, -1.0, 1.0])  # a rate is a pseudovector
    other = ImuBatch(imu.t_ns, mirror * imu.accel_mps2, -mirror * imu.gyro_radps)
    right, left = run(imu, simulation.description), run(other, simulation.description)

    def seen_from_start(rows):
        """Displacement along the way from its start, and to its right."""
        north_m, east_m, down_m = rows.position_n_m.T
        there = rows.position_n_m[-1, :2] / np.linalg.norm(rows.position_n_m[-1, :2])
        along_m = there[0] * north_m + there[1] * east_m
        return np.column_stack((along_m, there[0] * east_m - there[1] * north_m, down_m))

    np.testing.assert_allclose(seen_from_start(left), mirror * seen_from_start(right), atol=1e-6)
    np.testing.assert_allclose(left.heading_std_rad, right.heading_std_rad, rtol=1e-6)
    assert np.array_equal(left.stationary, right.stationary)
    assert np.array_equal(left.quality, right.quality)


@settings(max_examples=10)
@given(seed=st.integers(0, 10_000))
def test_attitude_stays_orthonormal_and_covariance_positive(seed):
    noise = np.random.default_rng(seed)
    shaken = ImuBatch(
        WALK.imu.t_ns,
        WALK.imu.accel_mps2 + noise.normal(0.0, 3.0, WALK.imu.accel_mps2.shape),
        WALK.imu.gyro_radps + noise.normal(0.0, 0.5, WALK.imu.gyro_radps.shape),
    )
    rows = run(shaken)
    matrix = np.zeros((3, 3))
    for quaternion in rows.quaternion_nb[::50]:
        rotation_matrix(quaternion, matrix)
        np.testing.assert_allclose(matrix @ matrix.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(matrix) > 0.0
    covariance = rows.position_cov_m2
    np.testing.assert_allclose(covariance, covariance.transpose(0, 2, 1), rtol=1e-9, atol=1e-15)
    assert np.linalg.eigvalsh(covariance).min() > -1e-12
    assert np.isfinite(rows.position_n_m).all()


def test_the_filter_covariance_stays_symmetric_positive():
    tracker = EskfTracker(WALK.description)
    for first in range(0, len(WALK.imu), 100):
        tracker.push(part(WALK.imu, slice(first, first + 100)))
        covariance = tracker._state["covariance"][0]
        np.testing.assert_allclose(covariance, covariance.T, rtol=1e-7, atol=1e-14)
        assert np.linalg.eigvalsh(0.5 * (covariance + covariance.T)).min() >= -1e-12


@settings(max_examples=40)
@given(
    seed=st.integers(0, 10_000),
    steps_ns=st.lists(
        st.sampled_from([-(10**10), -5_000_000, 0, 1, 5_000_000, 200_000_000, 10**12]),
        min_size=1,
        max_size=8,
    ),
    scale=st.sampled_from([0.0, 1.0, 50.0, 3000.0]),
)
def test_every_sample_has_a_finite_row_for_any_input(seed, steps_ns, scale):
    noise = np.random.default_rng(seed)
    n = 600
    regular = np.full(n, 5_000_000)
    odd = noise.random(n) < 0.05
    regular[odd] = noise.choice(steps_ns, odd.sum())
    accel = noise.normal(0.0, 1.0, (n, 3)) * scale + [0.0, 0.0, -9.8]
    gyro = noise.normal(0.0, 0.01, (n, 3)) * scale
    accel[noise.random((n, 3)) < 0.03] = noise.choice([np.nan, np.inf, -1e300, 0.0])
    t_ns = np.cumsum(regular)
    rows = run(ImuBatch(t_ns, accel, gyro), cuts=(100, 101, 350))
    assert np.array_equal(rows.t_ns, t_ns)
    for values in (rows.position_n_m, rows.velocity_n_mps, rows.quaternion_nb):
        assert np.isfinite(values).all()
    assert np.isfinite(rows.position_cov_m2).all()
    assert np.isfinite(rows.heading_std_rad).all()
