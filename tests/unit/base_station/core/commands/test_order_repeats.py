"""Repeats of orders go to units that have not answered, and their answers count for the first."""

from __future__ import annotations

import pytest

from base_station.core.commands.command_tracker import open_orders
from base_station.core.events import Refused
from base_station.core.state.command import SentCommand
from shared.messages import CommandKind, CommandState
from shared.messages.station import CloseIncident, ConfirmCommand, OpenIncident, SendCommand
from tests.rig.station_script import Script

UNITS = ("FF-01", "FF-02", "FF-03")
LASTS_S = 60.0


def evacuated() -> Script:
    """One acknowledges, one is notified, one does not get it."""
    script = Script()
    script.register(*UNITS)
    for unit_id in UNITS:
        script.status(unit_id)
    script.act(SendCommand("c1", CommandKind.EVACUATE, "", "", True, "", 0.0, LASTS_S))
    for unit_id in UNITS[:2]:
        script.command(unit_id, "c1")
    script.reply("FF-01", "c1", CommandState.ACKNOWLEDGED)
    script.reply("FF-02", "c1", CommandState.NOTIFIED)
    return script


def repeat(unit_id: str = "", repeat_id: str = "r1", repeats: str = "c1") -> SendCommand:
    return SendCommand(
        repeat_id, CommandKind.EVACUATE, unit_id, "", not unit_id, "", 0.0, LASTS_S, repeats=repeats
    )


def the_order(script: Script) -> SentCommand:
    (command,) = script.pipeline.state.commands.values()
    return command


def states(script: Script) -> list[str]:
    command = the_order(script)
    return [command.state_of(one) for one in command.deliveries.values()]


def test_repeat_goes_to_the_unanswered_and_counts_stay_those_of_the_evacuation() -> None:
    script = evacuated()
    script.now_s += 5.0
    script.act(repeat())
    assert states(script) == ["acknowledged", "queued", "queued"]
    orders = open_orders(script.pipeline.state)
    assert [one.unit_id for one in orders] == ["FF-02", "FF-03"]
    assert {(one.command_id, one.repeats) for one in orders} == {("r1", "c1")}
    for unit_id in UNITS[1:]:
        script.command(unit_id, "r1")
    script.reply("FF-02", "c1", CommandState.RECEIVED)
    assert states(script)[1] == "sent", "an answer to what was sent before"
    script.reply("FF-02", "r1", CommandState.NOTIFIED)
    script.reply("FF-03", "r1", CommandState.ACKNOWLEDGED)
    assert states(script) == ["acknowledged", "notified", "acknowledged"]
    script.reply("FF-02", "c1", CommandState.ACKNOWLEDGED)
    assert states(script)[1] == "acknowledged", "the press answers both"
    assert not the_order(script).is_open


def test_repeat_to_one_person_lasts_from_its_time() -> None:
    script = evacuated()
    script.wait(61.0)
    assert states(script)[1:] == ["expired", "expired"]
    script.act(repeat("FF-03"))
    assert states(script)[1:] == ["expired", "queued"]
    (order,) = open_orders(script.pipeline.state)
    assert order.expires_ns == script.t_ns + 60 * 10**9
    script.wait(61.0)
    assert states(script)[1:] == ["expired", "expired"]


@pytest.mark.parametrize(
    ("action", "word"),
    [
        (repeat(repeats="none"), "no order"),
        (repeat("FF-01"), "FF-01"),
        (repeat("FF-09"), "FF-09"),
        (repeat(repeat_id="c1"), "id of its own"),
    ],
)
def test_impossible_repeat_is_refused(action: SendCommand, word: str) -> None:
    script = evacuated()
    (refused,) = script.act(action)
    assert isinstance(refused, Refused)
    assert word in refused.reason
    assert states(script) == ["acknowledged", "notified", "queued"]


def test_order_without_answers_or_with_all_is_not_sent_again() -> None:
    script = evacuated()
    for unit_id in UNITS[1:]:
        script.act(ConfirmCommand("c1", unit_id))
    (refused,) = script.act(repeat())
    assert isinstance(refused, Refused)
    script.act(SendCommand("c2", CommandKind.LOCATE, "FF-01", "", False, "", 0.0, LASTS_S))
    (refused,) = script.act(repeat(repeats="c2"))
    assert isinstance(refused, Refused)


def test_orders_of_a_closed_incident_are_not_sent_again() -> None:
    script = Script()
    script.register("FF-01")
    script.act(OpenIncident("i1", "Mill Lane"))
    script.act(SendCommand("c1", CommandKind.EVACUATE, "FF-01", "", False, "", 0.0, LASTS_S))
    script.act(CloseIncident("i1"))
    assert the_order(script).ended_ns == script.t_ns
    script.act(OpenIncident("i2", "Harbour"))
    (refused,) = script.act(repeat())
    assert isinstance(refused, Refused)
    assert open_orders(script.pipeline.state) == ()
