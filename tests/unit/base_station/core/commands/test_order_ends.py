"""Ends of orders: an order that was answered by radio, or whose incident was closed, ends in the
unit too.
"""

from __future__ import annotations

import pytest

from base_station.core.commands.command_tracker import CLOSED_KEPT, open_orders
from base_station.core.events import CommandChanged, Refused
from base_station.core.state.command import Delivery, Order
from shared.channels import COMMAND
from shared.codec import encode
from shared.coded_text import NO_CODE, coded
from shared.messages import STATION_ID, Command, CommandKind, CommandState
from shared.messages.station import (
    CloseIncident,
    ConfirmCommand,
    OpenIncident,
    SendCommand,
    UndoConfirmation,
)
from tests.rig import message_factory
from tests.rig.station_script import Script

U = "FF-01"
LASTS_S = 60.0


def sent(kind: CommandKind = CommandKind.EVACUATE) -> Script:
    """A sent order of an incident."""
    script = Script()
    script.register(U)
    script.say(message_factory.description(script.header(U), outputs=("led",)))
    script.act(OpenIncident("i1", "Mill Lane"))
    script.act(SendCommand("c1", kind, U, "", False, "hi", 0.0, LASTS_S))
    script.command(U, "c1")
    return script


def orders(script: Script) -> list[Order]:
    return list(open_orders(script.pipeline.state))


def delivery(script: Script) -> Delivery:
    return script.pipeline.state.commands["c1"].deliveries[U]


def send_end(script: Script) -> Order:
    """The station sends its pending ends, and receives its own messages."""
    (end,) = orders(script)
    assert end.kind is CommandKind.END_ORDER
    command = Command(
        script.header(STATION_ID), end.command_id, end.kind, end.issued_by, end.expires_ns,
        ended_command_id=end.ended_command_id,
    )  # fmt: skip
    script.record(COMMAND.key(U), encode(command))
    return end


@pytest.mark.parametrize("reply", [CommandState.RECEIVED, CommandState.REFUSED])
def test_answer_by_radio_is_sent_to_the_unit_until_it_replies(reply: CommandState) -> None:
    """A unit of an earlier version refuses it."""
    script = sent()
    script.reply(U, "c1", CommandState.NOTIFIED)
    script.act(ConfirmCommand("c1", U), by="ada")
    end = send_end(script)
    assert (end.ended_command_id, end.unit_id, end.issued_by) == ("c1", U, "ada")
    assert end.command_id != "c1", "a unit answers each id once"
    assert orders(script) == [end]
    script.reply(U, end.command_id, reply)
    assert orders(script) == []
    assert script.pipeline.state.commands["c1"].state_of(delivery(script)) == "acknowledged"


def test_unsent_order_needs_no_end() -> None:
    script = Script()
    script.register(U)
    script.act(SendCommand("c1", CommandKind.EVACUATE, U, "", False, "", 0.0, LASTS_S))
    script.act(ConfirmCommand("c1", U))
    assert orders(script) == []
    script.command(U, "c1")  # it was in transit
    assert [one.kind for one in orders(script)] == [CommandKind.END_ORDER]


def test_order_answered_by_the_wearer_needs_no_end() -> None:
    script = sent()
    script.reply(U, "c1", CommandState.ACKNOWLEDGED)
    assert orders(script) == []


def test_expired_order_needs_no_end() -> None:
    script = sent()
    script.reply(U, "c1", CommandState.RECEIVED)
    script.act(ConfirmCommand("c1", U))
    script.now_s += LASTS_S
    script.tick()
    assert orders(script) == []


def test_order_of_a_closed_incident_ends() -> None:
    script = sent()
    script.reply(U, "c1", CommandState.NOTIFIED)
    script.act(CloseIncident("i1"))
    end = send_end(script)
    script.reply(U, end.command_id, CommandState.RECEIVED)
    assert orders(script) == []


def test_undone_answer_is_ordered_again_and_can_end_again() -> None:
    script = sent()
    script.reply(U, "c1", CommandState.NOTIFIED)
    script.act(ConfirmCommand("c1", U))
    first = send_end(script)
    script.reply(U, first.command_id, CommandState.RECEIVED)
    script.act(UndoConfirmation("c1", U))
    assert [(one.command_id, one.kind) for one in orders(script)] == [("c1", CommandKind.EVACUATE)]
    script.command(U, "c1")
    script.reply(U, "c1", CommandState.NOTIFIED)
    assert orders(script) == []
    script.now_s += 1.0
    script.act(ConfirmCommand("c1", U))
    assert send_end(script).command_id != first.command_id


def test_end_sent_while_its_answer_is_undone_is_corrected() -> None:
    script = sent()
    script.reply(U, "c1", CommandState.NOTIFIED)
    script.act(ConfirmCommand("c1", U))
    (end,) = orders(script)
    script.act(UndoConfirmation("c1", U))
    assert orders(script) == [], "the unit has it, and nothing has ended it"
    late = Command(
        script.header(STATION_ID), end.command_id, end.kind, "chief", end.expires_ns,
        ended_command_id="c1",
    )  # fmt: skip
    script.record(COMMAND.key(U), encode(late))
    assert [one.command_id for one in orders(script)] == ["c1"]


def test_many_later_orders_displace_no_pending_end() -> None:
    script = sent()
    script.reply(U, "c1", CommandState.NOTIFIED)
    script.act(ConfirmCommand("c1", U))
    for number in range(2 * CLOSED_KEPT):
        name = f"later{number}"
        script.act(SendCommand(name, CommandKind.LOCATE, U, "", False, "", 0.0, LASTS_S))
        script.reply(U, name, CommandState.NOTIFIED)
    assert [one.ended_command_id for one in orders(script)] == ["c1"]


def stop(command_id: str = "c1") -> SendCommand:
    kind = CommandKind.END_ORDER
    return SendCommand("s1", kind, "", "", True, "", 0.0, LASTS_S, ended_command_id=command_id)


def test_locate_signal_is_stopped_in_the_unit() -> None:
    script = sent(CommandKind.LOCATE)
    script.reply(U, "c1", CommandState.NOTIFIED, "sound")
    script.act(stop())
    command = script.pipeline.state.commands["c1"]
    assert (command.is_open, command.state_of(delivery(script))) == (False, "notified")
    end = send_end(script)
    script.now_s += 1.0
    outputs = script.reply(U, end.command_id, CommandState.RECEIVED)
    assert CommandChanged("c1") in outputs, "the console shows that it has stopped"
    assert (orders(script), delivery(script).ended_ns) == ([], script.t_ns)


@pytest.mark.parametrize("kind", [CommandKind.EVACUATE, CommandKind.LOCATE])
def test_only_an_active_signal_is_stopped(kind: CommandKind) -> None:
    script = sent(kind)
    script.reply(U, "c1", CommandState.ACKNOWLEDGED)
    for command_id in ("c1", "none"):
        (refused,) = script.act(stop(command_id))
        assert isinstance(refused, Refused)


def test_reason_of_a_refusal_keeps_the_code_of_the_unit_and_a_foreign_one_has_none() -> None:
    script = sent(CommandKind.LOCATE)
    script.reply(U, "c1", CommandState.REFUSED, coded("refused-no-output", "no sounder"))
    delivery = script.pipeline.state.commands["c1"].deliveries[U]
    assert (delivery.reason, delivery.reason_code.code) == ("no sounder", "refused-no-output")
    foreign = sent(CommandKind.LOCATE)
    foreign.reply(U, "c1", CommandState.REFUSED, "kaputt")
    delivery = foreign.pipeline.state.commands["c1"].deliveries[U]
    assert (delivery.reason, delivery.reason_code) == ("kaputt", NO_CODE)


def test_withdrawn_order_has_the_code_of_its_reason() -> None:
    script = sent()
    script.act(CloseIncident("i1"))
    delivery = script.pipeline.state.commands["c1"].deliveries[U]
    assert delivery.reason == "its incident was closed"
    assert delivery.reason_code.code == "order-withdrawn"
