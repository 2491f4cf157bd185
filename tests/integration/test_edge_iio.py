"""An agent with an inertial sensor of Industrial I/O, on an emulated machine."""

from __future__ import annotations

import errno
import math
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest

from edge.sources.registry import open_source
from shared.bus_zenoh import StationEndpoint, ZenohBus
from shared.channels import COMMAND, ROOT, parse_key
from shared.codec import decode
from shared.messages import EventKind, Message, Position, UnitEvent
from tests.rig.device_requests import DeviceRequests
from tests.rig.iio_device import BMI160, ICM_ACCEL, ICM_GYRO, EmulatedIio
from tests.rig.kernel_devices import EmulatedAgent, SysfsTree, has_umockdev
from tests.rig.waiting import until

pytestmark = pytest.mark.skipif(
    not has_umockdev(), reason="no umockdev on this machine: install the package umockdev"
)


class Station:
    """Everything that a unit publishes."""

    def __init__(self, port: int) -> None:
        self.messages: list[Message] = []
        self._bus = ZenohBus(StationEndpoint((f"tcp/127.0.0.1:{port}",)))
        self._bus.subscribe(f"{ROOT}/u1/**", self._take)

    def close(self) -> None:
        self._bus.close()

    def faults(self) -> str:
        events = [message for message in list(self.messages) if isinstance(message, UnitEvent)]
        return "\n".join(e.detail for e in events if e.kind is EventKind.SENSOR_FAULT)

    def positions(self) -> list[Position]:
        return [message for message in list(self.messages) if isinstance(message, Position)]

    def _take(self, key: str, payload: bytes) -> None:
        channel = parse_key(key)[1]
        if channel is not COMMAND:
            self.messages.append(decode(channel, payload))


@pytest.fixture
def machine() -> Iterator[Path]:
    """Its path is short, as the name of a socket has to be."""
    with TemporaryDirectory() as folder:
        yield Path(folder)


@pytest.fixture
def tree(machine: Path) -> SysfsTree:
    return SysfsTree(machine / "sys")


@pytest.fixture
def devices(machine: Path) -> Path:
    return machine / "dev"


@pytest.fixture
def requests(machine: Path) -> Iterator[DeviceRequests]:
    """Those for the first device."""
    with (
        closing(DeviceRequests(machine, "iio:device0")) as requests,
        closing(DeviceRequests(machine, "iio:device1")),
    ):
        yield requests


@pytest.fixture
def station(port: int) -> Iterator[Station]:
    with closing(Station(port)) as station:
        yield station


@pytest.fixture
def started(
    machine: Path, requests: DeviceRequests, port: int, tmp_path: Path
) -> Callable[..., EmulatedAgent]:
    def started(*flags: str, command: str = "run") -> EmulatedAgent:
        where = ("--data", str(tmp_path / "edge"), "--connect", f"tcp/127.0.0.1:{port}")
        output = tmp_path / "agent.txt"
        return EmulatedAgent(machine, output, "--unit", "u1", *flags, *where, command=command)

    return started


def test_agent_reports_a_removed_sensor_and_continues(
    tree, devices, requests, station, started, tmp_path: Path
) -> None:
    with started("--source", "iio:bmi160") as agent:
        until(lambda: "there is no IIO device named bmi160" in station.faults(), "its absence")
        with closing(EmulatedIio(tree, devices, BMI160)) as sensor:
            until(station.positions, "a position")

            sensor.is_stuck = True
            until(lambda: "has repeated one value for 1 s" in station.faults(), "that it hangs")
            sensor.is_stuck = False

            requests.read_error = errno.EIO
            until(lambda: "(input/output error)" in station.faults(), "that its bus fails")
            requests.read_error = None
            count = len(station.positions())
            until(lambda: len(station.positions()) > count, "positions after the error")

            requests.read_error = errno.ENODEV
            sensor.detach()
            until(lambda: station.faults().count("there is no IIO device") > 1, "its removal")
            assert "no samples: it was removed" in station.faults()
            requests.read_error = None
            sensor.attach()
            count = len(station.positions())
            until(lambda: len(station.positions()) > count, "positions after its return")
        assert agent.runs()
        assert agent.stop() == 0, agent.output()
    for position in station.positions():
        assert all(map(math.isfinite, (position.north_m, position.east_m, position.down_m)))
    (boot,) = (tmp_path / "edge" / "u1" / "black_box").iterdir()
    recorded = [batch.imu for batch in open_source(f"mcap:{boot}").batches()]
    for imu in recorded:
        assert np.isfinite(imu.accel_mps2).all()
        assert np.isfinite(imu.gyro_radps).all()
    times_ns = np.concatenate([imu.t_ns for imu in recorded])
    assert (np.diff(times_ns) > 0).all()
    assert np.median(np.diff(times_ns)) == pytest.approx(2_500_000, rel=0.001)


def test_a_unit_with_two_devices_is_checked(tree, devices, started) -> None:
    tree.iio(5, "1-005d", name="lps22hb", in_pressure_input="101.325")
    source = "iio:icm42688-accel+icm42688-gyro?rate=200&pressure=lps22hb"
    with (
        closing(EmulatedIio(tree, devices, ICM_ACCEL, 0)),
        closing(EmulatedIio(tree, devices, ICM_GYRO, 1)),
        started("--source", source, "--for", "4", command="check") as checked,
    ):
        until(lambda: not checked.runs(), "the end of the check")
        for line in (
            "ok      sample rate: 200.",
            "ok      measuring range: 16 g and 2000 deg/s",
            "ok      accelerometer: 9.8",
            "ok      gyroscope:",
            "ok      air pressure: 1013.",
            "25.0 °C",
        ):
            assert line in checked.output()
        assert "failed  sensors" not in checked.output()
