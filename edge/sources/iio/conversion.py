"""Conversion of raw values to the units of samples, in the axes of the hardware."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from edge.samples import Floats
from edge.sources.iio.attributes import UnusableDeviceError, find_attribute, read_shared_number
from edge.sources.sysfs import read_text
from shared.coded_text import coded

ACCEL, GYRO, MAG = "in_accel", "in_anglvel", "in_magn"  # kinds of channels with three axes
TEMPERATURE, PRESSURE, TIMESTAMP = "in_temp", "in_pressure", "in_timestamp"

UT_PER_GAUSS = 100.0  # the kernel gives a magnetic field in gauss

_AXES = 3
_ORTHONORMAL = 0.01  # of the products of its rows: a device tree gives some digits


def axes_of(kind: str) -> tuple[str, ...]:
    """Return the channels of three axes, such as ``in_accel_x``."""
    return tuple(f"{kind}_{axis}" for axis in "xyz")


@dataclass(frozen=True, slots=True, eq=False)
class Conversion:
    """Conversion of the values of three axes."""

    offset: Floats  # (3,) added before the scale
    scale: Floats  # (3,)
    mount: Floats  # (3, 3) from the sensor's axes to those of the hardware

    def apply(self, raw: Floats) -> Floats:
        """Return (n, 3) of (n, 3)."""
        return ((raw + self.offset) * self.scale) @ self.mount.T


def read_conversion(device: Path, kind: str) -> Conversion:
    """Raises OSError and UnusableDeviceError."""
    offset = [read_shared_number(device, axis, kind, "offset", 0.0) for axis in axes_of(kind)]
    scale = [read_shared_number(device, axis, kind, "scale", 1.0) for axis in axes_of(kind)]
    path = find_attribute(device, axes_of(kind)[0], kind, "mount_matrix")
    mount = np.eye(_AXES) if path is None else parse_mount_matrix(read_text(path))
    return Conversion(np.array(offset), np.array(scale), mount)


def parse_mount_matrix(text: str) -> Floats:
    """Return the rotation in ``1, 0, 0; 0, 1, 0; 0, 0, 1``.  Raises UnusableDeviceError."""
    try:
        matrix = np.array([[float(each) for each in row.split(",")] for row in text.split(";")])
        is_rotation = matrix.shape == (_AXES, _AXES) and (
            np.abs(matrix @ matrix.T - np.eye(_AXES)).max() < _ORTHONORMAL
            and np.linalg.det(matrix) > 0.0
        )
    except ValueError:
        is_rotation = False
    if not is_rotation:
        raise UnusableDeviceError(
            coded(
                "iio-mount-matrix",
                "its mount matrix is {text!r}, which is no rotation; correct mount-matrix in the "
                "device tree",
                text=text,
            )
        )
    return matrix
