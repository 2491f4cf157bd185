"""Acknowledgement of an alarm, sent to the wearer."""

from __future__ import annotations

import pytest

from base_station.core.commands.alarm_acknowledgements import ALARM_OVER
from base_station.core.commands.command_tracker import open_orders
from base_station.core.state.command import Order, SentCommand
from shared.messages import CommandKind, CommandState, EventKind
from shared.messages.station import AcknowledgeAlarm, Assign, ResolveAlarm, Unassign
from tests.rig import message_factory
from tests.rig.station_script import Script

U = "FF-01"


def fallen() -> Script:
    script = Script()
    script.register(U)
    script.act(Assign(U, "p1", "Person 1", "red", ""))
    script.say(message_factory.description(script.header(U), outputs=("speech",)))
    script.now_s += 5.0
    script.event(U, EventKind.FALL)
    return script


def acknowledge(script: Script) -> None:
    script.act(AcknowledgeAlarm(script.alarms[-1].alarm_id), by="ada")


def orders(script: Script) -> list[Order]:
    return list(open_orders(script.pipeline.state))


def commands(script: Script) -> list[SentCommand]:
    return list(script.pipeline.state.commands.values())


def test_acknowledgement_is_sent_until_an_output_has_played_it() -> None:
    script = fallen()
    assert orders(script) == []
    acknowledge(script)
    (order,) = orders(script)
    assert (order.kind, order.unit_id, order.issued_by) == (
        CommandKind.ALARM_ACKNOWLEDGED, U, "ada",
    )  # fmt: skip
    script.reply(U, order.command_id, CommandState.RECEIVED)
    assert (orders(script), commands(script)[0].is_open) == ([], True)
    script.reply(U, order.command_id, CommandState.NOTIFIED)
    assert not commands(script)[0].is_open


def test_acknowledgement_lasts_with_the_alarm_and_waits_for_the_link() -> None:
    script = fallen()
    acknowledge(script)
    script.wait(600)
    assert len(orders(script)) == 1


@pytest.mark.parametrize("how", ["resolved", "raised anew"])
def test_acknowledgement_ends_with_the_alarm(how: str) -> None:
    script = fallen()
    acknowledge(script)
    script.now_s += 5.0
    if how == "resolved":
        script.act(ResolveAlarm(script.alarms[-1].alarm_id, "", reason="false_alarm"))
    else:
        script.event(U, EventKind.FALL)
    script.tick()
    assert orders(script) == []
    (over,) = commands(script)
    assert (over.is_open, over.deliveries[U].reason) == (False, ALARM_OVER)


def test_alarm_of_a_former_wearer_or_about_the_unit_sends_no_command() -> None:
    script = fallen()
    script.now_s += 5.0
    script.act(Unassign(U))
    script.act(Assign(U, "p2", "Person 2", "red", ""))
    fall = next(one for one in script.alarms if one.rule == "fall")
    script.act(AcknowledgeAlarm(fall.alarm_id), by="ada")
    script.status(U, battery=0.05)
    acknowledge(script)
    assert script.alarms[-1].rule == "battery"
    assert commands(script) == []
