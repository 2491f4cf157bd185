"""Report of a calibration, for the person who made it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from edge.calibration.file import identity
from edge.calibration.model import Calibration


def print_report(calibration: Calibration, out: Path, console: Console) -> None:
    """Print values with their standard deviations, residuals, and what could be better."""
    console.print(_table(calibration))
    for remark in (*_residuals(calibration), *_advice(calibration)):
        console.print(remark)
    console.print(
        f"Written to {out}; use it with `muster edge run --calibration {out}`.",
        markup=False,  # a path may have brackets in it
        soft_wrap=True,  # and is to be copied whole
    )


def _table(calibration: Calibration) -> Table:
    table = Table("", "x", "y", "z", "in", title=f"Calibration {identity(calibration)}")

    def row(name: str, values: object, stds: object, unit: str, decimals: int) -> None:
        cells = (
            f"{value:+.{decimals}f} ± {std:.{decimals}f}"
            for value, std in zip(np.ravel(values), np.ravel(stds), strict=True)  # type: ignore[call-overload]
        )
        table.add_row(name, *cells, unit)

    if accel := calibration.accelerometer:
        scale = 1e3 * (np.diag(accel.gain) - 1.0)
        row("accelerometer scale", scale, 1e3 * np.diag(accel.gain_std), "1/1000", 2)
        upper = np.array(accel.gain)[[0, 0, 1], [1, 2, 2]]
        upper_std = np.array(accel.gain_std)[[0, 0, 1], [1, 2, 2]]
        if upper_std.any():
            row("... misaligned xy, xz, yz", np.degrees(upper), np.degrees(upper_std), "deg", 3)
        row("... bias", accel.bias_mps2, accel.bias_std_mps2, "m/s2", 4)
    if gyro := calibration.gyroscope:
        row(
            "gyroscope bias", np.degrees(gyro.bias_radps), np.degrees(gyro.bias_std_radps),
            "deg/s", 4,
        )  # fmt: skip
    if gyro is not None and gyro.per_force is not None and gyro.per_force_std is not None:
        for axis, values, stds in zip("xyz", gyro.per_force, gyro.per_force_std, strict=True):
            scale = 1e3 * np.degrees(1.0)
            row(
                f"... {axis} by force", scale * np.array(values), scale * np.array(stds),
                "mdeg/s by m/s2", 2,
            )  # fmt: skip
    if mag := calibration.magnetometer:
        row("hard iron", mag.hard_iron_ut, mag.hard_iron_std_ut, "uT", 2)
        row("soft iron", np.diag(mag.gain), np.diag(mag.gain_std), "gain", 4)
    if warmth := calibration.warmth:
        slope, std = np.array(warmth.accel_bias_per_degc_mps2), np.array(warmth.accel_std_mps2)
        row("accelerometer by warmth", 1e3 * slope, 1e3 * std, "mm/s2/degC", 2)
        slope, std = np.array(warmth.gyro_bias_per_degc_radps), np.array(warmth.gyro_std_radps)
        row("gyroscope by warmth", 1e3 * np.degrees(slope), 1e3 * np.degrees(std), "mdeg/s/degC", 2)
    return table


def _residuals(calibration: Calibration) -> list[str]:
    residuals = []
    if accel := calibration.accelerometer:
        off = f"{accel.residual_mps2:.4f} m/s2" if accel.is_checked else "unknown"
        residuals.append(f"accelerometer {off} over {accel.poses} poses")
    if gyro := calibration.gyroscope:
        residuals.append(f"gyroscope {np.degrees(gyro.residual_radps):.4f} deg/s")
    if mag := calibration.magnetometer:
        residuals.append(f"magnetometer {mag.residual_ut:.2f} of {mag.field_ut:.1f} uT")
    return [f"Residuals: {'; '.join(residuals)}."] if residuals else []


def _advice(calibration: Calibration) -> list[str]:
    advice = [f"[bold]Poor:[/] {fault}; do it again." for fault in calibration.faults()]
    accel = calibration.accelerometer
    if accel is not None and not np.array(accel.gain_std)[0, 1]:
        advice.append("Misalignment is not determined: lean the unit on its edges as well.")
    return advice
