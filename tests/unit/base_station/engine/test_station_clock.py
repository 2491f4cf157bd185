"""Station time advances whatever is done to the machine's clock, and the deviation is reported."""

from __future__ import annotations

import pytest

from base_station.engine.station_clock import SteadyClock
from shared.clock import NS_PER_S, ManualClock

DAY_NS = 86_400 * NS_PER_S


class JumpingClock(ManualClock):
    """A clock whose UTC a person sets."""

    def __init__(self) -> None:
        super().__init__()
        self.set_by_ns = 0

    def utc_ns(self) -> int:
        return super().utc_ns() + self.set_by_ns


@pytest.fixture
def machine() -> JumpingClock:
    return JumpingClock()


@pytest.fixture
def clock(machine: JumpingClock) -> SteadyClock:
    return SteadyClock(machine)


def test_station_time_advances_at_the_same_rate_when_utc_is_set_back(
    machine: JumpingClock, clock: SteadyClock
) -> None:
    before_ns = clock.utc_ns()
    machine.set_by_ns = -DAY_NS
    machine.advance(2.0)
    assert clock.utc_ns() == before_ns + 2 * NS_PER_S
    assert clock.problems() == (
        "This machine's clock is 24 hours behind what was recorded here last: set it. "
        "Times go on from there meanwhile",
    )


def test_station_time_follows_utc_forwards(machine: JumpingClock, clock: SteadyClock) -> None:
    machine.set_by_ns = DAY_NS
    assert clock.utc_ns() == machine.utc_ns()
    assert clock.problems() == ()


def test_station_time_continues_behind_that_of_an_earlier_run(machine: JumpingClock) -> None:
    earlier_ns = machine.utc_ns() + DAY_NS
    clock = SteadyClock(machine, not_before_ns=earlier_ns)
    machine.advance(1.0)
    assert clock.utc_ns() == earlier_ns + NS_PER_S


def test_held_clock_does_not_leap_and_reports_it(machine: JumpingClock, clock: SteadyClock) -> None:
    held = True
    clock.hold_while(lambda: held)
    before_ns = clock.utc_ns()
    machine.set_by_ns = 3 * DAY_NS
    machine.advance(10.0)
    assert clock.utc_ns() == before_ns + 10 * NS_PER_S
    (reported,) = clock.problems()
    assert "3 days ahead" in reported
    held = False
    assert clock.utc_ns() == machine.utc_ns()
    assert clock.problems() == ()


def test_clock_held_from_its_beginning_begins_by_the_machines_clock(machine: JumpingClock) -> None:
    clock = SteadyClock(machine, not_before_ns=1)
    clock.hold_while(lambda: True)
    assert clock.utc_ns() == machine.utc_ns()


def test_held_clock_takes_corrections_of_a_time_server(
    machine: JumpingClock, clock: SteadyClock
) -> None:
    clock.hold_while(lambda: True)
    for _ in range(100):
        machine.advance(1.0)
        machine.set_by_ns += 2 * NS_PER_S
        assert clock.utc_ns() == machine.utc_ns()


@pytest.mark.parametrize("by_ns", [-DAY_NS, DAY_NS])
def test_standby_has_the_time_of_the_leading_station(
    machine: JumpingClock, clock: SteadyClock, by_ns: int
) -> None:
    clock.hold_while(lambda: True)
    theirs_ns = machine.utc_ns() + by_ns
    clock.agree(theirs_ns)
    assert clock.utc_ns() == theirs_ns
    clock.agree(theirs_ns - NS_PER_S // 100)  # it was in transit for longer
    assert clock.utc_ns() == theirs_ns
    assert len(clock.problems()) == 1


def test_clock_never_goes_back(machine: JumpingClock, clock: SteadyClock) -> None:
    last_ns = clock.utc_ns()
    for set_by_ns in (0, DAY_NS, -DAY_NS, 2 * DAY_NS, 0, -7 * DAY_NS, NS_PER_S):
        machine.set_by_ns = set_by_ns
        machine.advance(0.5)
        now_ns = clock.utc_ns()
        assert now_ns > last_ns
        last_ns = now_ns
