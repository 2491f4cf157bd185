"""Samples of several sensors of one unit stay separate in messages, and old messages have one."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import msgspec
import numpy as np

from edge.clocks.timeline import Timeline
from edge.sample_codec.codec import SampleEncoder, batch_of
from edge.sample_codec.descriptions import described_unit, sensors_of, unit_sensor
from edge.sample_codec.uplink import RawUplink
from edge.samples import ImuBatch, SensorBatch, SensorDescription
from edge.sources.black_box import BlackBoxSource
from edge.storage.black_box.black_box import BlackBox
from shared.clock import ManualClock
from shared.header_factory import HeaderFactory
from shared.messages import Header, RawImu, UnitDescription
from shared.messages.muster.v1 import imu_pb2, unit_description_pb2

FOOT = SensorDescription("IMU 1", 200.0, mag_present=True, place="left_foot", mount="laces")
BACK = SensorDescription("IMU 2", 100.0, barometer_present=True, place="lower_back")
SENSORS = {"left_foot": FOOT, "back": BACK}
HEADER = Header("u1", 7, 1, 0)


def interleaved() -> Iterator[SensorBatch]:
    """50 ms of each sensor in turn; every sample's force is its time, and its sensor's sign."""
    for first_ms in range(0, 1000, 50):
        for sign, (name, sensor) in zip((1.0, -1.0), SENSORS.items(), strict=True):
            t_ms = np.arange(first_ms, first_ms + 50, round(1000.0 / sensor.rate_hz))
            force = np.column_stack((sign * t_ms, 0.0 * t_ms, 0.0 * t_ms))
            imu = ImuBatch(t_ms.astype(np.int64) * 1_000_000, force, np.zeros((len(t_ms), 3)))
            yield SensorBatch(imu, sensor=name)


def check_apart(batches: dict[str, list[ImuBatch]]) -> None:
    for sign, (name, sensor) in zip((1.0, -1.0), SENSORS.items(), strict=True):
        expected_ms = np.arange(0, 1000, round(1000.0 / sensor.rate_hz))
        force = np.concatenate([imu.accel_mps2[:, 0] for imu in batches[name]])
        np.testing.assert_allclose(force, sign * expected_ms)


def test_the_black_box_plays_each_sensor_under_its_name(tmp_path: Path) -> None:
    raw = SampleEncoder("u1", 7)
    sent = [unit_sensor(name, sensor) for name, sensor in SENSORS.items()]
    description = raw.description(0, sent, source="", tracker="")
    box = BlackBox(tmp_path, description, 10**9, ManualClock())
    for batch in interleaved():
        box.write(raw.messages(batch))
    box.close()
    (boot,) = tmp_path.iterdir()
    source = BlackBoxSource(boot)
    assert source.sensors == SENSORS
    assert source.description == FOOT
    played: dict[str, list[ImuBatch]] = {}
    for batch in source.batches():
        played.setdefault(batch.sensor, []).append(batch.imu)
    check_apart(played)


def test_the_uplink_mixes_no_sensors_in_a_message() -> None:
    uplink = RawUplink(HeaderFactory("u1", 7, ManualClock()))
    sent: list[RawImu] = []
    for batch in interleaved():
        for row in range(len(batch.imu)):
            imu = batch.imu.part(slice(row, row + 1))
            sent += uplink.push(imu, Timeline(), batch.sensor)
    sent += uplink.finish(Timeline())
    arrived: dict[str, list[ImuBatch]] = {}
    for message in sent:
        through = batch_of((RawImu.from_wire(message.to_wire()),))
        arrived.setdefault(through.sensor, []).append(through.imu)
    check_apart(arrived)
    assert len(sent) < 60, "samples are sent together"


def test_a_description_begins_with_the_fields_of_earlier_versions() -> None:
    sent = [unit_sensor(name, sensor) for name, sensor in SENSORS.items()]
    described = described_unit(HEADER, sent, software_version="1", source="s", tracker="eskf")
    assert (described.sensor_name, described.has_magnetometer) == ("IMU 1", True)
    assert UnitDescription.from_wire(described.to_wire()) == described


def test_messages_of_earlier_versions_are_of_one_sensor_without_a_name() -> None:
    header = HEADER.to_wire()
    wire = unit_description_pb2.UnitDescription(
        header=header, sensor_name="IMU", rate_mhz=200_000, has_magnetometer=True
    )
    described = UnitDescription.from_wire(wire)
    assert sensors_of(described) == {"": SensorDescription("IMU", 200.0, mag_present=True)}
    samples = imu_pb2.ImuBatch(
        header=header, dt_ns=[0], accel_e5_mps2=[1, 2, 3], gyro_e6_radps=[0, 0, 0]
    )
    assert batch_of((RawImu.from_wire(samples),)).sensor == ""


def test_a_recognised_place_is_recognised_again_by_the_reader() -> None:
    sent = msgspec.structs.replace(unit_sensor("", FOOT), place_recognised=True)
    described = described_unit(HEADER, [sent], software_version="", source="", tracker="")
    through = UnitDescription.from_wire(described.to_wire())
    assert through.sensors[0].place == "left_foot"
    assert sensors_of(through)[""].place == ""
