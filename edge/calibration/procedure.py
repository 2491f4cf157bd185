"""Procedure of a calibration: samples through the steps, then the solution."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from datetime import datetime
from math import isfinite

from numpy.linalg import LinAlgError

from edge.calibration.model import Calibration, Magnetometer
from edge.calibration.solver import (
    solve_accelerometer,
    solve_gyroscope,
    solve_magnetometer,
    solve_warmth,
)
from edge.calibration.steps import PosesStep, Step, StillStep, TurningStep, WarmUpStep
from edge.samples import SensorBatch
from shared.clock import NS_PER_S
from shared.errors import UserError

_PROGRESS_NS = NS_PER_S // 2
_OFF_SPHERE = 0.1  # of the field: no unit turned in one place is so far off
_HARD_IRON_STD_UT = 3.0  # 5 degrees of heading where the field is flat


def run_step(
    step: Step,
    batches: Iterator[SensorBatch],
    limit_s: float,
    report_progress: Callable[[str], None],
) -> None:
    """Take samples until the step has enough, or for ``limit_s`` of their time.

    ``report_progress`` gets the progress twice a second.  Raises UserError where the samples do not
    determine the step.
    """
    begin_ns: int | None = None
    reported_ns = 0
    for batch in batches:
        if not len(batch.imu):
            continue
        step.push(batch.imu)
        t_ns = int(batch.imu.t_ns[-1])
        if begin_ns is None:
            begin_ns = reported_ns = t_ns
        if t_ns - reported_ns < _PROGRESS_NS:
            continue
        reported_ns = t_ns
        wanted = step.wanted()
        report_progress(step.progress() if wanted is None else f"{step.progress()}: {wanted}")
        if wanted is None:
            return
        if t_ns - begin_ns > limit_s * NS_PER_S:
            break
    check(step)


def take(step: Step, batches: Iterator[SensorBatch]) -> None:
    """Take a whole recording of one step; raises UserError where it does not do."""
    for batch in batches:
        if len(batch.imu):
            step.push(batch.imu)
    check(step)


def check(step: Step) -> None:
    missing = step.missing()
    if missing is not None:
        raise UserError(f"the {step.name} step cannot be used: {missing}")


def solve(steps: Sequence[Step], unit: str, sensor: str, made: datetime) -> Calibration:
    """The calibration that complete steps determine; raises UserError where they do not fit."""
    warm_up = next((step for step in steps if isinstance(step, WarmUpStep)), None)
    warmth = None if warm_up is None else solve_warmth(warm_up.windows())
    poses_step = next((step for step in steps if isinstance(step, PosesStep)), None)
    poses = [] if poses_step is None else poses_step.poses()
    still = next((step for step in steps if isinstance(step, StillStep)), None)
    windows = [] if still is None else still.windows()
    if warmth is not None and not (windows or poses):
        raise UserError(
            "the warm-up says how the biases follow the temperature, and not what they are: give "
            "it with the still and poses steps"
        )
    if warmth is not None and not all(
        isfinite(window.temperature_degc) for window in (*windows, *poses)
    ):
        raise UserError(
            "the still and poses recordings do not tell the sensor's temperature, without which "
            "the warm-up is of no use: record it with them, or leave the warm-up out"
        )
    accelerometer = gyroscope = magnetometer = None
    for step in steps:
        match step:
            case StillStep():
                gyroscope = solve_gyroscope(windows, poses, warmth)
            case PosesStep():
                accelerometer = solve_accelerometer(poses, warmth)
            case TurningStep():
                magnetometer = _magnetometer(step)
    found = Calibration(
        unit=unit,
        sensor=sensor,
        made=made,
        accelerometer=accelerometer,
        gyroscope=gyroscope,
        magnetometer=magnetometer,
        warmth=warmth,
    )
    impossible = found.impossible()
    if impossible is not None:
        raise UserError(
            f"{impossible}, which no sensor that is whole is: are the units and the full scales of "
            "its samples right?"
        )
    return found


def _magnetometer(step: TurningStep) -> Magnetometer:
    try:
        found = solve_magnetometer(step.fields_ut())
    except LinAlgError:
        found = None
    if (
        found is None
        or not max(found.hard_iron_std_ut) < _HARD_IRON_STD_UT
        or found.residual_ut > _OFF_SPHERE * found.field_ut
    ):
        raise UserError(
            "the turning step cannot be used: its readings do not lie on an ellipsoid; turn the "
            "unit away from steel, about all of its axes, and begin again"
        )
    return found
