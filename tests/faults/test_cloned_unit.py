"""Duplicate devices under one name are distinguished from restarts and from old messages."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from base_station.storage.db.known_people import person_lookup
from base_station.views.units import unit_views
from shared.clock import NS_PER_S
from shared.messages import AlarmState, Header, Position
from shared.messages.station import ResolveAlarm
from tests.rig.station_script import Script

U = "FF-01"


@dataclass
class Machine:
    """One of those that speak as U: a boot of its own, a clock of its own."""

    script: Script
    boot_id: int
    clock_ahead_s: float
    seq: int = 0

    def header(self, captured_s: float | None = None) -> Header:
        self.seq += 1
        captured_s = self.script.now_s if captured_s is None else captured_s
        return Header(
            U, self.boot_id, self.seq, round((captured_s + self.clock_ahead_s) * NS_PER_S)
        )

    def walk(self, north_m: float, header: Header | None = None) -> None:
        self.script.position(U, north_m, 0.0, header=header or self.header())


@pytest.fixture
def script() -> Script:
    script = Script()
    script.register(U)
    return script


def both_walk(script: Script, one: Machine, other: Machine, seconds: float) -> None:
    end_s = script.now_s + seconds
    while script.now_s < end_s:
        one.walk(1.0)
        other.walk(-1.0)
        script.now_s += 0.5
        script.tick()


def alarms(script: Script) -> list[AlarmState]:
    return [alarm.state for alarm in script.alarms if alarm.rule == "cloned-unit"]


def is_shown_as_cloned(script: Script) -> bool:
    state = script.pipeline.state
    return unit_views(state, [state.units[U]], person_lookup({}))[0].cloned


@pytest.fixture
def pair(script: Script) -> tuple[Machine, Machine]:
    first, second = Machine(script, 11, 500.0), Machine(script, 22, 70.0)
    for _ in range(10):
        first.walk(1.0)
        script.now_s += 0.5
    return first, second


def test_two_simultaneous_devices_raise_an_alarm(
    script: Script, pair: tuple[Machine, Machine]
) -> None:
    both_walk(script, *pair, seconds=10.0)
    assert alarms(script) == [AlarmState.RAISED]
    assert is_shown_as_cloned(script)
    (alarm,) = (one for one in script.alarms if one.rule == "cloned-unit")
    assert "two devices report" in alarm.text


def test_both_paths_are_kept_and_only_one_is_shown(
    script: Script, pair: tuple[Machine, Machine]
) -> None:
    both_walk(script, *pair, seconds=10.0)
    reported = script.published(Position)
    assert {p.header.boot_id for p in reported if p.north_m < 0.0} == {22}
    assert {p.header.boot_id for p in reported if p.north_m > 0.0} == {11}
    unit = script.pipeline.state.units[U]
    assert unit.position is not None
    assert unit.position.header.boot_id == 22
    shown = {round(fused.north_m) for fused in script.fused[-15:]}
    assert len(shown) == 1, "it does not jump between the two"


def test_alarm_is_resolved_when_one_device_is_gone(
    script: Script, pair: tuple[Machine, Machine]
) -> None:
    first, second = pair
    both_walk(script, first, second, seconds=10.0)
    for _ in range(90):
        first.walk(1.0)
        script.now_s += 0.5
        script.tick()
    assert alarms(script) == [AlarmState.RAISED, AlarmState.RESOLVED]
    assert not is_shown_as_cloned(script)
    unit = script.pipeline.state.units[U]
    assert unit.position is not None
    assert unit.position.header.boot_id == 11, "the one that is left is shown"


def test_silence_of_both_devices_resolves_nothing(
    script: Script, pair: tuple[Machine, Machine]
) -> None:
    both_walk(script, *pair, seconds=10.0)
    script.wait(120)
    assert alarms(script) == [AlarmState.RAISED]


def test_alarm_is_resolved_by_an_operator(script: Script, pair: tuple[Machine, Machine]) -> None:
    both_walk(script, *pair, seconds=10.0)
    (alarm,) = (one for one in script.alarms if one.rule == "cloned-unit")
    script.act(ResolveAlarm(alarm.alarm_id, "the spare is switched off"))
    both_walk(script, *pair, seconds=10.0)
    assert alarms(script) == [AlarmState.RAISED, AlarmState.RESOLVED]


def test_repeatedly_restarted_unit_is_one_device(script: Script) -> None:
    for boot_id in range(1, 20):
        machine = Machine(script, boot_id, 900.0 - script.now_s)
        for _ in range(20):
            machine.walk(1.0)
            script.now_s += 0.5
            script.tick()
        script.now_s += 1.0
    assert alarms(script) == []


def test_late_messages_of_the_previous_boot_are_no_second_device(script: Script) -> None:
    """Messages queued in a failing link arrive after the first ones of the next boot."""
    before = Machine(script, 1, 0.0)
    for _ in range(20):
        before.walk(1.0)
        script.now_s += 0.5
    queued = [before.header(script.now_s + 0.2 * number) for number in range(20)]
    script.now_s += 6.0
    after = Machine(script, 2, 900.0 - script.now_s)
    for header in queued:
        after.walk(1.0)
        before.walk(1.0, header)
        script.now_s += 0.5
        script.tick()
    assert alarms(script) == []


def test_repeated_or_backdated_message_is_no_second_device(script: Script) -> None:
    recorded = Machine(script, 1, 0.0)
    unheard = [recorded.header(0.5 * number) for number in range(100)]
    for header in unheard[:50]:
        recorded.walk(1.0, header)
        script.now_s += 0.5
    now = Machine(script, 2, 300.0)
    for header in unheard:  # half of them were never heard at the time
        now.walk(-1.0)
        recorded.walk(1.0, header)
        script.now_s += 0.5
        script.tick()
    for header in [now.header(-200.0 + 0.5 * number) for number in range(40)]:
        recorded.walk(1.0, header)
        script.now_s += 0.5
        script.tick()
    assert alarms(script) == []


def test_recording_of_an_unknown_boot_is_no_second_device(script: Script) -> None:
    """The unit knew the station's time, so its messages say how old they are."""
    machine = Machine(script, 1, 0.0)
    old_ns = script.t_ns - 3600 * NS_PER_S
    for number in range(60):
        machine.walk(1.0)
        t_ns = old_ns + number * NS_PER_S // 2
        header = Header(U, 9, number + 1, t_ns, t_utc_ns=t_ns, utc_std_s=0.01)
        script.position(U, -5.0, 0.0, header=header)
        script.now_s += 0.5
        script.tick()
    assert alarms(script) == []
    machine.walk(1.0)
    unit = script.pipeline.state.units[U]
    assert unit.position is not None
    assert unit.position.header.boot_id == 1, "and does not take its place"
