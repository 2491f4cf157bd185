"""Sensors that clip, declared or not: found, flagged and doubted."""

from __future__ import annotations

import numpy as np
import pytest

from edge.samples import SensorDescription
from edge.tracker.interface import Quality, Reason
from tests.rig.faulty_walk import IN_STANCE, IN_SWING, WALK, copy, flagged, index, reached_m, run


def test_a_clipped_gyroscope_is_flagged_and_widens_the_uncertainty():
    t_ns, accel, gyro = copy()
    full_scale = 0.7 * np.abs(gyro).max()
    description = SensorDescription("clipping", 200.0, gyro_full_scale_radps=full_scale)
    rows = run(t_ns, accel, np.clip(gyro, -full_scale, full_scale), description)
    clipped = np.abs(gyro).max(axis=1) >= full_scale
    assert flagged(rows, Reason.GYRO_SATURATED)[clipped].all()
    assert not flagged(rows, Reason.GYRO_SATURATED)[:300].any()
    honest = run(*copy())
    assert np.trace(rows.position_cov_m2[-1]) > np.trace(honest.position_cov_m2[-1])


def test_a_clipped_accelerometer_is_flagged():
    t_ns, accel, gyro = copy()
    description = SensorDescription("clipping", 200.0, accel_full_scale_mps2=15.0)
    rows = run(t_ns, np.clip(accel, -15.0, 15.0), gyro, description)
    assert flagged(rows, Reason.ACCEL_SATURATED).any()


@pytest.mark.parametrize("rate_hz", [67.0, 100.0, 200.0])
def test_undeclared_clipping_shows_by_its_plateaus(rate_hz):
    t_ns, accel, gyro = copy()
    every = round(200.0 / rate_hz)
    t_ns, accel, gyro = t_ns[::every], accel[::every], gyro[::every]
    full_scale = 0.85 * np.abs(gyro).max()
    description = SensorDescription("untold", rate_hz)
    rows = run(t_ns, accel, np.clip(gyro, -full_scale, full_scale), description)
    clipped = np.abs(gyro).max(axis=1) >= full_scale
    assert not flagged(rows, Reason.GYRO_SATURATED)[: np.flatnonzero(clipped)[0] - 1].any()
    assert flagged(rows, Reason.GYRO_SATURATED)[np.argmax(np.abs(gyro).max(axis=1))]
    whole = run(t_ns, accel, gyro, description)
    assert not flagged(whole, Reason.GYRO_SATURATED).any()


def test_exceeded_full_scale_is_discarded():
    t_ns, accel, gyro = copy()
    full_scale = 0.85 * np.abs(gyro).max()
    early = slice(0, index(IN_STANCE))
    gyro[early] = np.clip(gyro[early], -full_scale, full_scale)
    rows = run(t_ns, accel, gyro)
    assert flagged(rows, Reason.GYRO_SATURATED)[early].any()
    assert not flagged(rows, Reason.GYRO_SATURATED)[-300:].any()


def test_mostly_clipped_gyroscope_has_a_bounded_uncertainty():
    """The bias observed at rest then differs from sample to sample."""
    t_ns, accel, gyro = copy()
    rows = run(t_ns, accel, np.clip(gyro, -1.5, 1.5))  # too slow to be taken for a full scale
    assert np.sqrt(rows.position_cov_m2[-1, 0, 0]) < 100.0  # after 17 s; once infinite
    assert rows.quality[-1] == Quality.LOST


def test_short_plateau_in_a_rise_is_no_full_scale():
    t_ns, accel, gyro = copy()
    k = int(np.argmax(np.abs(gyro[:, 1]) > 0.85 * np.abs(gyro).max()))
    gyro[k : k + 4, 1] = gyro[k, 1]  # for once the same to the last bit
    assert not flagged(run(t_ns, accel, gyro), Reason.GYRO_SATURATED).any()


@pytest.mark.parametrize("full_scale", [0.8, 0.85])
def test_smoothed_plateaus_show_a_full_scale(full_scale):
    """Real sensors filter and rotate what has clipped."""
    t_ns, accel, gyro = copy()
    full_scale *= np.abs(gyro).max()
    clipped = np.clip(gyro, -full_scale, full_scale)
    weights = (0.2, 0.6, 0.2)
    smooth = np.column_stack([np.convolve(clipped[:, j], weights, "same") for j in range(3)])
    ripple = 1.0 + 0.003 * np.sin(0.7 * np.arange(len(smooth)))
    rows = run(t_ns, accel, ripple[:, np.newaxis] * smooth)
    late = slice(index(IN_SWING), None)
    assert flagged(rows, Reason.GYRO_SATURATED)[late][np.abs(gyro[late, 1]) >= full_scale].all()
    flat_n_m = run(t_ns, accel, gyro).position_n_m
    assert np.abs(rows.position_n_m[-1] - flat_n_m[-1]).max() < 0.3


def smoothed(readings):
    """As real sensors filter what has clipped."""
    columns = [np.convolve(readings[:, j], (0.2, 0.6, 0.2), "same") for j in range(3)]
    return np.column_stack(columns)


def in_counts(readings, full_scale):
    """As a converter of 12 bits gives them, which reaches further down than up."""
    step = full_scale / 2048
    return step * np.clip(np.round(readings / step), -2048, 2047)


@pytest.mark.parametrize("rate_hz", [67.0, 100.0, 200.0])
@pytest.mark.parametrize("sensor", ["clips", "filters", "counts"])
def test_an_undeclared_full_scale_of_forces_shows_by_its_plateaus(rate_hz, sensor):
    t_ns, accel, gyro = copy()
    every = round(200.0 / rate_hz)
    t_ns, accel, gyro = t_ns[::every], accel[::every], gyro[::every]
    full_scale = 0.75 * np.abs(accel).max()
    clipped = np.clip(accel, -full_scale, full_scale)
    if sensor == "filters":
        clipped = smoothed(clipped)
    if sensor == "counts":
        clipped = in_counts(accel, full_scale)
    description = SensorDescription("untold", rate_hz)
    rows = run(t_ns, clipped, gyro, description)
    hidden = np.abs(accel).max(axis=1) >= full_scale
    assert not flagged(rows, Reason.ACCEL_SATURATED)[: np.flatnonzero(hidden)[0] - 1].any()
    later = hidden & (t_ns > (IN_SWING - 1.2) * 1e9)
    assert flagged(rows, Reason.ACCEL_SATURATED)[later].all()
    whole = run(t_ns, accel, gyro, description)
    assert not flagged(whole, Reason.ACCEL_SATURATED).any()


@pytest.mark.parametrize("every", [3, 4])
def test_forces_held_by_a_slow_sensor_are_no_full_scale(every):
    t_ns, accel, gyro = copy()
    held = accel[np.arange(len(accel)) // every * every]
    assert not flagged(run(t_ns, held, gyro), Reason.ACCEL_SATURATED).any()


def test_detected_clipping_is_handled_as_reported_clipping():
    t_ns, accel, gyro = copy()
    full_scale = 0.75 * np.abs(accel).max()
    clipped = np.clip(accel, -full_scale, full_scale)
    reported = SensorDescription("told", 200.0, accel_full_scale_mps2=full_scale)
    more = SensorDescription("told too much", 200.0, accel_full_scale_mps2=10.0 * full_scale)
    known = run(t_ns, clipped, gyro, reported)
    whole = run(t_ns, accel, gyro)
    assert known.position_cov_m2[-1, 0, 0] > 2.0 * whole.position_cov_m2[-1, 0, 0]
    for description in (WALK.description, more):
        rows = run(t_ns, clipped, gyro, description)
        assert reached_m(rows) == pytest.approx(reached_m(known), rel=0.02)
        stated_m2 = rows.position_cov_m2[-1, 0, 0]
        assert stated_m2 == pytest.approx(known.position_cov_m2[-1, 0, 0], rel=0.3)
