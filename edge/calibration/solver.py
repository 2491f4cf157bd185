"""Solver: from the samples of the steps to the parts of a calibration."""

from __future__ import annotations

import numpy as np

from edge.calibration.model import Accelerometer, Gyroscope, Magnetometer, Matrix, Vector, Warmth
from edge.calibration.rest_detector import RestWindow, mean_of
from edge.calibration.sphere_fit import DIAGONAL, SYMMETRIC, TRIANGULAR, fit_sphere
from edge.samples import Floats

GRAVITY_MPS2 = 9.80665

_POSE_NOISE_MPS2 = 0.003  # of a pose's mean: what a table's tremble and slow noise leave
_MISALIGNED_MPS2 = 0.03  # what unknown misalignment does to the length
_FIELD_NOISE_SHARE = 0.002
_SURE = 5.0  # times a pose's noise: an angle between two axes that is known no better is not
_ENOUGH_POSES = 10
_NOISE_SHARE = 0.7  # what is not credited to noise counts as walk, the worse of the two
_BLOCK = 20  # windows that are averaged: slow noise makes neighbours alike


def solve_gyroscope(
    windows: list[RestWindow], poses: list[RestWindow], warmth: Warmth | None
) -> Gyroscope:
    """The bias of one rest; from ``poses``, if there are any, what force adds to it."""
    mean = mean_of(windows)
    rates = _at_one_warmth(windows, mean.temperature_degc, warmth)
    spread = rates.std(axis=0, ddof=1)
    per_force = per_force_std = None
    bias = rates.mean(axis=0)
    variance = spread**2 / len(rates)
    if poses:
        slope, std = _force_slope(poses, _at_one_warmth(poses, mean.temperature_degc, warmth))
        bias = bias - slope @ mean.accel_mps2
        variance = variance + std**2 @ mean.accel_mps2**2
        per_force, per_force_std = matrix(slope), matrix(std)
    return Gyroscope(
        bias_radps=vector(bias),
        bias_std_radps=vector(np.sqrt(variance)),
        per_force=per_force,
        per_force_std=per_force_std,
        at_degc=or_none(mean.temperature_degc),
        residual_radps=float(np.sqrt(np.mean(spread**2))),
    )


def _at_one_warmth(windows: list[RestWindow], at_degc: float, warmth: Warmth | None) -> Floats:
    """The rates (n, 3) as they would be at that temperature."""
    rates = np.array([window.gyro_radps for window in windows])
    if warmth is None:
        return rates
    degc = np.array([window.temperature_degc for window in windows]) - at_degc
    return np.asarray(rates - degc[:, None] * np.array(warmth.gyro_bias_per_degc_radps))


def _force_slope(poses: list[RestWindow], rates: Floats) -> tuple[Floats, Floats]:
    """Rate by force (3, 3) with standard deviations; at least six poses."""
    forces = np.array([pose.accel_mps2 for pose in poses])
    table = np.column_stack((forces, np.ones(len(forces))))
    inverse = np.linalg.inv(table.T @ table)
    solution = inverse @ table.T @ rates
    variance = ((rates - table @ solution) ** 2).sum(axis=0) / (len(poses) - 4)
    std = np.sqrt(np.outer(variance, np.diag(inverse)[:3]))
    return solution[:3].T, std


def observes_misalignment(directions: Floats) -> tuple[bool, bool, bool]:
    """Return True for each of the angles between axes x and y, x and z, y and z that the directions
    (n, 3) of the poses determine, beside scale and bias.
    """
    x, y, z = directions.T
    table = np.column_stack((x * y, x * z, y * z, directions**2, directions))
    # The second part: an angle that no pose observes gets a large variance, and the rest none.
    inverse = np.linalg.inv(table.T @ table + 1e-6 * np.eye(table.shape[1]))
    xy, xz, yz = (np.diag(inverse)[:3] < _SURE**2).tolist()
    return xy, xz, yz


def solve_accelerometer(poses: list[RestWindow], warmth: Warmth | None) -> Accelerometer:
    """Scale and bias, and misalignment too where the poses tell of it."""
    forces = np.array([pose.accel_mps2 for pose in poses])
    degc = np.array([pose.temperature_degc for pose in poses])
    at_degc = float(degc.mean())
    if warmth is not None:
        forces = forces - (degc - at_degc)[:, None] * np.array(warmth.accel_bias_per_degc_mps2)
    full = len(poses) >= _ENOUGH_POSES and all(
        observes_misalignment(forces / np.linalg.norm(forces, axis=1)[:, None])
    )
    fit = fit_sphere(
        forces / GRAVITY_MPS2,
        TRIANGULAR if full else DIAGONAL,
        np.eye(3),
        np.zeros(3),
        (_POSE_NOISE_MPS2 if full else _MISALIGNED_MPS2) / GRAVITY_MPS2,
    )
    return Accelerometer(
        gain=matrix(fit.gain),
        gain_std=matrix(fit.gain_std),
        bias_mps2=vector(fit.centre * GRAVITY_MPS2),
        bias_std_mps2=vector(fit.centre_std * GRAVITY_MPS2),
        at_degc=or_none(at_degc),
        poses=len(poses),
        residual_mps2=fit.residual * GRAVITY_MPS2,
    )


def solve_magnetometer(fields_ut: Floats) -> Magnetometer:
    """From readings (n, 3) of evenly many directions.  Raises LinAlgError for too few."""
    # A sphere is the start: |m|^2 = 2 c.m + (r^2 - |c|^2) is linear in c.
    scale_ut = float(np.linalg.norm(fields_ut, axis=1).max())
    scaled = fields_ut / scale_ut
    table = np.column_stack((2.0 * scaled, np.ones(len(scaled))))
    solution = np.linalg.lstsq(table, (scaled**2).sum(axis=1), rcond=None)[0]
    centre = solution[:3]
    radius = np.sqrt(max(float(solution[3] + centre @ centre), 1e-6))
    fit = fit_sphere(scaled, SYMMETRIC, np.eye(3) / radius, centre, _FIELD_NOISE_SHARE)
    # The length of the field is not known here; only the shape is a property of the unit.
    unit = float(np.cbrt(np.linalg.det(fit.gain)))
    field_ut = scale_ut / unit
    return Magnetometer(
        gain=matrix(fit.gain / unit),
        gain_std=matrix(fit.gain_std / unit),
        hard_iron_ut=vector(fit.centre * scale_ut),
        hard_iron_std_ut=vector(fit.centre_std * scale_ut),
        field_ut=field_ut,
        residual_ut=fit.residual * field_ut,
    )


def solve_warmth(windows: list[RestWindow]) -> Warmth:
    """Straight lines of both biases against temperature, of a unit that never moved."""
    count = len(windows) // _BLOCK
    used = windows[: count * _BLOCK]
    degc = np.array([window.temperature_degc for window in used])
    accel = _line(degc, np.array([window.accel_mps2 for window in used]))
    gyro = _line(degc, np.array([window.gyro_radps for window in used]))
    return Warmth(
        accel_bias_per_degc_mps2=accel[0],
        accel_std_mps2=accel[1],
        gyro_bias_per_degc_radps=gyro[0],
        gyro_std_radps=gyro[1],
        from_degc=float(degc.min()),
        to_degc=float(degc.max()),
        residual_mps2=accel[2],
        residual_radps=gyro[2],
    )


def _line(degc: Floats, values: Floats) -> tuple[Vector, Vector, float]:
    """Slope of windows (n, 3), its standard deviation, and the root mean square off the line.

    A bias walks by itself while the sensor warms, and that looks like a slope.  The size of its
    walk follows from the residuals beyond the noise, both by their expectation.
    """
    blocks = values.reshape(-1, _BLOCK, 3)
    count = len(blocks)
    block_degc = degc.reshape(-1, _BLOCK).mean(axis=1)
    warmth = block_degc - block_degc.mean()
    weights = warmth / (warmth @ warmth)
    means = blocks.mean(axis=1)
    slope = weights @ means
    rest = np.eye(count) - 1.0 / count - np.outer(warmth, weights)  # takes the line out
    off = rest @ means
    noise = blocks.var(axis=1, ddof=1).mean(axis=0) / _BLOCK
    path = np.tri(count)  # from the steps of a walk to the walk
    walk = ((off**2).sum(axis=0) - _NOISE_SHARE * noise * (count - 2)) / ((rest @ path) ** 2).sum()
    carried = weights @ path
    variance = noise * (weights @ weights) + np.maximum(walk, 0.0) * (carried @ carried)
    return vector(slope), vector(np.sqrt(variance)), float(np.sqrt(np.mean(off**2)))


def vector(values: Floats) -> Vector:
    x, y, z = values.tolist()
    return x, y, z


def matrix(values: Floats) -> Matrix:
    x, y, z = (vector(row) for row in values)
    return x, y, z


def or_none(value: float) -> float | None:
    return value if np.isfinite(value) else None
