"""Acknowledgement of a mayday, sent to the wearer."""

from __future__ import annotations

import pytest

from base_station.core.checkpoint import read_checkpoint
from base_station.core.commands.command_tracker import open_orders
from base_station.core.events import CommandChanged
from base_station.core.pipeline import StationPipeline
from base_station.core.state.command import Order, SentCommand
from base_station.fusion import FUSERS
from shared.messages import AlarmState, CommandKind, CommandState, EventKind
from shared.messages.station import (
    AcknowledgeAlarm,
    Assign,
    CloseIncident,
    OpenIncident,
    ResolveAlarm,
    Unassign,
)
from tests.rig import message_factory
from tests.rig.station_script import Script

U = "FF-01"


def called() -> Script:
    script = Script()
    script.register(U)
    script.act(Assign(U, "p1", "Person 1", "red", ""))
    script.say(message_factory.description(script.header(U), outputs=("speech",)))
    script.event(U, EventKind.MAYDAY)
    return script


def acknowledge(script: Script, rule: str = "mayday") -> list[object]:
    newest = [one for one in script.alarms if one.rule == rule][-1]
    return list(script.act(AcknowledgeAlarm(newest.alarm_id), by="ada"))


def orders(script: Script) -> list[Order]:
    return list(open_orders(script.pipeline.state))


def commands(script: Script) -> list[SentCommand]:
    return list(script.pipeline.state.commands.values())


def test_acknowledged_mayday_is_sent_until_an_output_has_played_it() -> None:
    script = called()
    assert orders(script) == []
    outputs = acknowledge(script)
    (order,) = orders(script)
    assert CommandChanged(order.command_id) in outputs
    (event,) = [one for one in script.alarms if one.rule == "mayday"][:1]
    assert event.state is AlarmState.RAISED
    assert (order.kind, order.unit_id, order.issued_by) == (
        CommandKind.MAYDAY_ACKNOWLEDGED, U, "ada",
    )  # fmt: skip
    assert (order.mayday_boot_id, order.mayday_seq) == (7, 2)
    script.reply(U, order.command_id, CommandState.RECEIVED)
    assert orders(script) == []
    assert commands(script)[0].is_open
    script.reply(U, order.command_id, CommandState.NOTIFIED)
    assert not commands(script)[0].is_open


def test_mayday_known_by_the_status_alone_is_acknowledged_by_that() -> None:
    script = Script()
    script.register(U)
    script.status(U, mayday=True)
    acknowledge(script)
    (order,) = orders(script)
    assert (order.mayday_boot_id, order.mayday_seq) == (7, 1)


def test_acknowledgement_waits_for_the_link() -> None:
    script = called()
    acknowledge(script)
    script.wait(3600)
    assert [one.kind for one in orders(script)] == [CommandKind.MAYDAY_ACKNOWLEDGED]


@pytest.mark.parametrize("how", ["event", "status", "called again"])
def test_acknowledgement_of_an_ended_mayday_is_not_sent_again(how: str) -> None:
    script = called()
    acknowledge(script)
    script.now_s += 5.0
    if how == "event":
        script.event(U, EventKind.MAYDAY_CANCELLED)
    elif how == "status":
        script.status(U, mayday=False)
    else:
        script.event(U, EventKind.MAYDAY)
    script.tick()
    assert orders(script) == []
    (over,) = commands(script)
    assert (over.is_open, over.state_of(over.deliveries[U])) == (False, "expired")
    assert over.deliveries[U].reason


def test_next_mayday_is_acknowledged_again() -> None:
    script = called()
    acknowledge(script)
    script.now_s += 5.0
    script.event(U, EventKind.MAYDAY)
    acknowledge(script)
    script.tick()
    (order,) = orders(script)
    assert order.mayday_seq == 3


def test_mayday_cancelled_by_the_wearer_is_not_acknowledged() -> None:
    script = called()
    script.event(U, EventKind.MAYDAY_CANCELLED)
    acknowledge(script)
    assert commands(script) == []


def test_mayday_of_a_former_wearer_is_not_acknowledged_to_another() -> None:
    script = called()
    script.now_s += 5.0
    script.act(Unassign(U))
    script.act(Assign(U, "p2", "Person 2", "red", ""))
    script.now_s += 5.0
    first = next(one for one in script.alarms if one.rule == "mayday")
    script.event(U, EventKind.MAYDAY)
    script.act(AcknowledgeAlarm(first.alarm_id), by="ada")
    assert commands(script) == []


def test_resolution_sends_no_command() -> None:
    script = called()
    script.act(ResolveAlarm(script.alarms[-1].alarm_id, "spoke to him"))
    assert commands(script) == []


def test_acknowledgement_ends_with_its_incident() -> None:
    script = called()
    script.act(OpenIncident("i1", "Mill Lane"))
    acknowledge(script)
    script.act(CloseIncident("i1"))
    assert orders(script) == []


def test_restarted_station_still_sends_it() -> None:
    script = called()
    acknowledge(script)
    checkpoint = read_checkpoint(script.pipeline.checkpoint())
    assert checkpoint is not None
    again = StationPipeline((), FUSERS[0], checkpoint)
    assert open_orders(again.state) == tuple(orders(script))
