"""What a reader of satellites makes of lines that are lost, said twice or without a time."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import pytest

from edge.receivers.gps_reader import GpsReader
from edge.receivers.nmea import Nmea
from shared.clock import ManualClock
from tests.gps_receiver import Told, gga, rmc

BAD = b"$GNRMC,0927"


class Receiver:
    """A line on which something is said once a second, without a thread."""

    def __init__(self) -> None:
        self.clock = ManualClock()
        self.reader = GpsReader(Nmea("/dev/ttyUSB0"), self.clock)
        self._told = self._seconds()
        self.opened()

    def opened(self) -> None:
        self.reader.opened()

    def says(self, seconds: int, bad: int = 0) -> tuple[str, ...]:
        """Fixes, with so many lines a second that cannot be read; what a person hears of it."""
        for _ in range(seconds):
            self.clock.advance(1.0)
            told = next(self._told)
            for line in (gga(told), rmc(told), *[BAD] * bad):
                self.reader.hear(line.strip(), self.clock.monotonic_ns())
            self.reader.turn(self.clock.monotonic_ns(), paused=True)
        return self.reader.take_faults()

    @staticmethod
    def _seconds() -> Iterator[Told]:
        told = Told()
        while True:
            told = replace(told, of_day_s=told.of_day_s + 1.0)
            yield told


@pytest.fixture
def receiver() -> Receiver:
    return Receiver()


def test_a_line_that_goes_on_losing_what_is_said_is_told_once(receiver: Receiver) -> None:
    (fault,) = receiver.says(60, bad=1)
    assert "lines in 10 s could not be read" in fault
    receiver.opened()
    assert receiver.says(60, bad=1) == (), "a cable that is put in again and is no better"


def test_a_line_that_was_well_and_loses_again_is_told_again(receiver: Receiver) -> None:
    receiver.says(30, bad=1)
    assert receiver.says(30) == ()
    assert len(receiver.says(30, bad=1)) == 1
