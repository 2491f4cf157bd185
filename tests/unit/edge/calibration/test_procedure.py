"""Insufficient data of a calibration is refused, and the sentence states what is missing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from edge.calibration.procedure import run_step
from edge.calibration.rest_detector import RestDetector, mean_of
from edge.calibration.steps import PosesStep, StillStep, TurningStep, WarmUpStep
from edge.samples import ImuBatch, SensorBatch
from edge.simulation.handled_unit import SIDES, HandledUnit
from shared.errors import UserError
from tests.rig.calibration_steps import gathered, known, solved

X = np.array([1.0, 0.0, 0.0])


def refusal(step, batches) -> str:
    with pytest.raises(UserError) as caught:
        gathered(step, batches)
    return str(caught.value)


def test_unit_that_moved_is_refused_for_the_still_step():
    unit = HandledUnit(0)
    stated = refusal(StillStep(), [unit.rest(6.0), unit.turn(X, 1.0), unit.rest(6.0)])
    assert "moved during the still step (last at 7.0 s)" in stated
    assert "10 s are needed" in stated


def test_a_unit_that_has_only_not_lain_long_enough_is_not_stated_to_have_moved():
    stated = refusal(StillStep(), [HandledUnit(0).rest(6.0)])
    assert "lay still for only 5.0 s" in stated
    assert "10 s are needed" in stated
    assert "moved" not in stated


def test_a_unit_that_was_in_the_hand_to_begin_with_has_moved():
    unit = HandledUnit(0)
    stated = refusal(StillStep(), [unit.turn(X, 0.5), unit.rest(6.0)])
    assert "moved during the still step (last at 0.5 s)" in stated


def test_a_unit_on_a_turntable_is_refused_for_the_still_step():
    batch = HandledUnit(0).rest(15.0)
    turning = replace(batch, gyro_radps=batch.gyro_radps + 0.3)
    assert "turned evenly" in refusal(StillStep(), [turning])


def test_missing_poses_are_named():
    unit = HandledUnit(0)
    stated = refusal(PosesStep(), [*unit.poses(SIDES[[0, 2, 4]]), unit.turn(X, 1.0)])
    assert "only 3 of 6 poses: turn it until -x, -y and -z of the sensor points up" in stated


@pytest.mark.parametrize(
    ("turns", "stated"),
    [
        ([], "hardly turned"),
        ([6.0 * X], "about one axis only"),
        ([3.0 * X, 0.4 * X[[1, 0, 2]]], "about one axis only"),
    ],
)
def test_turning_that_does_not_determine_the_iron_is_refused(turns, stated):
    unit = HandledUnit(0)
    batches = [unit.rest(3.0), *(unit.turn(turn, 6.0) for turn in turns)]
    assert stated in refusal(TurningStep(), batches)


def test_half_a_sphere_is_refused():
    unit = HandledUnit(0)
    whole = gathered(TurningStep(), unit.turning(45)).fields_ut()
    half = whole[whole @ np.array([1.0, 1.0, 1.0]) > np.median(whole @ np.array([1.0, 1.0, 1.0]))]
    n = len(half)
    batch = ImuBatch(np.arange(n), np.zeros((n, 3)), np.zeros((n, 3)), mag_ut=half)
    assert "also upside down" in refusal(TurningStep(), [batch])


def test_magnet_is_not_taken_for_the_earths_field():
    unit = HandledUnit(0)
    batches = [
        replace(batch, mag_ut=None if batch.mag_ut is None else 4.0 * batch.mag_ut)
        for batch in unit.turning(45)
    ]
    assert "not the earth's" in refusal(TurningStep(), batches)


def test_a_unit_without_the_sensor_is_ordered_to_leave_the_step_out():
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


def test_a_warm_up_by_itself_says_nothing_that_could_be_used():
    """Its slopes would be in the file, and taken out of no sample."""
    unit = HandledUnit(0)
    warm_up = gathered(WarmUpStep(), unit.warm_up(400.0))
    with pytest.raises(UserError, match="give it with the still and poses steps"):
        solved(warm_up)
    with pytest.raises(UserError, match="give it with the still and poses steps"):
        solved(gathered(TurningStep(), unit.turning(45)), warm_up)


def test_too_little_warmth_is_refused_with_the_figure():
    stated = refusal(WarmUpStep(), HandledUnit(0).warm_up(100.0, from_degc=21.5))
    assert "changed by only 1.2 degC; 10 are needed" in stated


def test_a_guided_step_ends_when_it_has_enough():
    unit = HandledUnit(0)
    since_ns = 10**13  # its clock has run for hours
    rests = (unit.rest(1.0) for _ in range(60))
    batches = iter([SensorBatch(replace(one, t_ns=one.t_ns + since_ns)) for one in rests])
    reported: list[str] = []
    run_step(StillStep(), batches, 600.0, reported.append)
    assert 40 < len(list(batches)) < 50
    assert reported[-1] == "10 of 10 s"
    assert not any("moved" in line for line in reported), "nobody has touched it"


def test_a_guided_step_gives_up_after_its_time():
    unit = HandledUnit(0)
    batches = iter([SensorBatch(unit.rest(1.0)) for _ in range(99)])
    with pytest.raises(UserError, match="only 1 of 6 poses"):
        run_step(PosesStep(), batches, 20.0, lambda _: None)
    assert len(list(batches)) > 70


def felt(duration_s: float, start_s: float, accel_mps2: float, gyro_radps: float) -> ImuBatch:
    """A unit on its back that trembles by so much about one axis of each sensor."""
    count = round(duration_s * 100)
    tremble = np.where(np.arange(count) % 2, 1.0, -1.0)[:, None] * [1.0, 0.0, 0.0]
    return ImuBatch(
        np.arange(count) * 10_000_000 + round(start_s * 1e9),
        accel_mps2 * tremble + [0.0, 0.0, 9.81],
        gyro_radps * tremble,
    )


@pytest.mark.parametrize(
    ("accel_mps2", "gyro_radps", "rests"),
    [(0.15, 0.02, True), (0.3, 0.0, False), (0.0, 0.05, False)],
    ids=["noise", "shaken", "turned to and fro"],
)
def test_motion_of_either_sensor_is_no_rest(accel_mps2, gyro_radps, rests):
    finder = RestDetector()
    finder.push(felt(5.0, 0.0, accel_mps2, gyro_radps))
    assert bool(finder.rests) is rests


def test_missing_samples_end_a_rest():
    """The sensor was silent for two seconds: the unit may have been taken up and laid down."""
    finder = RestDetector()
    silent = felt(2.0, 5.0, 0.0, 0.0)
    silent.accel_mps2[:] = np.nan
    for part in (felt(5.0, 0.0, 0.0, 0.0), silent, felt(5.0, 7.0, 0.0, 0.0)):
        finder.push(part)
    assert [len(rest) for rest in finder.rests] == [9, 9]


@pytest.mark.parametrize("next_s", [7.0, -3.0], ids=["lost", "set back"])
def test_samples_that_never_came_end_a_rest_too(next_s):
    finder = RestDetector()
    for part in (felt(5.0, 0.0, 0.0, 0.0), felt(5.0, next_s, 0.0, 0.0)):
        finder.push(part)
    assert [len(rest) for rest in finder.rests] == [9, 9]


def test_two_short_rests_with_a_hole_between_them_are_not_a_long_one():
    """Nobody knows whether it was touched meanwhile: on the air, batches are lost."""
    unit = HandledUnit(0)
    before, _, after = unit.rest(6.0), unit.turn(X, 1.0), unit.rest(6.0)
    after = replace(after, accel_mps2=before.accel_mps2, gyro_radps=before.gyro_radps)
    assert "lay still for only 5.5 s" in refusal(StillStep(), [before, after])


def test_a_temperature_that_is_reported_now_and_then_is_that_of_the_window():
    """Most sensors measure it more seldom than they measure motion."""
    finder = RestDetector()
    rest = felt(3.0, 0.0, 0.0, 0.0)
    degc = np.full(len(rest), np.nan)
    degc[::10] = 21.5
    finder.push(replace(rest, imu_temperature_degc=degc))
    (windows,) = finder.rests
    assert [window.temperature_degc for window in windows] == [21.5] * 4


def test_a_temperature_that_is_reported_more_seldom_than_that_holds():
    finder = RestDetector()
    rest = felt(4.0, 0.0, 0.0, 0.0)
    degc = np.full(len(rest), np.nan)
    degc[60], degc[260] = 21.0, 22.0
    finder.push(replace(rest, imu_temperature_degc=degc))
    (windows,) = finder.rests
    assert [window.temperature_degc for window in windows] == [21.0] * 4 + [22.0] * 2


def test_one_reading_of_a_temperature_that_is_wrong_moves_no_window():
    finder = RestDetector()
    rest = felt(3.0, 0.0, 0.0, 0.0)
    degc = np.full(len(rest), 21.5)
    degc[60], degc[120] = -128.0, 150.0
    finder.push(replace(rest, imu_temperature_degc=degc))
    (windows,) = finder.rests
    assert {window.temperature_degc for window in windows} == {21.5}
    misread = [replace(window) for window in windows]
    misread[1] = replace(misread[1], temperature_degc=-40.0)
    assert mean_of(misread).temperature_degc == 21.5


def test_samples_of_other_units_are_no_calibration():
    """A source that takes the full scale for twice what it is."""
    unit = HandledUnit(0)
    poses = [*unit.poses(SIDES), unit.turn(X, 1.0)]
    doubled = [replace(batch, accel_mps2=2.0 * batch.accel_mps2) for batch in poses]
    step = gathered(PosesStep(), doubled)
    with pytest.raises(UserError, match=r"accelerometer\.gain is off by more than 0\.3, which no"):
        solved(step)


def test_unchecked_readings_in_one_plane_are_refused_with_a_reason():
    angle = np.linspace(0.0, 6.2, 200)
    level = 48.0 * np.column_stack((np.cos(angle), np.sin(angle), np.zeros(200)))
    none = np.zeros((200, 3))
    step = TurningStep()
    step.push(ImuBatch(np.arange(200), none, none, mag_ut=level))
    with pytest.raises(UserError, match="do not lie on an ellipsoid"):
        solved(step)
