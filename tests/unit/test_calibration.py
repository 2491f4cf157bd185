"""Calibrations of simulated sensors with known errors: what is found, and what is refused."""

from __future__ import annotations

from contextlib import closing
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from typing import TypeVar

import msgspec
import numpy as np
import pytest

from edge.calibration import Calibration, identity, read_calibration, write_calibration
from edge.calibration.guide import guide, solve, take
from edge.calibration.model import Gyroscope
from edge.calibration.session import calibrate_guided, calibrate_recorded
from edge.calibration.steps import PosesStep, StillStep, TurningStep, WarmUpStep
from edge.samples import ImuBatch, SensorBatch, SensorDescription
from edge.simulation.handling import EDGES, SIDES, HandledUnit
from edge.simulation.imu import GRAVITY_MPS2
from edge.sources import open_source
from shared.errors import ConfigError, UserError

T = TypeVar("T")
MADE = datetime(2026, 5, 1, 12, 0, tzinfo=UTC)
SENSOR = SensorDescription("s", 200.0, 156.9, 34.9)
SEEDS = range(6)
X = np.array([1.0, 0.0, 0.0])


def gathered(step, batches):
    """The step with all of these in it; raises where it does not do."""
    take(step, (SensorBatch(batch) for batch in batches))
    return step


def solved(*steps) -> Calibration:
    return solve(steps, "u1", "s", MADE)


def known(part: T | None) -> T:
    assert part is not None
    return part


def test_the_gyroscope_s_bias_is_found_within_its_standard_deviation():
    off = []
    for seed in SEEDS:
        unit = HandledUnit(seed)
        step = gathered(StillStep(), [unit.rest(20.0)])
        found = known(solved(step).gyroscope)
        gyro = unit.imu._gyro
        up_s = np.array([0.0, 0.0, -GRAVITY_MPS2])
        true = gyro._bias - gyro._per_degc + gyro._per_force @ up_s  # at 24 degC, lying like this
        walked = gyro._errors.bias_walk * 20.0**0.5
        std = np.hypot(found.bias_std_radps, walked)
        off.append((np.array(found.bias_radps) - true) / std)
    assert np.abs(off).max() < 4.5
    assert np.sqrt(np.mean(np.square(off))) < 1.8


def test_what_force_adds_to_the_rate_is_found():
    off = []
    for seed in SEEDS:
        unit = HandledUnit(seed)
        found = known(
            solved(
                gathered(StillStep(), [unit.rest(14.0)]),
                gathered(PosesStep(), [*unit.poses(np.vstack((SIDES, EDGES))), unit.turn(X, 1.0)]),
            ).gyroscope
        )
        error = np.array(known(found.per_force)) - unit.imu._gyro._per_force
        off.append(error / known(found.per_force_std))
    assert np.sqrt(np.mean(np.square(off))) < 1.8


def test_the_accelerometer_is_found_within_its_standard_deviations():
    off = []
    for seed in SEEDS:
        unit = HandledUnit(seed)
        step = gathered(PosesStep(), [*unit.poses(np.vstack((SIDES, EDGES))), unit.turn(X, 1.0)])
        found = known(solved(step).accelerometer)
        accel = unit.imu._accel
        off.append(
            (np.array(found.bias_mps2) - (accel._bias - accel._per_degc)) / found.bias_std_mps2
        )
        # All but a rotation of the three axes together is undone.
        left = np.array(found.gain) @ accel._gain
        assert np.abs(left.T @ left - np.eye(3)).max() < 5.0 * np.max(found.gain_std)
        assert found.residual_mps2 < 0.005
    assert np.abs(off).max() < 4.0


def test_six_poses_give_scale_and_bias_and_no_misalignment():
    unit = HandledUnit(1)
    found = known(
        solved(gathered(PosesStep(), [*unit.poses(SIDES), unit.turn(X, 1.0)])).accelerometer
    )
    assert np.array(found.gain_std)[0, 1] == 0.0
    true = unit.imu._accel._bias - unit.imu._accel._per_degc
    assert (np.abs(found.bias_mps2 - true) < 3.0 * np.array(found.bias_std_mps2)).all()


def test_hard_and_soft_iron_are_found_within_their_standard_deviations():
    hard, soft = [], []
    for seed in SEEDS:
        unit = HandledUnit(seed)
        found = known(solved(gathered(TurningStep(), unit.turning(45))).magnetometer)
        hard.append((found.hard_iron_ut - unit.mag._hard_iron_ut) / found.hard_iron_std_ut)
        left = np.array(found.gain) @ unit.mag._soft_iron
        left /= np.cbrt(np.linalg.det(left))
        soft.append((left - np.eye(3)) / np.array(found.gain_std))
        assert found.field_ut == pytest.approx(51.2, rel=0.08)
    assert np.abs(hard).max() < 4.0
    assert np.abs(soft).max() < 5.0


def test_the_biases_slopes_with_temperature_are_found():
    off = []
    for seed in SEEDS:
        unit = HandledUnit(seed)
        found = known(solved(gathered(WarmUpStep(), unit.warm_up(400.0))).warmth)
        for slope, std, triad in (
            (found.accel_bias_per_degc_mps2, found.accel_std_mps2, unit.imu._accel),
            (found.gyro_bias_per_degc_radps, found.gyro_std_radps, unit.imu._gyro),
        ):
            off.append((np.array(slope) - triad._per_degc) / std)
        assert np.max(found.gyro_std_radps) < 0.5 * unit.imu._gyro._errors.bias_per_degc_std
    assert np.abs(off).max() < 5.0
    assert np.sqrt(np.mean(np.square(off))) < 1.8


def test_a_calibrated_unit_reads_true():
    unit = HandledUnit(4)
    calibration = solved(
        gathered(StillStep(), [unit.rest(20.0)]),
        gathered(PosesStep(), [*unit.poses(np.vstack((SIDES, EDGES))), unit.turn(X, 1.0)]),
        gathered(TurningStep(), unit.turning(45)),
        gathered(WarmUpStep(), unit.warm_up(400.0)),
    )
    (cold,) = unit.warm_up(1.0)
    before, after = cold, calibration.apply(cold, unit.description)
    gravity = np.linalg.norm(after.accel_mps2.mean(axis=0))
    assert gravity == pytest.approx(GRAVITY_MPS2, abs=0.01)
    rate = np.linalg.norm(after.gyro_radps.mean(axis=0))
    assert rate < 0.35 * np.linalg.norm(before.gyro_radps.mean(axis=0))
    field = np.linalg.norm(
        np.vstack([calibrated(calibration, b) for b in unit.turning(20)]), axis=1
    )
    assert np.nanstd(field) < 0.02 * np.nanmean(field)
    assert calibration.faults() == ()


def calibrated(calibration, batch):
    mag_ut = calibration.apply(batch, SENSOR).mag_ut
    assert mag_ut is not None
    return mag_ut


def refusal(step, batches) -> str:
    with pytest.raises(UserError) as caught:
        gathered(step, batches)
    return str(caught.value)


def test_a_unit_that_moved_is_refused_for_the_still_step():
    unit = HandledUnit(0)
    said = refusal(StillStep(), [unit.rest(6.0), unit.turn(X, 1.0), unit.rest(6.0)])
    assert "moved during the still step (last at 7.0 s)" in said
    assert "10 s are needed" in said


def test_a_unit_on_a_turntable_is_refused_for_the_still_step():
    batch = HandledUnit(0).rest(15.0)
    turning = replace(batch, gyro_radps=batch.gyro_radps + 0.3)
    assert "turned evenly" in refusal(StillStep(), [turning])


def test_missing_poses_are_named():
    unit = HandledUnit(0)
    said = refusal(PosesStep(), [*unit.poses(SIDES[[0, 2, 4]]), unit.turn(X, 1.0)])
    assert "only 3 of 6 poses: turn it until -x, -y and -z of the sensor points up" in said


@pytest.mark.parametrize(
    ("turns", "said"),
    [
        ([], "hardly turned"),
        ([6.0 * X], "about one axis only"),
        ([3.0 * X, 0.4 * X[[1, 0, 2]]], "about one axis only"),
    ],
)
def test_turning_that_does_not_determine_the_iron_is_refused(turns, said):
    unit = HandledUnit(0)
    batches = [unit.rest(3.0), *(unit.turn(turn, 6.0) for turn in turns)]
    assert said in refusal(TurningStep(), batches)


def test_half_a_sphere_is_refused():
    unit = HandledUnit(0)
    whole = gathered(TurningStep(), unit.turning(45)).fields_ut()
    half = whole[whole @ np.array([1.0, 1.0, 1.0]) > np.median(whole @ np.array([1.0, 1.0, 1.0]))]
    n = len(half)
    batch = ImuBatch(np.arange(n), np.zeros((n, 3)), np.zeros((n, 3)), mag_ut=half)
    assert "also upside down" in refusal(TurningStep(), [batch])


def test_a_magnet_is_not_taken_for_the_earth():
    unit = HandledUnit(0)
    batches = [
        replace(batch, mag_ut=None if batch.mag_ut is None else 4.0 * batch.mag_ut)
        for batch in unit.turning(45)
    ]
    assert "not the earth's" in refusal(TurningStep(), batches)


def test_a_unit_without_the_sensor_is_told_to_leave_the_step_out():
    batch = replace(HandledUnit(0).rest(30.0), mag_ut=None, imu_temperature_degc=None)
    assert "no magnetometer" in refusal(TurningStep(), [batch])
    assert "leave the warm-up out" in refusal(WarmUpStep(), [batch])


def test_a_field_that_changes_on_the_way_is_refused():
    unit = HandledUnit(0)
    rng = np.random.default_rng(1)
    batches = [
        replace(batch, mag_ut=known(batch.mag_ut) * rng.uniform(0.3, 1.7, (len(batch), 1)))
        for batch in unit.turning(45)
    ]
    for batch in batches:
        known(batch.mag_ut)[:] += rng.normal(0.0, 30.0, 3)
    step = gathered(TurningStep(), batches)
    with pytest.raises(UserError, match="do not lie on an ellipsoid"):
        solved(step)


def test_a_warm_up_needs_the_temperature_of_the_other_steps():
    unit = HandledUnit(0)
    still = gathered(StillStep(), [replace(unit.rest(14.0), imu_temperature_degc=None)])
    warm_up = gathered(WarmUpStep(), unit.warm_up(400.0))
    with pytest.raises(UserError, match="leave the warm-up out"):
        solved(still, warm_up)


def test_too_little_warmth_is_refused_with_the_figure():
    said = refusal(WarmUpStep(), HandledUnit(0).warm_up(100.0, from_degc=21.5))
    assert "changed by only 1.2 degC; 10 are needed" in said


def test_a_guided_step_ends_when_it_has_enough():
    unit = HandledUnit(0)
    batches = iter([SensorBatch(unit.rest(1.0)) for _ in range(60)])
    told: list[str] = []
    guide(StillStep(), batches, 600.0, told.append)
    assert 40 < len(list(batches)) < 50
    assert told[-1] == "10 of 10 s"


def test_a_guided_step_gives_up_after_its_time():
    unit = HandledUnit(0)
    with pytest.raises(UserError, match="only 1 of 6 poses"):
        guide(PosesStep(), (SensorBatch(unit.rest(1.0)) for _ in range(99)), 20.0, lambda _: None)


@pytest.fixture
def calibration() -> Calibration:
    return solved(gathered(StillStep(), [HandledUnit(2).rest(14.0)]))


def test_a_file_gives_back_the_calibration_and_its_identity(calibration, tmp_path):
    write_calibration(calibration, tmp_path / "c.toml")
    again = read_calibration(tmp_path / "c.toml")
    assert again == calibration
    assert identity(again) == identity(calibration)
    assert identity(calibration).startswith("20260501T120000Z-")
    other = msgspec.structs.replace(calibration, unit="u2")
    assert identity(other) != identity(calibration)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("unit = 1", "is damaged"),
        ("made = ", "is damaged"),
        ('unit = "u"\nsensor = "s"\nmade = 2026-01-01T00:00:00', "no time zone"),
        ('unit = "u"\nsensor = "s"\nmade = 2026-01-01T00:00:00Z\nbias = 1', "bias"),
    ],
)
def test_a_damaged_file_is_one_sentence(text, said, tmp_path):
    (tmp_path / "c.toml").write_text(text)
    with pytest.raises(ConfigError, match=said):
        read_calibration(tmp_path / "c.toml")


def test_a_file_that_is_not_there_is_one_sentence(tmp_path):
    with pytest.raises(ConfigError, match="check the path"):
        read_calibration(tmp_path / "none.toml")


def test_half_a_year_makes_it_old_and_residuals_make_it_poor(calibration):
    assert not calibration.is_old(MADE + timedelta(days=180))
    assert calibration.is_old(MADE + timedelta(days=181))
    gyroscope = msgspec.structs.replace(known(calibration.gyroscope), residual_radps=0.01)
    poor = msgspec.structs.replace(calibration, gyroscope=gyroscope)
    assert poor.faults() == ("gyroscope off by 0.573 deg/s",)


def test_a_reading_at_the_end_of_the_range_stays_there():
    gyroscope = Gyroscope(
        bias_radps=(0.5, 0.5, 0.5), bias_std_radps=(0.0, 0.0, 0.0), residual_radps=0.0
    )
    calibration = Calibration("u1", "s", MADE, gyroscope=gyroscope)
    batch = ImuBatch(np.arange(1), np.zeros((1, 3)), np.array([[34.9, -34.8, 1.0]]))
    rates = calibration.apply(batch, SENSOR).gyro_radps
    assert rates.tolist() == [[34.9, -34.8, 0.5]]


def test_a_whole_calibration_from_a_source_and_from_recordings(tmp_path, capsys):
    with closing(open_source("bench:7")) as unit:
        calibrate_guided(unit, tmp_path / "guided.toml", "u1", None, with_warm_up=True)
    guided = read_calibration(tmp_path / "guided.toml")
    assert guided.sensor == "simulated on a table"
    assert None not in (guided.accelerometer, guided.gyroscope, guided.magnetometer, guided.warmth)
    calibrate_recorded({"still": "bench:7"}, tmp_path / "recorded.toml", "u1", None)
    assert read_calibration(tmp_path / "recorded.toml").accelerometer is None
    said = capsys.readouterr().err
    assert "gyroscope bias" in said
    with pytest.raises(UserError, match="simulated:straight: the poses step cannot be used"):
        calibrate_recorded({"poses": "simulated:straight"}, tmp_path / "x.toml", "u1", None)
    assert not (tmp_path / "x.toml").exists()


def test_a_calibrated_magnetometer_says_what_is_left_and_what_it_showed_of_the_earth():
    unit = HandledUnit(0)
    step = gathered(TurningStep(), unit.turning(45))
    calibration = solved(step)
    described = calibration.described(SENSOR)
    found = known(calibration.magnetometer)
    assert described.mag_earth_ut == found.field_ut
    iron_std_ut = known(described.mag_iron_std_ut)
    assert found.residual_ut <= iron_std_ut < 2.0
    assert iron_std_ut > 0.0
    assert solved(gathered(StillStep(), [unit.rest(20.0)])).described(SENSOR) == SENSOR
