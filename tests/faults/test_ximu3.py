"""An x-IMU3 that is off, out of range, cut, noisy or set wrongly is reported, and the agent
continues.
"""

from __future__ import annotations

import errno
import socket
import time
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from threading import Thread

import numpy as np
import pytest

from edge.samples import SensorBatch
from edge.sources.transport.address import explain_os_error
from edge.sources.ximu3.source import Ximu3Source, parse_settings
from tests.rig.waiting import until
from tests.rig.ximu3_device import STEP_US, PtyDevice, TcpDevice, at_rest, text_message


class FastClock:
    """A clock that goes twenty times as fast, so that nobody waits for a silence."""

    def monotonic_ns(self) -> int:
        return 20 * time.monotonic_ns()

    def utc_ns(self) -> int:
        return time.time_ns()


class Listener:
    """A source that is read by a thread, as the agent does it."""

    def __init__(self, text: str, hasty: bool = False) -> None:
        self.source = Ximu3Source(text, FastClock() if hasty else None)
        self.batches: list[SensorBatch] = []
        self._faults: list[str] = []
        self._thread = Thread(target=self._run, daemon=True)
        self._thread.start()

    @property
    def faults(self) -> list[str]:
        self._faults += self.source.take_faults()
        return self._faults

    @property
    def times_ns(self) -> np.ndarray:
        return np.concatenate([batch.imu.t_ns for batch in self.batches])

    def receives(self, words: str) -> None:
        until(lambda: any(words in fault for fault in self.faults), words)

    def close(self) -> None:
        self.source.close()
        self._thread.join(10.0)
        assert not self._thread.is_alive()

    def _run(self) -> None:
        self.batches.extend(self.source.batches())


@pytest.fixture
def listen() -> Iterator[Callable[..., Listener]]:
    made: list[Listener] = []

    def start(text: str, hasty: bool = False) -> Listener:
        made.append(Listener(text, hasty))
        return made[-1]

    yield start
    for listener in made:
        listener.close()


def test_incomplete_lines_and_noise_lose_only_the_affected_samples(listen) -> None:
    stated = at_rest(300)
    hit = b"".join([stated[0][7:], *stated[1:50], b"\xff\x00\n", stated[50][:20], *stated[51:]])
    with closing(TcpDevice([hit])) as device:
        listener = listen(device.source)
        until(lambda: listener.faults)
        source = listener.source
        assert (source.taken, source.garbled) == (297, 3)
        listener.close()
    assert (np.diff(listener.times_ns) > 0).all()


def test_restarted_device_is_reported_and_continues(listen) -> None:
    """It is switched off and on again: its clock begins anew, the unit's does not."""
    sessions = at_rest(300, first=100_000), at_rest(300)
    with closing(TcpDevice(*sessions)) as device:
        listener = listen(device.source)
        until(lambda: listener.source.taken == 599, "both sessions but the message in doubt")
        listener.receives("it has ended the connection")
        listener.receives("its clock went back by 250.7 s: it was started anew")
        listener.close()
    assert (np.diff(listener.times_ns) > 0).all()


def test_missing_device_is_awaited(listen) -> None:
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    listener = listen(f"tcp://127.0.0.1:{port}")
    listener.receives("the connection is refused")
    with closing(TcpDevice(at_rest(100), port=port, hangs=True)):
        until(lambda: listener.source.taken == 100, "it is there")
        listener.close()
    assert len([fault for fault in listener.faults if "refused" in fault]) == 1


@pytest.mark.parametrize(
    ("stated", "reported"),
    [
        ([], "the line is open and nothing comes"),
        ([np.random.default_rng(1).bytes(4000)], "what comes is no x-IMU3's"),
        ([text_message("T", 5, 20.0)] * 9, "it sends no inertial messages"),
        (at_rest(50), "it has fallen silent"),
    ],
)
def test_a_line_without_samples_is_reported_and_opened_again(listen, stated, reported) -> None:
    with closing(TcpDevice(stated, at_rest(100, first=200), hangs=True)) as device:
        listener = listen(device.source, hasty=True)
        listener.receives(reported)
        until(lambda: listener.source.taken >= 100, "the second time is a good one")
        listener.close()


def test_wrong_baud_rate_is_reported_as_unreadable(listen) -> None:
    with closing(PtyDevice([np.random.default_rng(2).bytes(3000)])) as device:
        listener = listen(f"{device.source}?baud=9600", hasty=True)
        listener.receives("on a serial line the right ?baud=")
        listener.close()


def test_unplugged_cable_is_reported(listen) -> None:
    with closing(PtyDevice(at_rest(200))) as device:
        listener = listen(device.source)
        until(lambda: listener.source.taken == 200, "it works")
        device.close()
        listener.receives("is the cable in")
        listener.close()


def test_unexpected_sample_rate_is_reported_once(listen) -> None:
    slow = [text_message("I", 8 * k * STEP_US, 0, 0, 0, 0, 0, 1.0 + k % 2) for k in range(3000)]

    def parts() -> Iterator[bytes]:
        for start in range(0, 3000, 60):  # 1.2 s of them, at the hasty clock's pace
            time.sleep(1.2 / 20)
            yield b"".join(slow[start : start + 60])

    with closing(TcpDevice(parts())) as device:
        listener = listen(device.source, hasty=True)
        listener.receives("it sends 50 samples a second, configured are 400")
        listener.close()
    assert len([fault for fault in listener.faults if "a second, configured" in fault]) == 1


def test_errors_of_the_device_are_forwarded(listen) -> None:
    with closing(TcpDevice([b"F,5,Battery \x07low\r\n"], hangs=True)) as device:
        listen(device.source).receives("it reports an error: Battery ?low")


def test_repeated_error_of_the_device_is_forwarded_once(listen) -> None:
    stated = [b"F,5,SD card full\r\n"] * 30 + [b"F,6,Battery low\r\n"]
    with closing(TcpDevice(stated, hangs=True)) as device:
        listener = listen(device.source)
        listener.receives("Battery low")
    assert len([fault for fault in listener.faults if "SD card full" in fault]) == 1


def test_device_that_is_no_serial_port_is_reported(listen, tmp_path: Path) -> None:
    plain = tmp_path / "file"
    plain.write_text("I,1,0,0,0,0,0,1\r\n")
    listen(str(plain)).receives("it is no serial port")
    listen(str(tmp_path / "ttyACM7")).receives("there is no such device")


@pytest.mark.parametrize(
    ("error", "reported"),
    [
        (PermissionError(errno.EACCES, "Permission denied"), "dialout"),
        (TimeoutError("timed out"), "does not answer"),
        (OSError(errno.EHOSTUNREACH, "No route to host"), "no way to that address"),
        (OSError(errno.EBUSY, "Device or resource busy"), "another program"),
        (socket.gaierror(-2, "Name or service not known"), "the name imu.local is not known here"),
        (OSError(errno.ENOSPC, "No space left on device"), "No space left"),
    ],
)
def test_every_failure_of_a_line_has_an_explanation(error: OSError, reported: str) -> None:
    assert reported in explain_os_error(error, parse_settings("tcp://imu.local").line)
