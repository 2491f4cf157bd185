"""A source of Industrial I/O with emulated devices: its data and its faults."""

from __future__ import annotations

import errno
import os
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from edge.samples import ElectronicsSample, Floats
from edge.sources.iio import buffer, captured_mag
from edge.sources.iio.source import IioSource
from tests.rig.iio_device import (
    BMI160,
    ICM_ACCEL,
    ICM_GYRO,
    MPU9250,
    EmulatedIio,
    Model,
    without_buffer,
)
from tests.rig.kernel_devices import SysfsTree, break_attribute, write_attributes
from tests.rig.taken_batches import TakenBatches
from tests.rig.waiting import until

ENOUGH = 60


@pytest.fixture
def tree(tmp_path: Path) -> SysfsTree:
    return SysfsTree(tmp_path / "sys")


@pytest.fixture
def plug(tree: SysfsTree, tmp_path: Path) -> Iterator[Callable[..., EmulatedIio]]:
    devices: list[EmulatedIio] = []

    def plugged(model: Model = BMI160, number: int = 0, **options) -> EmulatedIio:
        devices.append(EmulatedIio(tree, tmp_path / "dev", model, number, **options))
        return devices[-1]

    yield plugged
    for device in devices:
        device.close()


@pytest.fixture
def start(tree: SysfsTree, tmp_path: Path) -> Iterator[Callable[[str], TakenBatches]]:
    started: list[TakenBatches] = []

    def taken(text: str) -> TakenBatches:
        started.append(TakenBatches(IioSource(text, sysfs=tree.root, devices=tmp_path / "dev")))
        return started[-1]

    yield taken
    for one in started:
        one.close()


def test_device_with_accelerometer_and_gyroscope_is_read(plug, start) -> None:
    device = plug()
    with start("bmi160") as taken:
        until(lambda: len(taken) > ENOUGH, "samples")
        assert device.value("buffer/enable") == "1"
    assert device.value("buffer/enable") == "0", "the buffer is off once nobody reads it"
    assert device.value("current_timestamp_clock") == "monotonic"
    assert device.value("in_accel_sampling_frequency") == "400"
    assert (device.value("buffer/length"), device.value("buffer/watermark")) == ("1024", "20")
    accel, gyro = taken.column("accel_mps2"), taken.column("gyro_radps")
    assert np.linalg.norm(accel, axis=1) == pytest.approx(9.81, abs=0.1)
    assert gyro[0] == pytest.approx(0.001065 * np.array([1, -2, 3]), abs=0.006)
    times_ns = taken.column("t_ns")
    assert np.diff(times_ns) == pytest.approx(2_500_000, abs=10)
    assert 0 <= time.monotonic_ns() - times_ns[-1] < 60e9
    assert not taken.faults()


def test_two_devices_on_one_timeline(plug, start) -> None:
    plug(ICM_ACCEL, address="i2c-1/1-0068")
    plug(ICM_GYRO, number=1, address="i2c-1/1-0068")
    with start("icm42688-accel+icm42688-gyro@1-0068") as taken:
        until(lambda: len(taken) > ENOUGH, "samples")
    assert np.diff(taken.column("t_ns")) == pytest.approx(5_000_000, abs=10)
    assert np.linalg.norm(taken.column("accel_mps2"), axis=1) == pytest.approx(9.81, abs=0.1)
    assert np.isfinite(taken.column("gyro_radps")).all()
    assert taken.column("imu_temperature_degc") == pytest.approx(25.0, abs=0.1)
    assert isinstance(taken.others[0], ElectronicsSample)
    assert not taken.faults()


def test_magnetometer_and_barometer_beside_it(tree, plug, start) -> None:
    plug()
    mag = tree.iio(
        *(3, "1-001e"), name="lis3mdl", in_magn_scale="0.000146",
        in_magn_x_raw="1370", in_magn_y_raw="0", in_magn_z_raw="-2740",
        in_magn_mount_matrix="0, 1, 0; -1, 0, 0; 0, 0, 1",
    )  # fmt: skip
    tree.iio(
        4, "1-005d", name="lps22hb", in_pressure_raw="4150272", in_pressure_scale="0.000024414"
    )
    with start("bmi160?mag=lis3mdl&pressure=lps22hb@1-005d") as taken:

        def seen(name: str) -> Floats:
            column: Floats = taken.column(name)
            known: Floats = column[np.isfinite(column)]
            return known

        until(lambda: taken.batches and len(seen("pressure_pa")), "a pressure")
        until(lambda: len(seen("mag_ut")), "a field")
        assert taken.column("mag_ut").shape == (len(taken.column("t_ns")), 3)
        assert seen("mag_ut")[:3] == pytest.approx([0.0, -20.0, -40.0], abs=0.01)
        assert seen("pressure_pa") == pytest.approx([101_325], abs=1)
        write_attributes(mag, {"in_magn_x_raw": "2740"})
        until(lambda: seen("mag_ut")[4:5] == pytest.approx([-40.0], abs=0.01), "another field")
    assert not taken.faults()


def fields_ut(taken: TakenBatches) -> Floats:
    column: Floats = taken.column("mag_ut")
    known: Floats = column[np.isfinite(column[:, 0])]
    return known


def turning_field(k: int) -> tuple[int, ...]:
    """A field that is measured each tenth sample, of a foot that lies still."""
    return (*MPU9250.rest[:6], 0, 133 + k // 10 % 3, -267)


@pytest.mark.parametrize("text", ["mpu9250", "mpu9250?mag=mpu9250"])
def test_a_magnetometer_in_the_same_device_is_captured_with_it(plug, start, text) -> None:
    plug(MPU9250, values=turning_field)
    with start(text) as taken:
        until(lambda: len(taken) > 10 * ENOUGH, "samples")
    assert np.linalg.norm(taken.column("accel_mps2"), axis=1) == pytest.approx(9.8, abs=0.1)
    assert fields_ut(taken)[0] == pytest.approx([19.95, 0.0, 40.05], abs=0.01)
    column = taken.column("mag_ut")
    at = np.flatnonzero(np.isfinite(column[:, 0]))
    assert (np.diff(at) >= 20).all(), "each tenth sample of 500 a second is more than is of use"
    assert len(at) > len(column) / 40
    assert not taken.faults()


def test_one_field_in_all_frames_is_one_measurement_and_at_last_a_fault(
    plug, start, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(captured_mag, "STUCK_NS", 10**9)
    plug(MPU9250, values=lambda _: MPU9250.rest)
    with start("mpu9250") as taken:
        until(lambda: "its magnetometer has repeated one value" in taken.faults(), "the fault")
        assert len(fields_ut(taken)) == 1


def test_a_magnetometer_in_one_of_two_devices(plug, start) -> None:
    plug(MPU9250, values=turning_field)
    plug(ICM_GYRO, number=1)
    with start("mpu9250+icm42688-gyro") as taken:
        until(lambda: len(taken) > ENOUGH and len(fields_ut(taken)) > 1, "a field")
    assert np.isfinite(taken.column("gyro_radps")).all()
    assert not taken.faults()


def test_a_magnetometer_in_a_device_that_is_polled(tree, start) -> None:
    device = without_buffer(tree, MPU9250)
    with start("mpu9250") as taken:
        until(lambda: len(taken) > ENOUGH and len(fields_ut(taken)), "a field")
        write_attributes(device, {"in_magn_y_raw": "200"})
        until(lambda: fields_ut(taken)[-1][0] == pytest.approx(30.0), "another field")
    assert not taken.faults()


def test_a_magnetometer_that_is_not_captured_is_stated(plug, start) -> None:
    device = plug(MPU9250)
    for axis in "xyz":
        (device.path / "scan_elements" / f"in_magn_{axis}_en").unlink()
    with start("mpu9250") as taken:
        until(lambda: "does not capture its magnetometer" in taken.faults(), "the remark")


def test_a_magnetometer_that_was_asked_of_a_device_without_one_is_stated(plug, start) -> None:
    plug()
    with start("bmi160?mag=bmi160") as taken:
        until(lambda: len(taken) > ENOUGH, "samples")
        until(lambda: "it has no magnetometer" in taken.faults(), "the remark")


def test_a_magnetometer_that_was_not_known_at_the_start_is_stated(plug, start) -> None:
    with start("mpu9250?rate=200") as taken:
        until(lambda: "there is no IIO device" in taken.faults(), "that it is missing")
        plug(MPU9250, values=turning_field)
        until(lambda: len(taken) > ENOUGH, "samples")
        until(lambda: "was taken for one without" in taken.faults(), "the remark")


def test_a_device_that_appears_later_is_read(plug, start) -> None:
    with start("bmi160?rate=200") as taken:
        missing = "there is no IIO device named bmi160; there is none at all"
        until(lambda: missing in taken.faults(), missing)
        plug()
        until(lambda: len(taken) > ENOUGH, "samples")
    assert taken.faults().count("\n") == 0, "once"


def test_a_device_that_is_removed_and_comes_back(plug, start) -> None:
    device = plug()
    with start("bmi160") as taken:
        until(lambda: len(taken) > ENOUGH, "samples")
        device.detach()
        until(lambda: "there is no IIO device named bmi160" in taken.faults(), "that it is gone")
        assert "no samples: it was removed" in taken.faults()
        before = len(taken)
        device.attach()
        until(lambda: len(taken) > before + ENOUGH, "samples again")
    times_ns = taken.column("t_ns")
    assert (np.diff(times_ns) > 0).all()
    assert np.diff(times_ns).max() > 100e6, "the hole is not filled"
    assert np.isfinite(taken.column("accel_mps2")).all()


def test_a_bus_that_fails_is_distinguished(plug, start) -> None:
    device = plug()
    with start("bmi160") as taken:
        until(lambda: len(taken) > ENOUGH, "samples")
        device.fail()
        until(lambda: "it does not answer (input/output error)" in taken.faults(), "the error")
        device.attach()
        before = len(taken)
        until(lambda: len(taken) > before + ENOUGH, "samples again")


@pytest.mark.parametrize(
    ("number", "reported"), [(errno.EACCES, "60-muster.rules"), (errno.EROFS, "ReadWritePaths")]
)
def test_a_device_that_may_not_be_set_says_what_to_install(
    plug, start, monkeypatch, number, reported
) -> None:
    plug()

    def refused(path: Path, _: str) -> None:
        raise OSError(number, os.strerror(number), str(path))

    monkeypatch.setattr(buffer, "write_text", refused)
    with start("bmi160") as taken:
        until(lambda: reported in taken.faults(), reported)


def test_a_rate_that_is_not_offered_is_stated_and_the_nearest_taken(plug, start) -> None:
    plug()
    with start("bmi160?rate=300") as taken:
        until(lambda: len(taken) > ENOUGH, "samples")
        assert "it offers no 300 samples a second but 25 50 100 200 400" in taken.faults()
        assert "it gives 400" in taken.faults()


def test_a_rate_that_was_not_known_in_time_is_stated(plug, start) -> None:
    with start("icm42688-accel+icm42688-gyro") as taken:
        until(lambda: "there is no IIO device" in taken.faults(), "that it is missing")
        plug(ICM_ACCEL, number=0)
        plug(ICM_GYRO, number=1)
        other = "it gives 200 samples a second and was taken for one of 400"
        until(lambda: other in taken.faults(), other)


def test_a_device_without_a_buffer_is_polled(tree, start) -> None:
    device = without_buffer(tree, BMI160, in_temp_raw="25", in_temp_scale="1000")
    with start("bmi160?rate=50") as taken:
        until(lambda: len(taken) > ENOUGH, "samples")
        break_attribute(device, "in_accel_y_raw")
        until(lambda: "it does not answer (input/output error)" in taken.faults(), "the error")
        before = len(taken)
        (device / "in_accel_y_raw").unlink()
        write_attributes(device, {"in_accel_y_raw": "-7"})
        until(lambda: len(taken) > before + ENOUGH, "samples again")
    assert np.linalg.norm(taken.column("accel_mps2"), axis=1) == pytest.approx(9.81, abs=0.1)
    assert np.diff(taken.column("t_ns")).min() > 0
    assert taken.others[0].temperature_degc == 25.0
    assert (device / "in_accel_sampling_frequency").read_text().strip() == "100"


def test_a_trigger_of_the_device_is_attached(tree, plug, start) -> None:
    device = plug()
    device.set("trigger", current_trigger="")
    own = tree.iio_trigger(0, "spi0.0", name="bmi160-dev0")
    tree.iio_trigger(1, "spi0.0", name="bmi160-any-motion")
    with start("bmi160") as taken:
        until(lambda: len(taken) > ENOUGH, "samples")
    assert device.value("trigger/current_trigger") == "bmi160-dev0"
    assert not (own / "sampling_frequency").exists()


def test_a_timer_that_is_named_is_attached_and_set(tree, plug, start) -> None:
    device = plug()
    device.set("trigger", current_trigger="")
    timer = tree.iio_trigger(0, "", name="muster", sampling_frequency="10")
    with start("bmi160?trigger=other") as taken:
        until(lambda: "there is no trigger other; there are muster" in taken.faults(), "its names")
    with start("bmi160?trigger=muster&rate=200") as taken:
        until(lambda: len(taken) > ENOUGH, "samples")
    assert device.value("trigger/current_trigger") == "muster"
    assert (timer / "sampling_frequency").read_text().strip() == "200"
    assert device.value("in_accel_sampling_frequency") == "400", "no value is read twice"


def test_a_device_whose_stamps_are_of_the_wall_clock(plug, start) -> None:
    device = plug()
    device.clock = time.time_ns
    (device.path / "current_timestamp_clock").unlink()
    with start("bmi160") as taken:
        until(lambda: len(taken) > ENOUGH, "samples")
    assert abs(time.monotonic_ns() - taken.column("t_ns")[-1]) < 60e9


def test_a_driver_that_does_not_stamp_by_the_clock_that_it_says(plug, start) -> None:
    device = plug()
    device.clock = time.time_ns
    with start("bmi160") as taken:
        until(lambda: "have times that cannot be" in taken.faults(), "that its times are wrong")
        assert len(taken) == 0


def test_a_buffer_from_which_nothing_comes(plug, start) -> None:
    device = plug()
    device.close()
    device.node.unlink()
    os.mkfifo(device.node)
    writer = os.open(device.node, os.O_RDWR)
    with start("bmi160") as taken:
        until(lambda: "check its interrupt line" in taken.faults(), "the silence")
    os.close(writer)


@pytest.mark.parametrize(
    ("text", "reported"),
    [
        (
            "icm42688-accel",
            "has no gyroscope; there are in_accel_x, in_accel_y, in_accel_z, in_temp",
        ),
        (
            "icm42688-gyro+icm42688-accel",
            "icm42688-gyro has no accelerometer; there are in_anglvel_x",
        ),
        ("icm42688", "there is no IIO device named icm42688; there are icm42688-accel@"),
    ],
)
def test_devices_that_are_named_wrongly(plug, start, text, reported) -> None:
    plug(ICM_ACCEL)
    plug(ICM_GYRO, number=1)
    with start(text) as taken:
        until(lambda: reported in taken.faults(), reported)


def test_a_mount_matrix_that_cannot_be_is_stated(plug, start) -> None:
    plug(in_mount_matrix="0, 0, 0; 0, 0, 0; 0, 0, 0")
    with start("bmi160") as taken:
        until(lambda: "which is no rotation" in taken.faults(), "the matrix")
        assert len(taken) == 0


def test_description_contains_the_settings_of_the_driver(plug, tree) -> None:
    plug()
    described = IioSource("bmi160?rate=200", sysfs=tree.root).description
    assert (described.name, described.rate_hz) == ("bmi160", 200.0)
    assert described.accel_full_scale_mps2 == pytest.approx(16 * 9.80665, rel=0.001)
    assert described.gyro_full_scale_radps == pytest.approx(np.radians(2000), rel=0.001)
    assert not described.mag_present


def test_a_magnetometer_in_the_device_is_described(plug, tree) -> None:
    plug(MPU9250)
    assert IioSource("mpu9250", sysfs=tree.root).description.mag_present
