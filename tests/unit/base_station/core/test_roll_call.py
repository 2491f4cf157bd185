"""Roll calls and evacuations: who is asked, and which events answer."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from shared.channels import REPLY, backfilled_key
from shared.codec import encode
from shared.messages import (
    AlarmState,
    CommandKind,
    CommandReply,
    CommandState,
    Header,
)
from shared.messages.station import (
    AcknowledgeAlarm,
    Assign,
    CheckIn,
    ConfirmCommand,
    ResolveAlarm,
    SendCommand,
    SetAccountability,
)
from tests.rig.people_on_duty import (
    INTERVAL_S,
    answer,
    at_work,
    confirmed,
    duty,
    left_s,
    order,
    overdue,
)
from tests.rig.station_script import Script


@pytest.fixture
def script() -> Script:
    return at_work()


def test_roll_call_on_demand_is_due_in_three_minutes(script: Script) -> None:
    script.act(SetAccountability(1200.0, 2400.0))
    script.wait(10)
    order(script, CommandKind.PAR_REQUEST)
    assert left_s(script) == 180.0
    script.wait(181)
    assert {one.unit_id for one in overdue(script)} == {"FF-01", "FF-02", "FF-03"}
    assert "PAR overdue, no answer, on duty for 3 min" in overdue(script)[0].text


def test_own_button_answers_a_roll_call_and_receipt_does_not(script: Script) -> None:
    script.wait(30)
    order(script, CommandKind.PAR_REQUEST)
    script.reply("FF-01", "c1", CommandState.RECEIVED)
    assert duty(script).open_request_ns is not None
    assert left_s(script) == 30.0
    script.reply("FF-01", "c1", CommandState.ACKNOWLEDGED)
    assert duty(script).open_request_ns is None
    assert confirmed(script) == ("self", "Person 1")
    assert left_s(script) == INTERVAL_S
    script.act(ConfirmCommand("c1", "FF-02"))
    assert confirmed(script, "FF-02") == ("radio", "chief")


@pytest.mark.parametrize("dealt_with", [AcknowledgeAlarm, lambda one: ResolveAlarm(one, "seen")])
def test_member_without_answer_to_the_evacuation_is_overdue_again(
    script: Script, dealt_with: Callable[[str], AcknowledgeAlarm | ResolveAlarm]
) -> None:
    """The alarm of before was handled, and there was no contact with the wearer since."""
    script.wait(61)
    before = next(one for one in overdue(script) if one.unit_id == "FF-01")
    script.act(dealt_with(before.alarm_id))
    script.wait(60)
    order(script, CommandKind.EVACUATE)
    script.wait(179)
    assert [one for one in overdue(script) if one.unit_id == "FF-01"][-1].by.startswith("chief")
    script.wait(2)
    again = [one for one in overdue(script) if one.unit_id == "FF-01"][2:]
    assert [one.state for one in again] == [AlarmState.RAISED]
    assert again[0].text == "Person 1: PAR overdue, no answer, on duty for 5 min"


def test_receipt_of_an_evacuation_confirms_no_member(script: Script) -> None:
    script.act(SetAccountability(1200.0, 2400.0))
    order(script, CommandKind.EVACUATE)
    script.reply("FF-01", "c1", CommandState.ACKNOWLEDGED)
    assert duty(script).open_request_ns is not None
    assert left_s(script) == 180.0


def test_answer_before_the_evacuation_does_not_confirm_it(script: Script) -> None:
    """The press preceded the order, and its message came after."""
    script.status("FF-01")
    order(script, CommandKind.PAR_REQUEST)
    script.wait(5)
    pressed_s = script.now_s
    script.wait(5)
    order(script, CommandKind.EVACUATE, "c2")
    ordered_ns = script.t_ns
    answer(script, pressed_s)
    assert confirmed(script) == ("self", "Person 1")
    assert duty(script).open_request_ns == ordered_ns


def test_repeated_request_extends_no_deadline(script: Script) -> None:
    script.act(SetAccountability(1200.0, 2400.0))
    order(script, CommandKind.PAR_REQUEST)
    script.wait(100)
    order(script, CommandKind.PAR_REQUEST, "c2")
    assert left_s(script) == 80.0


def test_text_requests_no_check_in(script: Script) -> None:
    script.act(SendCommand("c1", CommandKind.TEXT, "", "", True, "hello", 0.0, lasts_s=600.0))
    assert duty(script).open_request_ns is None


def test_answer_delayed_by_the_link_counts_from_its_own_time(script: Script) -> None:
    script.status("FF-01")
    script.wait(10)
    order(script, CommandKind.PAR_REQUEST)
    script.wait(5)
    pressed_s = script.now_s
    script.wait(30)
    answer(script, pressed_s)
    assert duty(script).open_request_ns is None
    assert left_s(script) == pytest.approx(INTERVAL_S - 30.0, abs=0.1)


def test_answer_is_never_dated_before_its_request(script: Script) -> None:
    """Whatever the unit's clock: a member who answered is not overdue."""
    script.status("FF-01")
    script.wait(10)
    order(script, CommandKind.PAR_REQUEST)
    answer(script, script.now_s - 8.0)
    assert duty(script).open_request_ns is None
    assert left_s(script) == pytest.approx(INTERVAL_S)


def test_answer_of_a_run_without_known_clock_counts_from_its_request(
    script: Script,
) -> None:
    """The unit restarted before the station received it; its journal brings the press, which may
    have been as long ago as that.
    """
    script.wait(10)
    order(script, CommandKind.PAR_REQUEST)
    script.wait(20)
    pressed = CommandReply(Header("FF-01", 99, 5, 1), "c1", CommandState.ACKNOWLEDGED, "")
    script.record(backfilled_key("FF-01", REPLY.suffix), encode(pressed))
    assert duty(script).open_request_ns is None
    assert left_s(script) == INTERVAL_S - 20.0


def test_answer_of_an_unknown_wearer_confirms_no_later_one(
    script: Script,
) -> None:
    order(script, CommandKind.PAR_REQUEST)
    script.wait(20)
    script.act(Assign("FF-01", "p9", "Bo", "", ""))
    script.wait(10)
    pressed = CommandReply(Header("FF-01", 99, 5, 1), "c1", CommandState.ACKNOWLEDGED, "")
    script.record(backfilled_key("FF-01", REPLY.suffix), encode(pressed))
    assert left_s(script) == INTERVAL_S - 10.0
    command = script.pipeline.state.commands["c1"]
    assert command.deliveries["FF-01"].acknowledged_by == "Bo or, before, Person 1"


def test_answer_behind_a_newer_check_in_changes_nothing(script: Script) -> None:
    script.status("FF-01")
    order(script, CommandKind.PAR_REQUEST)
    script.wait(5)
    pressed_s = script.now_s
    script.wait(20)
    script.act(CheckIn("FF-01", "", False))
    answer(script, pressed_s)
    assert left_s(script) == INTERVAL_S
    assert confirmed(script) == ("radio", "chief")
