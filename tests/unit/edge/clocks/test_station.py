"""Time requests of a unit to the station, and missing answers."""

from __future__ import annotations

import pytest

from edge.clocks.station import StationClock
from shared.bus import ReplyHandler
from shared.clock import NS_PER_S, ManualClock
from shared.messages.clock import ClockAnswer

STATION_NS = 1_800_000_000 * NS_PER_S


class Station:
    """Its clock runs with the machine's; ``answers`` of those it gives."""

    def __init__(self, machine: ManualClock) -> None:
        self.machine = machine
        self.asked_s: list[float] = []
        self.answer: bytes | None = None

    def ask(self, reply: ReplyHandler) -> None:
        now_ns = self.machine.monotonic_ns()
        self.asked_s.append(now_ns / NS_PER_S)
        reply(self.answer or ClockAnswer(STATION_NS + now_ns, STATION_NS + now_ns).to_bytes())


def watched(clock: StationClock, station: Station, seconds: int) -> list[float]:
    for _ in range(10 * seconds):
        clock.turn(station.ask)
        station.machine.advance(0.1)
    return station.asked_s


def test_requests_are_sent_each_second_until_eight_answers_and_then_rarely() -> None:
    machine = ManualClock()
    asked_s = watched(StationClock(machine), Station(machine), 40)
    assert asked_s == pytest.approx([0, 1, 2, 3, 4, 5, 6, 7, 8, 23, 38])


def test_invalid_answer_is_no_time_and_the_requests_continue() -> None:
    machine = ManualClock()
    station, clock = Station(machine), StationClock(machine)
    station.answer = b"\xff\xff"
    assert len(watched(clock, station, 30)) == 30
    assert clock.estimate() is None
    assert (clock.utc_ns(), clock.utc_std_s()) == (machine.utc_ns(), 0.0)
    assert clock.machine_ahead_s() == 0.0


def test_once_it_has_been_reported_it_goes_by_the_station() -> None:
    machine = ManualClock()
    station, clock = Station(machine), StationClock(machine)
    watched(clock, station, 20)
    assert clock.utc_ns() == pytest.approx(STATION_NS + machine.monotonic_ns(), abs=1e6)
    assert clock.machine_ahead_s() == pytest.approx(1_700_000_000 - 1_800_000_000, abs=1e-3)
    assert clock.utc_std_s() == 1e-3, "less would say that nothing is known"
