"""Stages of a unit's message: repeats end, unregistered units are bounded, agents report for
units.
"""

from __future__ import annotations

import pytest

from base_station.core import unit_messages
from base_station.core.events import UnitChanged
from shared.channels import NO_TRACKER, tracker_id
from shared.messages import EventKind, FusedPosition
from tests.rig import message_factory
from tests.rig.station_script import Script

U = "FF-01"
AGENT = tracker_id(U)


@pytest.fixture
def script() -> Script:
    script = Script()
    script.register(U)
    return script


def test_position_gives_location_before_change_of_unit(script: Script) -> None:
    kinds = [type(output) for output in script.position(U, 1.0, 2.0)]
    assert kinds == [FusedPosition, UnitChanged]


def test_repeated_message_ends_at_order(script: Script) -> None:
    status = message_factory.status(script.header(U))
    assert script.say(status) != []
    assert script.say(status) == []
    assert script.pipeline.state.units[U].duplicates == 1


def test_status_waits_unless_link_changes(script: Script) -> None:
    (first,), (second,) = script.status(U), script.status(U)
    assert isinstance(first, UnitChanged)
    assert isinstance(second, UnitChanged)
    assert (first.soon, second.soon) == (True, False)


def test_unregistered_units_beyond_limit_are_counted_only(
    script: Script, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(unit_messages, "MAX_UNREGISTERED", 1)
    script.status("stranger-1")
    assert script.status("stranger-2") == []
    state = script.pipeline.state
    assert (set(state.units), state.counts.unregistered_dropped) == ({U, "stranger-1"}, 1)


def test_agent_gives_positions_and_falls_of_unit_without_tracker(script: Script) -> None:
    script.say(message_factory.description(script.header(U), tracker=NO_TRACKER))
    unit = script.pipeline.state.units[U]
    assert any(isinstance(one, FusedPosition) for one in script.position(AGENT, 1.0, 2.0))
    script.event(AGENT, EventKind.MAYDAY)
    script.event(AGENT, EventKind.FALL)
    assert unit.fall.t_ns == script.t_ns
    assert unit.mayday.t_ns is None


def test_agent_of_unit_with_tracker_reports_only_its_own_faults(script: Script) -> None:
    script.say(message_factory.description(script.header(U), tracker="eskf"))
    unit = script.pipeline.state.units[U]
    assert script.position(AGENT, 1.0, 2.0) == []
    assert script.event(AGENT, EventKind.SENSOR_FAULT, "no samples") == []
    assert unit.position is None
    assert unit.fault is None
    assert unit.tracker is not None
    assert unit.tracker.fault is not None
