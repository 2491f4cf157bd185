"""gpsd itself, where it is installed, with an emulated receiver on a serial port."""

from __future__ import annotations

import os
import shutil
import subprocess
import time
from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace

import pytest

from edge.samples import GpsSample
from edge.sources.gnss.reader import GnssReader
from edge.sources.gnss.registry import open_receiver
from shared.clock import NS_PER_S, SystemClock
from shared.messages import FixType
from tests.rig.gps_receiver import ReportedFix, burst
from tests.rig.station_process import free_port
from tests.rig.waiting import until
from tests.rig.ximu3_device import PtyDevice, paced

LONG_S = 120  # longer than any of this takes
STD_M = 2.0
HERE = ReportedFix(std_m=STD_M, vertical_std_m=3.0)


class Gpsd:
    """May be ended and begun again, as its users do."""

    def __init__(self, program: str, device: str) -> None:
        self.port = free_port()
        self._command = [program, "-N", "-n", "-S", str(self.port), device]
        self.begin()

    def begin(self) -> None:
        self._process = subprocess.Popen(self._command)

    def end(self) -> None:
        self._process.terminate()
        self._process.wait(10.0)


def each_second() -> Iterator[tuple[float, bytes]]:
    now_s = time.time() % 86_400
    for second in range(LONG_S):
        yield float(second), burst(replace(HERE, of_day_s=now_s + second))


@pytest.fixture(scope="module")
def gpsd() -> Iterator[Gpsd]:
    program = shutil.which("gpsd", path=f"{os.environ['PATH']}:/usr/sbin")
    if program is None:
        pytest.skip("no gpsd on this machine: install the package gpsd")
    with closing(PtyDevice(paced(each_second()))) as receiver:
        gpsd = Gpsd(program, receiver.source)
        yield gpsd
        gpsd.end()


@pytest.fixture(scope="module")
def reader(gpsd: Gpsd) -> Iterator[GnssReader]:
    with closing(open_receiver(f"gpsd://127.0.0.1:{gpsd.port}", SystemClock())) as reader:
        reader.start()
        yield reader


def sure_fix(reader: GnssReader) -> GpsSample:
    """The first of which gpsd has heard the receiver's own accuracy."""
    found: list[GpsSample] = []

    def received() -> bool:
        found.extend(fix for fix in reader.take() if fix.horizontal_std_m == STD_M)
        return bool(found)

    until(received, "a fix with the receiver's own accuracy")
    return found[0]


def test_fix_contains_the_values_of_the_receiver(reader: GnssReader) -> None:
    fix = sure_fix(reader)
    assert (fix.lat_deg, fix.lon_deg) == pytest.approx((HERE.lat_deg, HERE.lon_deg), abs=1e-6)
    assert fix.height_m == pytest.approx(HERE.height_m, abs=0.1)  # above the ellipsoid
    assert fix.vertical_std_m == HERE.vertical_std_m
    assert fix.fix_type == FixType.THREE_D
    assert abs(fix.t_ns - SystemClock().monotonic_ns()) < 5 * NS_PER_S


def test_restarted_gpsd_is_received_again(gpsd: Gpsd, reader: GnssReader) -> None:
    sure_fix(reader)
    gpsd.end()
    until(reader.take_faults, "word of its end")
    reader.take()
    gpsd.begin()
    sure_fix(reader)
