"""A satellite receiver that is off, cut, noisy, stuck or set wrongly is reported, and the agent
continues.
"""

from __future__ import annotations

import math
import socket
import time
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

import numpy as np
import pytest

from edge.samples import GpsSample
from edge.sources.gnss.reader import GnssReader
from edge.sources.gnss.registry import open_receiver
from shared.clock import SystemClock
from tests.rig.gps_receiver import (
    DEVICE,
    AcceleratedClock,
    GpsdServer,
    ReportedFix,
    burst,
    gga,
    gpsd_report,
    json_line,
    sentence,
)
from tests.rig.waiting import until
from tests.rig.ximu3_device import PtyDevice, TcpDevice

HERE = ReportedFix()
Device = GpsdServer | TcpDevice | PtyDevice
OneDevice = TypeVar("OneDevice", GpsdServer, TcpDevice, PtyDevice)
MANY = [replace(HERE, of_day_s=HERE.of_day_s + k) for k in range(40)]
NOISE = np.random.default_rng(2).bytes(3000)


class ReceiverOutput:
    """Fixes and faults that a unit takes from a receiver."""

    def __init__(self, text: str, hasty: bool) -> None:
        self.reader: GnssReader = open_receiver(
            text, AcceleratedClock() if hasty else SystemClock()
        )
        self._fixes: list[GpsSample] = []
        self._faults: list[str] = []
        self.reader.start()

    @property
    def fixes(self) -> list[GpsSample]:
        self._fixes += self.reader.take()
        return self._fixes

    @property
    def faults(self) -> list[str]:
        self._faults += self.reader.take_faults()
        return self._faults

    def receives(self, words: str) -> None:
        until(lambda: any(words in fault for fault in self.faults), words)

    def has(self, count: int) -> None:
        until(lambda: len(self.fixes) >= count, f"{count} fixes")


class ReceiverOutputs:
    """Devices are closed after those who listen to them."""

    def __init__(self) -> None:
        self.listening: list[ReceiverOutput] = []
        self.pretended: list[Device] = []

    def pretend(self, device: OneDevice) -> OneDevice:
        self.pretended.append(device)
        return device

    def __call__(self, text: str, hasty: bool = False) -> ReceiverOutput:
        self.listening.append(ReceiverOutput(text, hasty))
        return self.listening[-1]


@pytest.fixture
def receive() -> Iterator[ReceiverOutputs]:
    ears = ReceiverOutputs()
    yield ears
    for received in ears.listening:
        received.reader.close()
        assert not received.reader.is_alive
    for device in ears.pretended:
        device.close()


def test_incomplete_lines_and_noise_lose_only_the_affected_sentences(
    receive: ReceiverOutputs,
) -> None:
    """Eleven bursts: half of the first one, one of which a byte is wrong, noise between."""
    first, *others = map(burst, MANY[:11])
    others[4] = others[4].replace(b"5742", b"5743", 1)
    stated = b"".join([first[150:], *others[:7], b"\xff\x00\n\x81\n", *others[7:]])
    device = receive.pretend(TcpDevice([stated], hangs=True))
    received = receive(f"nmea:{device.source}")
    received.has(10)
    assert {fix.fix_type for fix in received.fixes} == {3}
    assert sum(math.isnan(fix.speed_mps) for fix in received.fixes) == 1, "one has lost its RMC"
    assert all(fix.lat_deg == pytest.approx(57.7) for fix in received.fixes)
    assert received.reader.garbled == 4
    assert received.faults == []


def test_line_with_many_errors_is_reported(receive: ReceiverOutputs) -> None:
    def stated() -> Iterator[bytes]:
        for reported in MANY:
            time.sleep(0.05)  # a second, at the hasty clock's pace
            yield burst(reported) + b"$GNRMC,0927\n" * 2

    device = receive.pretend(TcpDevice(stated(), hangs=True))
    receive(f"nmea:{device.source}", hasty=True).receives(
        "could not be read, such as b'$GNRMC,0927'"
    )


def test_missing_receiver_is_awaited(receive: ReceiverOutputs) -> None:
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    received = receive(f"gpsd://127.0.0.1:{port}")
    received.receives("no fixes: the connection is refused")
    server = receive.pretend(GpsdServer([gpsd_report(HERE)], port=port, hangs=True))
    received.has(1)
    assert server.asked[0].startswith(b"?WATCH=")
    assert len([fault for fault in received.faults if "refused" in fault]) == 1


def test_restart_of_gpsd_is_reported_and_reconnected(receive: ReceiverOutputs) -> None:
    sessions = [gpsd_report(MANY[0])], [gpsd_report(MANY[5])]
    server = receive.pretend(GpsdServer(*sessions))
    received = receive(f"gpsd:{server.source}")
    received.has(2)
    received.receives("it has ended the connection")
    steps_s = np.diff([fix.t_ns for fix in received.fixes]) * 1e-9
    assert 0.0 < steps_s[0] < 10.0


OTHERS = sentence("GNVTG,,T,,M,0.02,N,0.04,K,A") + sentence("GPGSV,1,1,00,1")
UBX = b"\xb5b\x01\x07\x5c\x00" + bytes(range(92)) + b"\n"
STUCK = [gga(HERE)] * 20


@pytest.mark.parametrize(
    ("stated", "reported"),
    [
        ([], "the line is open and nothing comes"),
        ([NOISE], "what comes is no receiver's"),
        ([UBX * 5], "it sends u-blox's binary messages"),
        ([OTHERS * 5], "it sends GSV, VTG and no GGA, GNS or RMC sentences"),
        (STUCK, "it says the same instant again and again"),
        ([burst(HERE)], "it has fallen silent"),
    ],
    ids=["nothing", "noise", "binary", "others", "stuck", "silent"],
)
def test_a_line_without_fixes_is_reported_and_opened_again(
    receive: ReceiverOutputs, stated: Iterable[bytes], reported: str
) -> None:
    again = replace(HERE, of_day_s=HERE.of_day_s + 60.0)
    device = receive.pretend(TcpDevice(stated, [burst(again)], hangs=True))
    received = receive(f"nmea:{device.source}", hasty=True)
    received.receives(reported)
    until(lambda: any(math.isfinite(fix.speed_mps) for fix in received.fixes), "a fix")


@pytest.mark.parametrize(
    ("devices", "stated", "reported"),
    [
        ((), [], "gpsd has no receiver; is it plugged in"),
        ((DEVICE,), [], "gpsd receives nothing from its receiver"),
        ((DEVICE,), [json_line("DEVICE", path=DEVICE, activated=0)], "gpsd has no receiver"),
        ((DEVICE,), [b"SSH-2.0-OpenSSH_9.6\r\n" * 9], "gpsd receives nothing"),
    ],
    ids=["no device", "silent device", "unplugged", "odd words"],
)
def test_gpsd_without_a_receiver_is_reported(
    receive: ReceiverOutputs, devices: tuple[str, ...], stated: Iterable[bytes], reported: str
) -> None:
    server = receive.pretend(GpsdServer(stated, [gpsd_report(HERE)], devices=devices, hangs=True))
    received = receive(f"gpsd:{server.source}", hasty=True)
    received.receives(reported)
    received.has(1)


def test_server_that_is_no_gpsd_is_reported(receive: ReceiverOutputs) -> None:
    server = receive.pretend(TcpDevice([b"SSH-2.0-OpenSSH_9.6\r\n"]))
    receive(f"gpsd://127.0.0.1:{server.port}").receives("is this the port of gpsd")
    with socket.create_server(("127.0.0.1", 0)) as silent:
        port = silent.getsockname()[1]
        receive(f"gpsd://127.0.0.1:{port}", hasty=True).receives(
            "the line is open and nothing comes"
        )


def test_wrong_baud_rate_is_reported_as_unreadable(receive: ReceiverOutputs) -> None:
    device = receive.pretend(PtyDevice([NOISE]))
    receive(f"nmea:{device.source}?baud=38400", hasty=True).receives("?baud= right")


def test_unplugged_cable_is_reported(receive: ReceiverOutputs) -> None:
    device = receive.pretend(PtyDevice(map(burst, MANY[:3])))
    received = receive(f"nmea:{device.source}")
    received.has(3)
    device.close()
    received.receives("no fixes: it went away; is the cable in")


def test_replugged_receiver_is_reopened(receive: ReceiverOutputs, tmp_path: Path) -> None:
    """As udev names it: the same name for another terminal."""
    name = tmp_path / "gps"
    received = None
    for reported in (MANY[0], MANY[9]):
        device = PtyDevice([burst(reported)])
        name.unlink(missing_ok=True)
        name.symlink_to(device.source)
        received = received or receive(f"nmea:{name}")
        count = len(received.fixes)
        received.has(count + 1)
        device.close()


def test_device_that_is_no_serial_port_is_reported(
    receive: ReceiverOutputs, tmp_path: Path
) -> None:
    plain = tmp_path / "file"
    plain.write_bytes(burst(HERE))
    receive(f"nmea:{plain}").receives("it is no serial port")
    receive(f"nmea:{tmp_path / 'ttyACM7'}").receives("there is no such device")
