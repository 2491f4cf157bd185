"""Received means in the unit, notified means that an output has run; and units without outputs."""

from __future__ import annotations

from itertools import permutations

import msgspec
import pytest

from base_station.core.checkpoint import read_checkpoint
from base_station.core.commands.command_tracker import open_orders
from base_station.core.events import CommandChanged, Output
from base_station.core.state.command import Delivery
from shared.channels import DESCRIPTION, REPLY, backfilled_key
from shared.codec import encode
from shared.messages import CommandKind, CommandReply, CommandState
from shared.messages.station import (
    CloseIncident,
    ConfirmCommand,
    OpenIncident,
    SendCommand,
    UndoConfirmation,
)
from tests.rig import message_factory
from tests.rig.station_script import START_NS, Script

U = "FF-01"
RECEIVED, NOTIFIED = CommandState.RECEIVED, CommandState.NOTIFIED
ACKNOWLEDGED = CommandState.ACKNOWLEDGED


def sent(
    kind: CommandKind = CommandKind.EVACUATE, outputs: tuple[str, ...] | None = None
) -> Script:
    """A command to one unit, which has described its outputs where ``outputs`` are given."""
    script = Script()
    script.register(U)
    if outputs is not None:
        describe(script, outputs)
    script.act(SendCommand("c1", kind, U, "", False, "hi", 5.0, 60.0))
    return script


def describe(script: Script, outputs: tuple[str, ...]) -> list[Output]:
    return script.say(message_factory.description(script.header(U), outputs=outputs))


def delivery(script: Script) -> Delivery:
    return script.pipeline.state.commands["c1"].deliveries[U]


def state(script: Script) -> str:
    return script.pipeline.state.commands["c1"].state_of(delivery(script))


def is_open(script: Script) -> bool:
    return script.pipeline.state.commands["c1"].is_open


def test_states_are_received_notified_and_acknowledged() -> None:
    script = sent(outputs=("led",))
    seen = []
    for reply in (RECEIVED, NOTIFIED, ACKNOWLEDGED):
        script.now_s += 1.0
        assert CommandChanged("c1") in script.reply(U, "c1", reply)
        seen.append((state(script), is_open(script)))
    assert seen == [("received", True), ("notified", True), ("acknowledged", False)]
    one = delivery(script)
    assert [one.received_ns, one.notified_ns, one.acknowledged_ns] == [
        START_NS + second * 10**9 for second in (1, 2, 3)
    ]


@pytest.mark.parametrize("replies", list(permutations([RECEIVED, NOTIFIED, ACKNOWLEDGED])))
def test_answers_in_any_order_give_the_same_state(
    replies: tuple[CommandState, ...],
) -> None:
    script = sent()
    for reply in replies:
        script.now_s += 1.0
        script.reply(U, "c1", reply)
    one = delivery(script)
    assert state(script) == "acknowledged"
    assert one.received_ns == START_NS + 10**9, "whichever came first tells that the unit has it"
    assert one.notified_ns == START_NS + (1 + replies.index(NOTIFIED)) * 10**9
    assert one.acknowledged_ns == START_NS + (1 + replies.index(ACKNOWLEDGED)) * 10**9


def test_notified_implies_received() -> None:
    script = sent()
    script.reply(U, "c1", NOTIFIED)
    assert delivery(script).received_ns == script.t_ns
    assert not open_orders(script.pipeline.state)
    assert CommandChanged("c1") not in script.reply(U, "c1", RECEIVED)
    assert state(script) == "notified"


def test_acknowledged_does_not_imply_notified() -> None:
    script = sent()
    script.reply(U, "c1", ACKNOWLEDGED)
    assert delivery(script).received_ns == script.t_ns
    assert delivery(script).notified_ns is None


def test_second_output_changes_nothing() -> None:
    script = sent()
    script.reply(U, "c1", NOTIFIED)
    before = repr(script.pipeline.state.commands)
    script.now_s += 1.0
    assert CommandChanged("c1") not in script.reply(U, "c1", NOTIFIED)
    assert repr(script.pipeline.state.commands) == before


def test_backfilled_answer_counts() -> None:
    script = sent()
    reply = CommandReply(script.header(U), "c1", NOTIFIED)
    script.status(U)
    script.record(backfilled_key(U, REPLY.suffix), encode(reply))
    assert state(script) == "notified"


def test_notified_wearer_without_answer_in_time_has_not_answered() -> None:
    script = sent(outputs=("led",))
    script.reply(U, "c1", NOTIFIED)
    script.wait(61)
    assert (state(script), is_open(script)) == ("expired", False)


def test_undone_answer_by_radio_keeps_the_states_of_the_unit() -> None:
    script = sent(outputs=("led",))
    script.reply(U, "c1", NOTIFIED)
    script.act(ConfirmCommand("c1", U))
    assert state(script) == "acknowledged"
    script.act(UndoConfirmation("c1", U))
    assert state(script) == "notified"


@pytest.mark.parametrize(
    ("outputs", "after_received"), [(("led", "beeper"), True), ((), False), (None, False)]
)
def test_locate_signal_lasts_until_it_is_stopped(
    outputs: tuple[str, ...] | None, after_received: bool
) -> None:
    script = sent(CommandKind.LOCATE, outputs)
    script.reply(U, "c1", RECEIVED)
    assert is_open(script) is after_received
    assert not open_orders(script.pipeline.state), "it is not sent again for that"
    script.reply(U, "c1", NOTIFIED)
    assert (state(script), is_open(script)) == ("notified", True)
    script.reply(U, "c1", ACKNOWLEDGED)
    assert (state(script), is_open(script)) == ("acknowledged", False)


def test_locate_signal_that_is_not_stopped_ends_with_its_time() -> None:
    script = sent(CommandKind.LOCATE, ("led", "beeper"))
    signals = []
    for detail in ("light", "light", "sound", "light"):
        script.reply(U, "c1", NOTIFIED, detail)
        signals.append(delivery(script).signal)
    assert signals == ["light", "light", "sound", "sound"]
    script.wait(61)
    assert (state(script), is_open(script)) == ("notified", False)


def test_locate_does_not_wait_for_an_output_for_ever() -> None:
    script = sent(CommandKind.LOCATE, ("led",))
    script.reply(U, "c1", RECEIVED)
    script.wait(61)
    assert (state(script), is_open(script)) == ("received", False)


def test_position_rate_is_done_when_received() -> None:
    script = sent(CommandKind.SET_POSITION_RATE, ("led",))
    script.reply(U, "c1", RECEIVED)
    assert not is_open(script)


def test_closed_incident_ends_the_wait_for_an_output() -> None:
    script = sent(outputs=("led",))
    script.act(OpenIncident("i1", "Mill Lane"))
    script.act(SendCommand("c2", CommandKind.LOCATE, U, "", False, "", 0.0, 60.0))
    script.reply(U, "c2", RECEIVED)
    script.act(CloseIncident("i1"))
    assert not script.pipeline.state.commands["c2"].is_open


def test_later_description_of_outputs_counts_while_a_delivery_is_open() -> None:
    script = sent()
    assert delivery(script).can_be_notified is None
    assert CommandChanged("c1") in describe(script, ())
    assert delivery(script).can_be_notified is False
    assert CommandChanged("c1") not in describe(script, ()), "said every minute"
    describe(script, ("beeper",))
    assert delivery(script).can_be_notified is True
    script.reply(U, "c1", ACKNOWLEDGED)
    assert CommandChanged("c1") not in describe(script, ())
    assert delivery(script).can_be_notified is True, "as it was when it was carried out"


def test_backfilled_description_changes_nothing() -> None:
    script = sent()
    old = message_factory.description(script.header(U))
    describe(script, ("led",))
    script.record(backfilled_key(U, DESCRIPTION.suffix), encode(old))
    assert delivery(script).can_be_notified is True
    assert script.pipeline.state.units[U].can_be_notified is True


def test_checkpoint_of_an_earlier_version_opens() -> None:
    script = sent(outputs=("led",))
    script.reply(U, "c1", RECEIVED)
    saved = msgspec.msgpack.decode(script.pipeline.checkpoint())
    of_unit = saved["state"]["commands"]["c1"]["deliveries"][U]
    del of_unit["notified_ns"], of_unit["can_be_notified"]
    opened = read_checkpoint(msgspec.msgpack.encode(saved))
    assert opened is not None
    found = opened.state.commands["c1"].deliveries[U]
    assert (found.received_ns, found.notified_ns, found.can_be_notified) == (
        script.t_ns, None, None
    )  # fmt: skip
