"""The reader of satellite receivers, with lost, silent, repeated and removed lines."""

from __future__ import annotations

import errno
from dataclasses import replace

import pytest

from edge.sources.gnss.nmea import Nmea
from edge.sources.gnss.reader import GnssReader
from shared.clock import NS_PER_S, ManualClock
from tests.rig.gps_receiver import ReportedFix, gga, rmc, sentence

BAD = b"$GNRMC,0927"
STATED = ReportedFix()
OF_NO_USE = sentence("GNVTG,,T,,M,0.02,N,0.04,K,A")


class Receiver:
    """A line on which something is said, without a thread."""

    def __init__(self, text: str = "/dev/ttyUSB0") -> None:
        self.clock = ManualClock()
        self.reader = GnssReader(Nmea(text), self.clock)
        self._is_of_use = True
        self.on_open()

    def on_open(self) -> None:
        self.reader.on_open()

    def says(self, seconds: int, bad: int = 0, others: int = 0) -> tuple[str, ...]:
        """A fix a second, in two lines, with so many that cannot be read and so many others; what a
        person hears of it.
        """
        faults: list[str] = []
        for _ in range(seconds):
            reported = replace(
                STATED, of_day_s=STATED.of_day_s + self.clock.monotonic_ns() / NS_PER_S
            )
            faults += self.receives(
                gga(reported), rmc(reported), *[OF_NO_USE] * others, *[BAD] * bad
            )
        return tuple(faults)

    def receives(self, *lines: bytes) -> tuple[str, ...]:
        """In one second."""
        self.clock.advance(1.0)
        for line in lines:
            self.reader.on_line(line.strip(), self.clock.monotonic_ns())
        self._is_of_use = self.reader.keeps_open(self.clock.monotonic_ns(), paused=True)
        return self.reader.take_faults()

    def keeps_the_line(self) -> bool:
        return self._is_of_use

    def is_silent(self, seconds: int) -> tuple[str, ...]:
        return tuple(fault for _ in range(seconds) for fault in self.receives())


@pytest.fixture
def receiver() -> Receiver:
    return Receiver()


def test_a_line_that_goes_on_losing_what_is_stated_is_reported_once(receiver: Receiver) -> None:
    (fault,) = receiver.says(60, bad=1)
    assert "lines in 10 s could not be read" in fault
    assert str(BAD) in fault
    receiver.on_open()
    assert receiver.says(60, bad=1) == (), "a cable that is put in again and is no better"


def test_a_line_that_was_well_and_loses_again_is_reported_again(receiver: Receiver) -> None:
    receiver.says(30, bad=1)
    assert receiver.says(30) == ()
    assert len(receiver.says(30, bad=1)) == 1


@pytest.mark.parametrize(("bad", "faults"), [(3, 0), (4, 1)])
def test_half_a_line_after_opening_is_no_bad_line(
    receiver: Receiver, bad: int, faults: int
) -> None:
    stated = receiver.says(1, bad=bad) + receiver.says(11)
    assert len(stated) == faults
    assert receiver.reader.garbled == bad


@pytest.mark.parametrize(("bad", "faults"), [(2, 0), (3, 1)])
def test_more_than_one_bad_line_in_ten_is_reported(
    receiver: Receiver, bad: int, faults: int
) -> None:
    assert len(receiver.says(30, bad=bad, others=18)) == faults


def test_each_fix_is_taken_once(receiver: Receiver) -> None:
    receiver.says(3)
    assert len(receiver.reader.take()) == 3
    assert receiver.reader.take() == ()
    assert receiver.reader.taken == 3


def test_newest_six_hundred_unread_fixes_are_kept(receiver: Receiver) -> None:
    receiver.says(610)
    kept = receiver.reader.take()
    assert len(kept) == 600
    assert kept[-1].t_ns > receiver.clock.monotonic_ns() - NS_PER_S


def test_a_line_on_which_nothing_comes_is_reported_and_opened_again(receiver: Receiver) -> None:
    assert receiver.is_silent(10) == ()
    assert receiver.keeps_the_line()
    (fault,) = receiver.is_silent(1)
    assert "no fixes: the line is open and nothing comes" in fault
    assert not receiver.keeps_the_line()
    receiver.on_open()
    assert receiver.is_silent(10) == ()
    assert receiver.keeps_the_line(), "it has ten seconds again"
    assert receiver.is_silent(1) == (), "which has been told"


def test_a_receiver_that_falls_silent_again_is_reported_again(receiver: Receiver) -> None:
    for _ in range(2):
        receiver.says(1)
        (fault,) = receiver.is_silent(11)
        assert "it has fallen silent" in fault
        receiver.on_open()
    (fault,) = receiver.is_silent(11)
    assert "nothing comes" in fault, "since the line is open"


def test_a_receiver_that_hangs_is_reported(receiver: Receiver) -> None:
    faults = [fault for _ in range(13) for fault in receiver.receives(gga(STATED))]
    assert ["the same instant again and again" in fault for fault in faults] == [True]
    assert len(receiver.reader.take()) == 1


def test_a_receiver_that_hung_and_then_falls_silent_has_fallen_silent(receiver: Receiver) -> None:
    receiver.receives(gga(STATED))
    receiver.receives(gga(STATED))
    receiver.says(1)
    (fault,) = receiver.is_silent(11)
    assert "it has fallen silent" in fault


def test_line_of_another_device_is_reported(receiver: Receiver) -> None:
    noise = b"\x81" * 60
    (fault,) = [fault for _ in range(11) for fault in receiver.receives(noise, b"x")]
    assert f"what comes is no receiver's: {noise[:40]!r} (no whole sentence)" in fault


@pytest.mark.parametrize(
    ("text", "error", "reported"),
    [
        ("/dev/ttyUSB0", OSError(errno.ENOENT, "x"), "there is no such device"),
        ("/dev/ttyUSB0", None, "it went away"),
        ("tcp://10.0.0.1:5000", None, "it has ended the connection"),
    ],
)
def test_why_a_line_is_gone_is_reported_once_until_it_is_back(
    text: str, error: OSError | None, reported: str
) -> None:
    receiver = Receiver(text)
    for _ in range(3):
        receiver.reader.on_close(error)
    (fault,) = receiver.reader.take_faults()
    assert f"no fixes: {reported}" in fault
    receiver.says(1)
    receiver.reader.on_close(error)
    assert len(receiver.reader.take_faults()) == 1


def test_a_line_that_ends_after_nothing_but_noise_was_no_receivers(receiver: Receiver) -> None:
    receiver.receives(b"\x81")
    receiver.reader.on_close(None)
    receiver.reader.on_close(OSError(errno.ENOENT, "x"))
    faults = receiver.reader.take_faults()
    assert ["no receiver's" in fault for fault in faults] == [True, False]


def test_an_instant_is_not_over_before_the_line_pauses(receiver: Receiver) -> None:
    receiver.reader.on_line(gga(STATED).strip(), 0)
    assert receiver.reader.keeps_open(0, paused=False)
    assert receiver.reader.take() == ()
    receiver.reader.keeps_open(0, paused=True)
    assert len(receiver.reader.take()) == 1
