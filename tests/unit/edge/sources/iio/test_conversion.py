"""Raw values to units and axes of the hardware."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from edge.sources.iio.attributes import UnusableDeviceError, read_scaled
from edge.sources.iio.conversion import ACCEL, GYRO, PRESSURE, parse_mount_matrix, read_conversion
from tests.rig.kernel_devices import SysfsTree

RAW = np.array([[100.0, 200.0, 300.0]])


@pytest.fixture
def tree(tmp_path: Path) -> SysfsTree:
    return SysfsTree(tmp_path / "sys")


def test_the_offset_is_added_before_the_scale(tree: SysfsTree) -> None:
    device = tree.iio(0, in_accel_scale="0.01", in_accel_offset="-100")
    assert read_conversion(device, ACCEL).apply(RAW) == pytest.approx(np.array([[0.0, 1.0, 2.0]]))


def test_a_scale_of_one_axis_goes_before_that_of_all(tree: SysfsTree) -> None:
    device = tree.iio(0, in_accel_scale="0.01", in_accel_y_scale="0.1", in_accel_z_offset="100")
    assert read_conversion(device, ACCEL).apply(RAW) == pytest.approx(np.array([[1.0, 20.0, 4.0]]))


@pytest.mark.parametrize("attribute", ["in_accel_mount_matrix", "in_mount_matrix", "mount_matrix"])
def test_a_mount_matrix_turns_the_sensor_s_axes_into_the_hardware_s(tree, attribute) -> None:
    """By the kernel's documentation it is multiplied with the reading of the sensor."""
    device = tree.iio(0, in_accel_scale="0.01", **{attribute: "0, 1, 0; -1, 0, 0; 0, 0, 1"})
    assert read_conversion(device, ACCEL).apply(RAW) == pytest.approx(np.array([[2.0, -1.0, 3.0]]))


def test_a_matrix_of_one_kind_is_not_another_one_s(tree: SysfsTree) -> None:
    device = tree.iio(0, in_accel_mount_matrix="0, 1, 0; -1, 0, 0; 0, 0, 1")
    assert read_conversion(device, GYRO).apply(RAW) == pytest.approx(RAW)


@pytest.mark.parametrize(
    "text",
    [
        "0, 0, 0; 0, 0, 0; 0, 0, 0",
        "1, 0, 0; 0, 1, 0; 0, 0, -1",  # a mirror: rotations would turn the other way
        "2, 0, 0; 0, 2, 0; 0, 0, 2",
        "1, 0, 0; 0, 1, 0",
        "1, 0, 0; 0, 1; 0, 0, 1",
        "1, 0, 0; 0, 1, 0; 0, 0, x",
        "nan, 0, 0; 0, 1, 0; 0, 0, 1",
        "",
    ],
)
def test_matrix_that_is_no_rotation_is_refused(text: str) -> None:
    with pytest.raises(UnusableDeviceError, match="no rotation"):
        parse_mount_matrix(text)


def test_a_scale_that_is_no_number_is_named(tree: SysfsTree) -> None:
    with pytest.raises(UnusableDeviceError, match="in_accel_scale is 'much'"):
        read_conversion(tree.iio(0, in_accel_scale="much"), ACCEL)


def test_a_processed_value_needs_no_scale(tree: SysfsTree) -> None:
    device = tree.iio(0, in_pressure_input="101.325", in_pressure_scale="7")
    assert read_scaled(device, PRESSURE, PRESSURE) == pytest.approx(101.325)


def test_a_sign_that_the_driver_leaves_out_is_put_back(tree: SysfsTree) -> None:
    device = tree.iio(0, in_temp_raw="65535", in_temp_scale="62.5")
    assert read_scaled(device, "in_temp", "in_temp", signed_bits=16) == pytest.approx(-62.5)
