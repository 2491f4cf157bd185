"""Clocks that are skewed, drift or jump by a day, on either side, do not reorder history."""

from __future__ import annotations

import random
from itertools import pairwise

import pytest

from base_station.engine.station_clock import SteadyClock
from base_station.unit_sync.clock_server import ClockServer
from edge.clocks.offset import ClockOffsetFilter, Exchange
from edge.clocks.station import StationClock
from shared.bus import ReplyHandler
from shared.channels import POSITION, backfilled_key
from shared.clock import NS_PER_S
from shared.codec import encode
from shared.header_factory import HeaderFactory
from shared.messages import Header, Heartbeat, Position
from tests.rig.station_script import START_NS, Script

U = "FF-01"
DAY_S = 86_400.0
DAY_NS = 86_400 * NS_PER_S


class SetClock:
    """A machine's clocks: UTC can be set, and both run at a rate of their own."""

    def __init__(self, utc_ns: int, mono_ns: int, rate: float = 1.0) -> None:
        self._utc_offset_ns, self._mono_ns, self._rate = utc_ns - mono_ns, mono_ns, rate

    def pass_s(self, duration_s: float) -> None:
        self._mono_ns += round(duration_s * self._rate * NS_PER_S)

    def set_utc_ahead(self, by_s: float) -> None:
        self._utc_offset_ns += round(by_s * NS_PER_S)

    def monotonic_ns(self) -> int:
        return self._mono_ns

    def utc_ns(self) -> int:
        return self._mono_ns + self._utc_offset_ns


class UnitAndStation:
    """A unit and a station, with a link between them that queues now this way, now that."""

    def __init__(self, drift: float = 0.0, seed: int = 1, queue_s: float = 0.0) -> None:
        self.chance = random.Random(seed)
        self.queue_s = queue_s
        self.station_machine = SetClock(START_NS, 5 * NS_PER_S)
        self.unit_machine = SetClock(START_NS - 7 * DAY_NS, 900 * NS_PER_S, 1.0 + drift)
        self.station = SteadyClock(self.station_machine)
        self.clock = StationClock(self.unit_machine)
        self.linked = True

    def pass_s(self, duration_s: float) -> None:
        self.station_machine.pass_s(duration_s)
        self.unit_machine.pass_s(duration_s)

    def ask(self, on_reply: ReplyHandler) -> None:
        if not self.linked:
            return
        self.pass_s(self._delay_s())
        (answer,) = ClockServer(self.station).replies("", "", b"")
        self.pass_s(self._delay_s())
        on_reply(answer)
        on_reply(None)

    def run(self, seconds: float) -> None:
        end_ns = self.station_machine.monotonic_ns() + round(seconds * NS_PER_S)
        while self.station_machine.monotonic_ns() < end_ns:
            self.clock.turn(self.ask)
            self.pass_s(0.05)

    def error_s(self) -> float:
        return (self.clock.utc_ns() - self.station.utc_ns()) / NS_PER_S

    def _delay_s(self) -> float:
        return 0.015 + self.chance.expovariate(1.0) * self.queue_s


def test_clock_without_an_answer_keeps_the_machines_time() -> None:
    pair = UnitAndStation()
    pair.linked = False
    pair.run(30.0)
    assert pair.clock.utc_std_s() == 0.0
    assert pair.clock.utc_ns() == pair.unit_machine.utc_ns()


def test_a_unit_a_week_behind_stamps_in_the_station_s_time() -> None:
    pair = UnitAndStation()
    pair.run(30.0)
    assert abs(pair.error_s()) < 0.005
    assert pair.clock.machine_ahead_s() == pytest.approx(-7 * DAY_S, abs=0.01)
    header = HeaderFactory(U, 1, pair.clock, pair.clock.utc_std_s).header()
    assert header.utc_std_s > 0.0
    assert Header.from_wire(header.to_wire()).utc_std_s > 0.0


@pytest.mark.parametrize("drift", [-4e-5, 0.0, 4e-5])
def test_drift_is_estimated_and_applied_during_an_outage(drift: float) -> None:
    pair = UnitAndStation(drift, queue_s=0.002)
    pair.run(1200.0)
    estimate = pair.clock.estimate()
    assert estimate is not None
    assert estimate.drift == pytest.approx(-drift, abs=3e-6)
    pair.linked = False
    pair.run(600.0)
    assert abs(pair.error_s()) < 3.0 * pair.clock.utc_std_s() < 0.1


def test_stated_uncertainty_covers_errors_of_queueing_links() -> None:
    """Errors in standard deviations, over many units at a random time each."""
    squares = []
    for seed in range(60):
        pair = UnitAndStation(random.Random(seed).gauss(0.0, 2e-5), seed, queue_s=0.2)
        pair.run(5.0 + 300.0 * random.Random(-seed).random())
        squares.append((pair.error_s() / pair.clock.utc_std_s()) ** 2)
    assert sum(squares) / len(squares) < 1.5
    assert sum(square > 9.0 for square in squares) <= 2


def test_a_slow_exchange_among_quick_ones_hardly_counts() -> None:
    offset = ClockOffsetFilter()
    for number in range(10):
        t_ns = number * NS_PER_S
        offset.note(Exchange(t_ns, t_ns + 10_000_000, t_ns + 10_000_000, t_ns + 20_000_000))
    before = offset.at(10 * NS_PER_S)
    t_ns = 10 * NS_PER_S
    offset.note(Exchange(t_ns, t_ns + 10_000_000, t_ns + 10_000_000, t_ns + 4 * NS_PER_S))
    after = offset.at(14 * NS_PER_S)
    assert before is not None
    assert after is not None
    assert abs(after.offset_ns - before.offset_ns) < 2_000_000


def test_impossible_exchanges_are_not_used() -> None:
    offset = ClockOffsetFilter()
    assert not offset.note(Exchange(10, 0, 0, 5))
    assert not offset.note(Exchange(0, 20, 10, 50))
    assert offset.at(0) is None


def test_the_unit_follows_a_station_whose_clock_is_set_forward_by_a_day() -> None:
    pair = UnitAndStation()
    pair.run(60.0)
    pair.station_machine.set_utc_ahead(DAY_S)
    pair.run(60.0)
    assert abs(pair.error_s()) < 0.01


def test_station_and_unit_continue_after_the_stations_clock_is_set_back() -> None:
    pair = UnitAndStation()
    pair.run(60.0)
    stamps_ns = []
    pair.station_machine.set_utc_ahead(-DAY_S)
    for _ in range(20):
        pair.run(3.0)
        stamps_ns.append(pair.clock.utc_ns())
    assert stamps_ns == sorted(stamps_ns)
    assert abs(pair.error_s()) < 0.01


@pytest.mark.parametrize("by_s", [DAY_S, -DAY_S])
def test_unit_whose_own_clock_is_set_continues_in_the_stations_time(by_s: float) -> None:
    pair = UnitAndStation()
    pair.run(30.0)
    header_factory = HeaderFactory(U, 1, pair.clock, pair.clock.utc_std_s)
    before = header_factory.header()
    pair.unit_machine.set_utc_ahead(by_s)
    pair.run(1.0)
    after = header_factory.header()
    assert after.t_utc_ns - before.t_utc_ns == pytest.approx(1.05e9, rel=0.1)
    assert abs(pair.error_s()) < 0.005


class Walk:
    """A wearer who goes north, a position a second, with headers as a unit stamps them."""

    def __init__(self, script: Script, *, synced: bool) -> None:
        self.script = script
        self.synced = synced
        self.real_s = 0.0
        self.utc_wrong_ns = 0
        self.seq = 0

    def step(self, seconds: int) -> None:
        for _ in range(seconds):
            self.script.position(U, self.real_s, 0.0, header=self.header())
            self.script.tick()
            self.real_s += 1.0
            self.script.now_s += 1.0

    def header(self) -> Header:
        self.seq += 1
        if self.synced:
            return Header(U, 7, self.seq, self._mono_ns(), self.script.t_ns, utc_std_s=0.01)
        return Header(U, 7, self.seq, self._mono_ns(), self.script.t_ns + self.utc_wrong_ns)

    def _mono_ns(self) -> int:
        return round((4000.0 + self.real_s) * NS_PER_S)


@pytest.fixture(params=[False, True], ids=["unsynced", "synced"])
def walk(request: pytest.FixtureRequest) -> Walk:
    script = Script()
    script.register(U)
    return Walk(script, synced=request.param)


def position(north_m: float, header: Header) -> Position:
    spoken = Script()
    spoken.position(U, north_m, 0.0, header=header)
    return spoken.published(Position)[0]


def assert_in_order(script: Script) -> None:
    times_ns = [fused.t_meas_ns for fused in script.fused]
    norths_m = [fused.north_m for fused in script.fused]
    assert all(one <= following for one, following in pairwise(times_ns))
    assert norths_m == sorted(norths_m)
    assert all(f.t_meas_ns <= f.header.t_utc_ns for f in script.fused)


@pytest.mark.parametrize("by_s", [DAY_S, -DAY_S, 1e9])
def test_a_unit_s_wrong_utc_reorders_nothing(by_s: float) -> None:
    script = Script()
    script.register(U)
    walk = Walk(script, synced=False)
    walk.step(20)
    walk.utc_wrong_ns = round(by_s * NS_PER_S)
    walk.step(20)
    assert_in_order(script)
    assert len(script.fused) == 40
    assert script.fused[-1].t_meas_ns == script.t_ns - NS_PER_S


def test_station_set_forward_by_a_day_keeps_the_order_and_current_times(walk: Walk) -> None:
    walk.step(40)
    walk.script.now_s += DAY_S
    walk.step(60)
    assert_in_order(walk.script)
    fused = walk.script.fused[-1]
    assert fused.header.t_utc_ns - fused.t_meas_ns < NS_PER_S, "it is not shown as a day old"
    assert walk.script.pipeline.state.units[U].link == "live"


def test_backfilled_message_is_inserted_at_its_time(
    walk: Walk,
) -> None:
    script = walk.script
    walk.step(10)
    lost = []
    for _ in range(10):
        lost.append(position(walk.real_s, walk.header()))
        walk.real_s += 1.0
        script.now_s += 1.0
    walk.step(10)
    before = list(script.pipeline.state.units[U].trails.shown)
    for one in reversed(lost):
        script.record(backfilled_key(U, POSITION.suffix), encode(one))
    trail = script.pipeline.state.units[U].trails.shown
    assert len(trail) > len(before)
    assert [step.t_ns for step in trail] == sorted(step.t_ns for step in trail)
    assert [step.north_m for step in trail] == sorted(step.north_m for step in trail)


def test_heartbeat_reports_offset_uncertainty_and_drift_of_the_clock() -> None:
    reported = Heartbeat(Header(U, 1, 1, 1), 1, 9, -604_800.25, 0.0021, -4.2e-5)
    received = Heartbeat.from_wire(reported.to_wire())
    assert received.clock_ahead_s == pytest.approx(-604_800.25)
    assert received.clock_std_s == pytest.approx(0.0021)
    assert received.clock_drift == pytest.approx(-4.2e-5)
