from __future__ import annotations

import pytest

from base_station.core.units.thermal_dose import dose_of
from base_station.report.contents import Interval
from base_station.report.log_facts import LogFacts, read_facts, wanted_keys
from shared.channels import POSITION, TEMPERATURE, backfilled_key
from shared.clock import NS_PER_S
from shared.codec import encode
from shared.messages import CommandState, EventKind, Temperature
from tests.rig.station_script import START_NS, Script

UNIT = "FF-01"


def at(second: float) -> int:
    return START_NS + round(second * NS_PER_S)


def facts_of(script: Script, *wearings: Interval, about: tuple[Interval, ...] = ()) -> LogFacts:
    during = Interval(at(0.0), script.t_ns)
    worn = {UNIT: list(wearings) or [during]}
    return read_facts(script.records, during, worn, {UNIT: about}, lambda _: None)


def test_silence_of_more_than_ten_seconds_is_a_radio_gap_to_the_end_too():
    script = Script()
    for silent_s in (0.0, 10.0, 30.0):
        script.now_s += silent_s
        script.status(UNIT)
    script.now_s += 60.0
    (gap, last) = facts_of(script).units[UNIT].radio_gaps
    assert gap == Interval(at(10.0), at(40.0))
    assert last == Interval(at(40.0), at(100.0))


def test_a_unit_that_was_switched_off_has_no_gap():
    script = Script()
    script.status(UNIT)
    script.event(UNIT, EventKind.STOPPED)
    script.now_s += 60.0
    assert facts_of(script).units[UNIT].radio_gaps == []


def test_backfilled_messages_are_no_radio_contact_but_heat():
    script = Script()
    script.temperature(UNIT, 120.0)
    headers = []
    for _ in range(30):
        script.now_s += 1.0
        headers.append(script.header(UNIT))
    key = backfilled_key(UNIT, TEMPERATURE.suffix)
    for header in headers[:-1]:
        script.record(key, encode(Temperature(header, 120.0)))
    script.temperature(UNIT, 120.0)
    script.now_s += 1.0
    unit = facts_of(script).units[UNIT]
    assert unit.radio_gaps == [Interval(at(0.0), at(30.0))]
    assert unit.doses[0] == pytest.approx(dose_of(120.0, 30.0))


def test_heat_belongs_to_the_wearer_at_its_time():
    script = Script()
    for degc in (200.0, 200.0, 30.0, 31.0):
        script.temperature(UNIT, degc)
        script.now_s += 1.0
    unit = facts_of(script, Interval(at(0.0), at(2.0)), Interval(at(2.0), at(4.0))).units[UNIT]
    assert unit.hottest == {0: (at(0.0), 200.0), 1: (at(3.0), 31.0)}
    assert unit.doses == {0: pytest.approx(dose_of(200.0, 1.0)), 1: 0.0}


def test_series_are_kept_around_alarms_only():
    script = Script()
    for second in range(100):
        script.now_s = float(second)
        script.status(UNIT, motionless_s=float(second))
    about = Interval(at(40.0), at(42.0))
    unit = facts_of(script, about=(about,)).units[UNIT]
    assert unit.motionless_s == [(at(one), float(one)) for one in (40, 41, 42)]
    assert unit.received_ns == [at(one) for one in (40, 41, 42)]


def test_orders_are_followed_to_the_answer():
    script = Script()
    script.command(UNIT, "c1")
    script.now_s = 4.0
    script.reply(UNIT, "c1", CommandState.ACKNOWLEDGED)
    facts = facts_of(script)
    assert facts.commands == {"c1": {UNIT: at(0.0)}}
    (reply,) = facts.replies
    assert (reply.t_ns, reply.command_id, reply.state) == (at(4.0), "c1", CommandState.ACKNOWLEDGED)


def test_positions_are_not_read():
    assert POSITION.key(UNIT) not in wanted_keys([UNIT])
    assert TEMPERATURE.key(UNIT) in wanted_keys([UNIT])
