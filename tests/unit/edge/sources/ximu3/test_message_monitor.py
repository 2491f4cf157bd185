"""Reports of a line on which an x-IMU3 loses messages."""

from __future__ import annotations

import pytest

from edge.sources.ximu3.message_monitor import MessageMonitor
from edge.sources.ximu3.messages import OtherMessage
from shared.clock import NS_PER_S
from shared.errors import WireError


class Line:
    """A hundred messages a second, and so many of them that cannot be read."""

    def __init__(self) -> None:
        self.watch = MessageMonitor(400.0)
        self._now_s = 0

    def goes_on(self, seconds: int, bad: int = 0) -> list[str]:
        reported = []
        for _ in range(seconds):
            self._now_s += 1
            for _ in range(100 - bad):
                self.watch.count(OtherMessage())
            for _ in range(bad):
                self.watch.count_garbled(b"I,1", WireError("half a message"))
            reported += self.watch.take_events(self._now_s * NS_PER_S)
        return reported


@pytest.fixture
def line() -> Line:
    return Line()


@pytest.mark.parametrize(("bad", "faults"), [(1, 0), (2, 1)])
def test_more_than_one_message_in_a_hundred_is_reported(line: Line, bad: int, faults: int) -> None:
    assert len(line.goes_on(30, bad)) == faults


def test_a_line_that_goes_on_losing_messages_is_reported_once(line: Line) -> None:
    (fault,) = line.goes_on(60, bad=5)
    assert "messages in 10 s could not be read" in fault
    assert line.goes_on(60, bad=1) == []
    assert line.goes_on(60, bad=5) == [], "it never was well"
    line.watch.on_open()
    assert line.goes_on(60, bad=5) == []


def test_a_line_that_was_well_and_loses_again_is_reported_again(line: Line) -> None:
    line.goes_on(30, bad=5)
    assert line.goes_on(30) == []
    assert len(line.goes_on(30, bad=5)) == 1
