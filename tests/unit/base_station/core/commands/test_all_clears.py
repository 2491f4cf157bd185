"""The all clear ends an evacuation, at the station and in the units."""

from __future__ import annotations

import pytest

from base_station.core.checkpoint import read_checkpoint
from base_station.core.commands.command_tracker import CLOSED_KEPT, open_orders
from base_station.core.events import Refused
from shared.messages import CommandKind, CommandState
from shared.messages.station import (
    CloseIncident,
    ConfirmCommand,
    OpenIncident,
    SendCommand,
    UndoConfirmation,
)
from tests.rig.station_script import Script, new_pipeline

UNITS = ("FF-01", "FF-02", "FF-03")
LASTS_S = 60.0
OLD_UNIT = "this unit does not know this kind of command"


def evacuation(command_id: str = "c1", unit_id: str = "") -> SendCommand:
    kind = CommandKind.EVACUATE
    return SendCommand(command_id, kind, unit_id, "", not unit_id, "", 0.0, LASTS_S)


def all_clear(evacuation_id: str = "c1", command_id: str = "ac") -> SendCommand:
    kind, ended = CommandKind.ALL_CLEAR, evacuation_id
    return SendCommand(command_id, kind, "", "", True, "", 0.0, LASTS_S, ended_command_id=ended)


def evacuated() -> Script:
    """One acknowledges, one is notified, one is away."""
    script = Script()
    script.register(*UNITS)
    for unit_id in UNITS:
        script.status(unit_id)
    script.act(OpenIncident("i1", "Mill Lane"))
    script.act(evacuation())
    for unit_id in UNITS[:2]:
        script.command(unit_id, "c1")
    script.reply("FF-01", "c1", CommandState.ACKNOWLEDGED)
    script.reply("FF-02", "c1", CommandState.NOTIFIED)
    return script


def states(script: Script, command_id: str) -> list[str]:
    command = script.pipeline.state.commands[command_id]
    return [command.state_of(one) for one in command.deliveries.values()]


def orders(script: Script) -> list[tuple[str, CommandKind, str]]:
    found = open_orders(script.pipeline.state)
    return [(one.unit_id, one.kind, one.ended_command_id) for one in found]


def refusal(script: Script, action: SendCommand) -> str:
    (refused,) = script.act(action)
    assert isinstance(refused, Refused)
    return refused.reason


def test_all_clear_reaches_all_units_and_no_unit_gets_the_evacuation_afterwards() -> None:
    script = evacuated()
    script.now_s += 5.0
    script.act(all_clear(), by="ada")
    kind = CommandKind.ALL_CLEAR
    assert orders(script) == [(unit_id, kind, "c1") for unit_id in UNITS]
    assert states(script, "c1") == ["acknowledged", "expired", "expired"]
    command = script.pipeline.state.commands["c1"]
    assert (command.ended_ns, command.is_open) == (script.t_ns, False)
    script.reply("FF-01", "ac", CommandState.ACKNOWLEDGED)
    script.reply("FF-02", "ac", CommandState.NOTIFIED)
    assert states(script, "ac") == ["acknowledged", "notified", "queued"]
    assert orders(script) == [("FF-03", kind, "c1")], "who was away still gets it"
    script.reply("FF-02", "c1", CommandState.ACKNOWLEDGED)
    assert states(script, "c1")[1] == "acknowledged", "pressed before, known only now"


def test_unit_of_an_earlier_version_refuses_it_and_is_silenced() -> None:
    script = evacuated()
    script.act(all_clear())
    script.reply("FF-02", "ac", CommandState.REFUSED, OLD_UNIT)
    assert states(script, "ac")[1] == "refused"
    end = next(one for one in open_orders(script.pipeline.state) if one.unit_id == "FF-02")
    assert (end.kind, end.ended_command_id) == (CommandKind.END_ORDER, "c1")
    script.reply("FF-02", end.command_id, CommandState.RECEIVED)
    assert [one[0] for one in orders(script)] == ["FF-01", "FF-03"]
    script.act(ConfirmCommand("ac", "FF-02"))
    assert states(script, "ac")[1] == "acknowledged", "told by radio"


def test_member_evacuated_again_is_not_accounted_for_until_that_evacuation_ends() -> None:
    script = evacuated()
    script.act(evacuation("c2", "FF-02"))
    script.act(all_clear())
    assert list(script.pipeline.state.commands["ac"].deliveries) == ["FF-01", "FF-03"]
    assert ("FF-02", CommandKind.EVACUATE, "") in orders(script)
    assert ("FF-02", CommandKind.END_ORDER, "c1") in orders(script)
    script.act(all_clear("c2", "ac2"))
    assert ("FF-02", CommandKind.ALL_CLEAR, "c2") in orders(script)
    assert ("FF-02", CommandKind.EVACUATE, "") not in orders(script)


def test_all_clear_of_the_last_of_two_evacuations_ends_both() -> None:
    script = evacuated()
    script.act(evacuation("c2"))
    assert "ordered out again" in refusal(script, all_clear("c1"))
    script.act(all_clear("c2"))
    kinds = {kind for _, kind, _ in orders(script)}
    assert kinds == {CommandKind.ALL_CLEAR}
    assert all(script.pipeline.state.commands[one].ended_ns for one in ("c1", "c2"))


@pytest.mark.parametrize(
    ("action", "word"),
    [
        (all_clear("none"), "no evacuation"),
        (all_clear("p1"), "no evacuation"),
        (all_clear(command_id="c1"), "id of its own"),
        (all_clear(""), "name that"),
    ],
)
def test_impossible_all_clear_is_refused(action: SendCommand, word: str) -> None:
    script = evacuated()
    script.act(SendCommand("p1", CommandKind.PAR_REQUEST, "", "", True, "", 0.0, LASTS_S))
    assert word in refusal(script, action)
    assert states(script, "c1") == ["acknowledged", "notified", "queued"]


def test_ended_evacuation_stays_ended() -> None:
    script = evacuated()
    script.act(ConfirmCommand("c1", "FF-02"))
    script.act(all_clear())
    assert "over already" in refusal(script, all_clear(command_id="ac2"))
    again = SendCommand(
        "r1", CommandKind.EVACUATE, "", "", True, "", 0.0, LASTS_S, repeats="c1"
    )  # fmt: skip
    assert "is over" in refusal(script, again)
    (refused,) = script.act(UndoConfirmation("c1", "FF-02"))
    assert isinstance(refused, Refused), "else it would be sent again"


def test_incident_closed_during_an_all_clear_silences_units_that_missed_it() -> None:
    script = evacuated()
    script.act(all_clear())
    script.act(CloseIncident("i1"))
    assert ("FF-02", CommandKind.END_ORDER, "c1") in orders(script)
    assert {kind for _, kind, _ in orders(script)} == {CommandKind.END_ORDER}
    script.act(OpenIncident("i2", "Harbour"))
    assert "over already" in refusal(script, all_clear(command_id="ac2"))


def test_restarted_station_still_sends_it() -> None:
    script = evacuated()
    script.act(all_clear())
    again = read_checkpoint(script.pipeline.checkpoint())
    assert again is not None
    assert open_orders(again.state) == open_orders(script.pipeline.state)
    replayed = Script(new_pipeline())
    for record in script.records:
        replayed.now_s = (record[0] - Script().t_ns) / 1e9
        replayed.record(record[1], record[2])
    assert open_orders(replayed.pipeline.state) == open_orders(script.pipeline.state)


def test_evacuation_that_all_have_answered_can_be_ended_long_after() -> None:
    script = evacuated()
    for unit_id in UNITS[1:]:
        script.act(ConfirmCommand("c1", unit_id))
        script.reply(unit_id, "c1", CommandState.ACKNOWLEDGED)
    for number in range(3 * CLOSED_KEPT):
        text_id = f"t{number}"
        script.act(SendCommand(text_id, CommandKind.TEXT, UNITS[0], "", False, "hi", 0.0, 60.0))
        script.reply(UNITS[0], text_id, CommandState.ACKNOWLEDGED)
    script.wait(700.0)
    script.act(all_clear())
    assert states(script, "ac") == ["queued"] * 3
