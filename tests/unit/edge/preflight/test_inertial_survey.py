"""Weaknesses of an inertial sensor are found, and a healthy sensor has none."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from edge.preflight.finding import CheckFinding, Severity, worst
from edge.preflight.inertial_survey import InertialSurvey
from edge.samples import ImuBatch, SensorDescription
from edge.simulation.handled_unit import HandledUnit

Change = Callable[[ImuBatch], ImuBatch]


def survey(change: Change = lambda imu: imu, **sensor: Any) -> dict[str, CheckFinding]:
    unit = HandledUnit(3)
    found = InertialSurvey(replace(unit.description, **sensor))
    imu = change(unit.rest(6.0))
    for first in range(0, len(imu), 37):
        found.push(imu.part(slice(first, first + 37)))
    return {finding.subject: finding for finding in found.findings()}


def every(step: int) -> Change:
    return lambda imu: imu.part(slice(None, None, step))


def without(first: int, last: int) -> Change:
    def cut(imu: ImuBatch) -> ImuBatch:
        rows = np.r_[0:first, last : len(imu)]
        return replace(
            imu, t_ns=imu.t_ns[rows], accel_mps2=imu.accel_mps2[rows],
            gyro_radps=imu.gyro_radps[rows], mag_ut=None, imu_temperature_degc=None,
        )  # fmt: skip

    return cut


def repeated(imu: ImuBatch) -> ImuBatch:
    return replace(
        imu,
        accel_mps2=np.repeat(imu.accel_mps2[:1], len(imu), axis=0),
        gyro_radps=np.repeat(imu.gyro_radps[:1], len(imu), axis=0),
    )


def test_a_sensor_that_is_well_is_ok() -> None:
    found = survey()
    assert worst(found.values()) is Severity.OK, found
    assert {"sample rate", "accelerometer", "gyroscope", "magnetic field"} <= set(found)
    assert not any(finding.remedy for finding in found.values())


@pytest.mark.parametrize(
    ("change", "subject", "level"),
    [
        (every(5), "sample rate", Severity.FAILED),
        (every(2), "sample rate", Severity.WARNING),
        (without(500, 530), "sample rate", Severity.WARNING),
        (without(500, 600), "sample rate", Severity.WARNING),
        (
            lambda imu: replace(imu, accel_mps2=1.1 * imu.accel_mps2),
            "accelerometer",
            Severity.FAILED,
        ),
        (lambda imu: replace(imu, gyro_radps=imu.gyro_radps + 0.2), "gyroscope", Severity.FAILED),
        (lambda imu: replace(imu, mag_ut=imu.mag_ut * 9.0), "magnetic field", Severity.WARNING),
        (lambda imu: replace(imu, mag_ut=imu.mag_ut * np.nan), "magnetic field", Severity.WARNING),
        (
            lambda imu: replace(imu, pressure_pa=np.zeros(len(imu))),
            "air pressure",
            Severity.WARNING,
        ),
        (repeated, "inertial sensor", Severity.FAILED),
        (
            lambda imu: replace(imu, accel_mps2=imu.accel_mps2 * np.nan),
            "inertial sensor",
            Severity.FAILED,
        ),
        (
            lambda imu: replace(
                imu, gyro_radps=imu.gyro_radps + np.sin(imu.t_ns * 2e-8)[:, np.newaxis]
            ),
            "rest",
            Severity.WARNING,
        ),
    ],
)
def test_a_weakness_is_found_and_says_what_to_do(
    change: Change, subject: str, level: Severity
) -> None:
    found = survey(change)
    assert found[subject].level is level, found
    assert found[subject].remedy or level is Severity.FAILED


def test_a_range_that_steps_go_beyond_is_a_warning() -> None:
    assert survey(accel_full_scale_mps2=39.2)["measuring range"].level is Severity.WARNING
    assert "measuring range" not in survey(accel_full_scale_mps2=None)  # nobody states it


def test_a_source_that_gives_nothing_has_failed() -> None:
    (finding,) = InertialSurvey(SensorDescription("silent", 100.0)).findings()
    assert finding.level is Severity.FAILED
    assert finding.text == "silent gave no samples"
