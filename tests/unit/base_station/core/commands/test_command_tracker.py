"""Progress of a command with each unit, event by event."""

from __future__ import annotations

import math

import pytest

from base_station.core.commands.command_tracker import CLOSED_KEPT, MAX_OPEN, open_orders
from base_station.core.commands.order_ends import WITHDRAWN
from base_station.core.events import CommandChanged, Refused
from base_station.core.state import ERASED_TEXT
from shared.channels import REPLY, backfilled_key
from shared.codec import encode
from shared.messages import OF_STATION, CommandKind, CommandReply, CommandState, EventKind
from shared.messages.station import (
    Assign,
    CloseIncident,
    ConfirmCommand,
    ForgetWearers,
    OpenIncident,
    SendCommand,
    Unassign,
    UndoConfirmation,
)
from tests.rig import message_factory
from tests.rig.station_script import Script

RECEIVED, ACKNOWLEDGED = CommandState.RECEIVED, CommandState.ACKNOWLEDGED
REFUSED = CommandState.REFUSED


def crewed() -> Script:
    """FF-01 and FF-02 in the red crew, FF-03 in the blue one, FF-04 unused."""
    script = Script()
    script.register("FF-01", "FF-02", "FF-03", "FF-04")
    for number, crew in ((1, "red"), (2, "red"), (3, "blue")):
        script.act(Assign(f"FF-0{number}", f"p{number}", f"Person {number}", crew, ""))
    return script


def order(
    command_id: str = "c1",
    kind: CommandKind = CommandKind.EVACUATE,
    unit_id: str = "",
    crew: str = "",
    everyone: bool = False,
    text: str = "",
    rate_hz: float = 0.0,
    lasts_s: float = 60.0,
) -> SendCommand:
    return SendCommand(command_id, kind, unit_id, crew, everyone, text, rate_hz, lasts_s)


def states(script: Script, command_id: str = "c1") -> dict[str, str]:
    command = script.pipeline.state.commands[command_id]
    return {one.unit_id: command.state_of(one) for one in command.deliveries.values()}


def to_one(kind: CommandKind = CommandKind.PAR_REQUEST) -> Script:
    script = crewed()
    script.act(order(kind=kind, unit_id="FF-01", text="hi", rate_hz=5.0))
    return script


@pytest.mark.parametrize(
    ("target", "reported"),
    [
        ({"unit_id": "FF-04"}, ["FF-04"]),
        ({"crew": "red"}, ["FF-01", "FF-02"]),
        ({"everyone": True}, ["FF-01", "FF-02", "FF-03", "stranded"]),
    ],
)
def test_command_goes_to_a_unit_a_crew_or_everyone(target, reported):
    script = crewed()
    script.register("stranded")
    script.status("stranded")  # unassigned, but in use
    script.status("stranger")
    assert script.act(order(**target)) == [CommandChanged("c1")]
    assert list(states(script)) == reported
    assert [one.unit_id for one in open_orders(script.pipeline.state)] == reported


def test_unused_unit_is_not_waited_for():
    """Units are tested in the morning: the list of the unreached shows only those in use."""
    script = crewed()
    for unit_id in ("FF-03", "FF-04"):
        script.status(unit_id)
        script.event(unit_id, EventKind.STOPPED)
    script.act(order(everyone=True))
    assert list(states(script)) == ["FF-01", "FF-02", "FF-03"]
    script.status("FF-04")  # it is switched on again
    script.act(order("c2", everyone=True))
    assert list(states(script, "c2")) == ["FF-01", "FF-02", "FF-03", "FF-04"]


def test_recipients_do_not_change_with_assignments():
    script = crewed()
    script.act(order(crew="red"))
    script.act(Unassign("FF-01"))
    script.act(Assign("FF-04", "p4", "Person 4", "red", ""))
    assert list(states(script)) == ["FF-01", "FF-02"]


@pytest.mark.parametrize(
    ("action", "reason"),
    [
        (order(), "one of"),
        (order(unit_id="FF-01", everyone=True), "one of"),
        (order(unit_id="FF-09"), "FF-09"),
        (order(crew="green"), "green"),
        (order(kind=CommandKind.UNKNOWN, everyone=True), "kind"),
        (order(kind=CommandKind.TEXT, everyone=True, text="  "), "text"),
        (order(everyone=True, lasts_s=0.0), "lasts"),
        (order(everyone=True, lasts_s=math.inf), "lasts"),
        (order(everyone=True, rate_hz=math.nan), "rate"),
        (order(command_id="", everyone=True), "id"),
    ],
)
def test_impossible_command_is_refused_with_the_reason(action, reason):
    script = crewed()
    (output,) = script.act(action)
    assert isinstance(output, Refused)
    assert reason in output.reason
    assert not script.pipeline.state.commands


def test_command_does_not_replace_another_of_the_same_id():
    """A unit does a command of one id once."""
    script = to_one()
    script.reply("FF-01", "c1", RECEIVED)
    (output,) = script.act(order("c1", CommandKind.EVACUATE, everyone=True))
    assert isinstance(output, Refused)
    assert "an id of its own" in output.reason
    assert states(script) == {"FF-01": "received"}


def test_states_are_queued_sent_received_and_acknowledged():
    script = to_one()
    seen = [states(script)["FF-01"]]
    for happens in (
        lambda: script.command("FF-01", "c1"),
        lambda: script.reply("FF-01", "c1", RECEIVED),
        lambda: script.reply("FF-01", "c1", ACKNOWLEDGED),
    ):
        script.now_s += 1.0
        assert CommandChanged("c1") in happens()
        seen.append(states(script)["FF-01"])
    assert seen == ["queued", "sent", "received", "acknowledged"]
    command = script.pipeline.state.commands["c1"]
    delivery = command.deliveries["FF-01"]
    assert delivery.acknowledged_by == "Person 1"
    assert [delivery.sent_ns, delivery.received_ns, delivery.acknowledged_ns] == [
        command.issued_ns + second * 10**9 for second in (1, 2, 3)
    ]
    assert not command.is_open


def test_repeats_change_nothing():
    script = to_one()
    for happens in (
        lambda: script.command("FF-01", "c1"),
        lambda: script.reply("FF-01", "c1", RECEIVED),
        lambda: script.reply("FF-01", "c1", ACKNOWLEDGED),
    ):
        happens()
        before = repr(script.pipeline.state.commands)
        script.now_s += 1.0
        assert CommandChanged("c1") not in happens()
        assert repr(script.pipeline.state.commands) == before


@pytest.mark.parametrize("unit_id", ["FF-01", "FF-02", "stranger"])
def test_reply_to_an_unknown_command_changes_nothing(unit_id):
    """It was closed long ago, or went to another unit."""
    script = to_one()
    before = repr(script.pipeline.state.commands)
    for command_id in ("c1", "c9"):
        if (unit_id, command_id) != ("FF-01", "c1"):
            script.command(unit_id, command_id)
            script.reply(unit_id, command_id, RECEIVED)
    assert repr(script.pipeline.state.commands) == before


def test_command_to_a_unit_is_no_contact_with_it():
    script = to_one()
    script.command("FF-01", "c1")
    assert script.pipeline.state.units["FF-01"].last_message_ns is None


def test_reply_of_another_unit_changes_nothing():
    script = to_one()
    script.reply("FF-02", "c1", ACKNOWLEDGED)
    script.reply("stranger", "c1", ACKNOWLEDGED)
    assert states(script) == {"FF-01": "queued"}


def test_motion_and_speech_complete_no_par():
    script = to_one()
    script.command("FF-01", "c1")
    script.wait(30, lambda: (script.status("FF-01"), script.position("FF-01", 1.0, 1.0)))
    assert states(script) == {"FF-01": "sent"}


def test_operator_completes_a_par():
    script = to_one()
    assert script.act(ConfirmCommand("c1", "FF-01"), by="ada") == [CommandChanged("c1")]
    assert script.pipeline.state.commands["c1"].deliveries["FF-01"].acknowledged_by == "ada"
    (again,) = script.act(ConfirmCommand("c1", "FF-01"))
    assert isinstance(again, Refused)
    assert not open_orders(script.pipeline.state)


@pytest.mark.parametrize(("command_id", "unit_id"), [("c2", "FF-01"), ("c1", "FF-02")])
def test_unaddressed_unit_cannot_be_confirmed(command_id, unit_id):
    (output,) = to_one().act(ConfirmCommand(command_id, unit_id))
    assert isinstance(output, Refused)


def test_command_without_answer_is_done_when_received():
    script = to_one(CommandKind.LOCATE)
    script.reply("FF-01", "c1", RECEIVED)
    assert not script.pipeline.state.commands["c1"].is_open
    script.wait(61)
    assert states(script) == {"FF-01": "received"}


def test_command_of_the_unit_alone_cannot_be_confirmed_by_radio():
    script = to_one(CommandKind.SET_POSITION_RATE)
    assert isinstance(script.act(ConfirmCommand("c1", "FF-01"))[0], Refused)


def test_a_locate_order_to_a_unit_without_an_output_can_be_confirmed_by_radio():
    script = crewed()
    script.say(message_factory.description(script.header("FF-01"), outputs=()))
    script.act(order(kind=CommandKind.LOCATE, unit_id="FF-01"))
    script.reply("FF-01", "c1", RECEIVED)
    assert script.act(ConfirmCommand("c1", "FF-01"), by="ada") == [CommandChanged("c1")]
    assert states(script) == {"FF-01": "acknowledged"}
    assert script.act(UndoConfirmation("c1", "FF-01")) == [CommandChanged("c1")]
    assert states(script) != {"FF-01": "acknowledged"}


@pytest.mark.parametrize("kind", sorted(OF_STATION))
def test_operator_cannot_send_automatic_commands(kind):
    script = crewed()
    (output,) = script.act(order(kind=kind, everyone=True))
    assert isinstance(output, Refused)


def test_refusal_gives_its_reason_and_ends_the_delivery():
    script = to_one(CommandKind.SET_POSITION_RATE)
    script.reply("FF-01", "c1", REFUSED, "too fast")
    assert states(script) == {"FF-01": "refused"}
    assert script.pipeline.state.commands["c1"].deliveries["FF-01"].reason == "too fast"
    assert not open_orders(script.pipeline.state)


def test_replaced_rate_is_not_sent_again():
    """A repeat would be applied last, and leave the unit at the outdated rate."""
    script = crewed()
    rate = CommandKind.SET_POSITION_RATE
    script.act(order("slow", rate, crew="red", rate_hz=1.0))
    script.command("FF-01", "slow")
    script.act(order("look", CommandKind.LOCATE, unit_id="FF-01"))
    outputs = script.act(order("fast", rate, unit_id="FF-01", rate_hz=5.0))
    assert {CommandChanged("slow"), CommandChanged("fast")} == set(outputs)
    stated = [(one.command_id, one.unit_id) for one in open_orders(script.pipeline.state)]
    assert stated == [("slow", "FF-02"), ("look", "FF-01"), ("fast", "FF-01")]
    replaced = script.pipeline.state.commands["slow"].deliveries["FF-01"]
    assert (states(script, "slow"), replaced.reason) == (
        {"FF-01": "refused", "FF-02": "queued"},
        "a later rate replaces it",
    )


def test_received_rate_stays_received_when_a_later_one_comes():
    script = crewed()
    script.act(order("slow", CommandKind.SET_POSITION_RATE, unit_id="FF-01", rate_hz=1.0))
    script.reply("FF-01", "slow", RECEIVED)
    script.act(order("fast", CommandKind.SET_POSITION_RATE, unit_id="FF-01", rate_hz=5.0))
    assert states(script, "slow") == {"FF-01": "received"}


@pytest.mark.parametrize("so_far", [[], ["sent"], ["sent", "received"]])
def test_command_expires_without_an_answer_in_time(so_far):
    script = to_one()
    if "sent" in so_far:
        script.command("FF-01", "c1")
    if "received" in so_far:
        script.reply("FF-01", "c1", RECEIVED)
    script.wait(59)
    assert script.pipeline.state.commands["c1"].is_open
    script.now_s += 1.0
    assert CommandChanged("c1") in script.tick()
    assert states(script) == {"FF-01": "expired"}
    assert not open_orders(script.pipeline.state)
    script.now_s += 1.0
    assert CommandChanged("c1") not in script.tick()


def test_late_acknowledgement_counts():
    script = to_one()
    script.wait(70)
    script.reply("FF-01", "c1", RECEIVED)
    assert states(script) == {"FF-01": "expired"}
    script.reply("FF-01", "c1", ACKNOWLEDGED)
    assert states(script) == {"FF-01": "acknowledged"}


def test_backfilled_reply_counts():
    script = to_one()
    reply = CommandReply(script.header("FF-01"), "c1", ACKNOWLEDGED)
    script.status("FF-01")
    script.record(backfilled_key("FF-01", REPLY.suffix), encode(reply))
    assert states(script) == {"FF-01": "acknowledged"}
    delivery = script.pipeline.state.commands["c1"].deliveries["FF-01"]
    assert delivery.received_ns == script.t_ns, "who answers has it"


@pytest.mark.parametrize(("stated", "by"), [("before", "Person 1"), ("after", "Person 4")])
def test_late_acknowledgement_belongs_to_the_wearer_at_its_time(stated, by):
    script = to_one()
    script.status("FF-01")
    replies = {}
    for when in ("before", "after"):
        script.wait(5)
        script.status("FF-01")
        replies[when] = CommandReply(script.header("FF-01"), "c1", ACKNOWLEDGED)
        script.wait(5)
        if when == "before":
            script.act(Unassign("FF-01"))
            script.act(Assign("FF-01", "p4", "Person 4", "", ""))
    script.record(backfilled_key("FF-01", REPLY.suffix), encode(replies[stated]))
    assert script.pipeline.state.commands["c1"].deliveries["FF-01"].acknowledged_by == by


def test_wearer_of_a_commanded_unit_is_erased_from_the_command():
    script = to_one()
    reply = CommandReply(script.header("FF-01"), "c1", ACKNOWLEDGED)
    script.status("FF-01")
    script.wait(5)
    script.act(Unassign("FF-01"))
    script.act(ForgetWearers("FF-01"))
    script.record(backfilled_key("FF-01", REPLY.suffix), encode(reply))
    assert script.pipeline.state.commands["c1"].deliveries["FF-01"].acknowledged_by == ERASED_TEXT
    assert b"Person 1" not in script.pipeline.checkpoint()


def test_reply_under_the_key_of_another_unit_is_refused():
    script = to_one()
    forged = CommandReply(script.header("FF-02"), "c1", ACKNOWLEDGED)
    script.record("muster/v1/FF-01/alert/reply", encode(forged))
    assert states(script) == {"FF-01": "queued"}


def test_command_is_open_until_the_last_unit_has_answered():
    script = crewed()
    script.act(order(crew="red"))
    script.reply("FF-01", "c1", ACKNOWLEDGED)
    assert script.pipeline.state.commands["c1"].is_open
    script.wait(61)
    assert states(script) == {"FF-01": "acknowledged", "FF-02": "expired"}


def test_command_done_too_late_counts_as_done():
    script = to_one(CommandKind.LOCATE)
    script.wait(70)
    script.reply("FF-01", "c1", RECEIVED)
    assert states(script) == {"FF-01": "received"}


def test_texts_to_a_wearer_and_their_answers_are_erased():
    script = crewed()
    for number in (1, 2):
        script.act(order(f"c{number}", CommandKind.EVACUATE, f"FF-0{number}"))
        script.reply(f"FF-0{number}", f"c{number}", ACKNOWLEDGED)
    script.act(ForgetWearers("FF-01"))
    hers, his = script.pipeline.state.commands.values()
    assert hers.deliveries["FF-01"].acknowledged_by == ERASED_TEXT
    assert his.deliveries["FF-02"].acknowledged_by == "Person 2"


@pytest.mark.parametrize("answer", [RECEIVED, ACKNOWLEDGED, REFUSED])
def test_texts_to_others_that_may_name_the_person_are_erased(answer):
    """Nothing is lost with the texts: they have been delivered."""
    script = crewed()
    for number, answers in ((1, True), (2, True), (3, False)):
        script.act(order(f"c{number}", CommandKind.TEXT, f"FF-0{number}", text="to Person 1!"))
        if answers:
            script.reply(f"FF-0{number}", f"c{number}", answer)
    outputs = script.act(ForgetWearers("FF-01"))
    assert [CommandChanged(f"c{number}") in outputs for number in (1, 2, 3)] == [True, True, False]
    texts = [command.text for command in script.pipeline.state.commands.values()]
    assert texts == [ERASED_TEXT, ERASED_TEXT, "to Person 1!"]
    (left,) = open_orders(script.pipeline.state)
    assert (left.unit_id, left.text) == ("FF-03", "to Person 1!")


def test_erased_text_is_not_sent_any_more():
    script = crewed()
    script.act(order(kind=CommandKind.TEXT, everyone=True, text="by the north door"))
    script.command("FF-01", "c1")
    script.reply("FF-02", "c1", RECEIVED)
    outputs = script.act(ForgetWearers("FF-01"))
    assert CommandChanged("c1") in outputs, "whoever looks at it sees it go"
    assert states(script) == {"FF-01": "expired", "FF-02": "received", "FF-03": "expired"}
    assert not open_orders(script.pipeline.state)
    script.reply("FF-01", "c1", ACKNOWLEDGED)  # received all the same
    assert states(script)["FF-01"] == "acknowledged"


def test_evacuation_continues_without_its_erased_text():
    script = to_one(CommandKind.EVACUATE)
    script.act(ForgetWearers("FF-01"))
    (left,) = open_orders(script.pipeline.state)
    assert (left.kind, left.text) == (CommandKind.EVACUATE, "")


def test_erasure_is_refused_while_an_incident_is_open():
    script = to_one()
    script.act(OpenIncident("i1", "Mill Lane"))
    (refused,) = script.act(ForgetWearers("FF-01"))
    assert isinstance(refused, Refused)
    script.act(CloseIncident("i1"))
    assert not any(isinstance(one, Refused) for one in script.act(ForgetWearers("FF-01")))


def test_orders_of_an_incident_end_with_it():
    """A member of the next incident is not ordered out of the last one's building."""
    script = crewed()
    script.act(order("before", CommandKind.TEXT, crew="blue", text="to the engine"))
    script.act(OpenIncident("i1", "Mill Lane"))
    script.act(order(crew="red"))
    script.act(order("rate", CommandKind.SET_POSITION_RATE, unit_id="FF-01", rate_hz=2.0))
    script.reply("FF-01", "c1", ACKNOWLEDGED)
    outputs = script.act(CloseIncident("i1"))
    assert CommandChanged("c1") in outputs
    assert states(script) == {"FF-01": "acknowledged", "FF-02": "expired"}
    assert script.pipeline.state.commands["c1"].deliveries["FF-02"].reason == WITHDRAWN
    left = {one.command_id for one in open_orders(script.pipeline.state)}
    assert left == {"before", "rate"}
    of = {key: one.incident_id for key, one in script.pipeline.state.commands.items()}
    assert of == {"before": "", "c1": "i1", "rate": "i1"}
    script.act(OpenIncident("i2", "Dock"))
    script.act(order("c2", unit_id="FF-01"))
    assert script.pipeline.state.commands["c2"].incident_id == "i2"
    script.reply("FF-02", "c1", ACKNOWLEDGED)
    assert states(script)["FF-02"] == "acknowledged", "late, and true all the same"


def test_number_of_kept_commands_is_bounded():
    script = crewed()
    for number in range(3 * CLOSED_KEPT):
        script.act(order(f"l{number}", CommandKind.LOCATE, unit_id="FF-01"))
        script.reply("FF-01", f"l{number}", RECEIVED)
    assert list(script.pipeline.state.commands)[-1] == f"l{3 * CLOSED_KEPT - 1}"
    assert len(script.pipeline.state.commands) <= CLOSED_KEPT
    for number in range(MAX_OPEN):
        script.act(order(f"p{number}", CommandKind.PAR_REQUEST, unit_id="FF-01"))
    (output,) = script.act(order("more", CommandKind.PAR_REQUEST, unit_id="FF-01"))
    assert isinstance(output, Refused)


def test_evacuation_does_not_wait_for_open_commands():
    script = crewed()
    for number in range(MAX_OPEN):
        script.act(order(f"t{number}", CommandKind.TEXT, unit_id="FF-01", text="come nearer"))
    assert script.act(order("out", CommandKind.EVACUATE, everyone=True)) == [CommandChanged("out")]
    for number in range(MAX_OPEN):
        (output,) = script.act(order(f"e{number}", CommandKind.EVACUATE, unit_id="FF-02"))
    assert isinstance(output, Refused), "what is kept is bounded all the same"
