"""PAR confirmations: by own unit, by radio, not yet; their undoing; and the state that none of them
changes.
"""

from __future__ import annotations

import pytest

from base_station.core.state.duty import CONFIRMATIONS_KEPT
from base_station.storage.db.known_people import person_lookup
from base_station.views.units import unit_views
from base_station.views.wire import DutyView
from shared.messages import AlarmState, CommandKind, CommandState, EventKind
from shared.messages.station import (
    Action,
    Assign,
    CheckIn,
    CloseIncident,
    ConfirmCommand,
    OpenIncident,
    SetAccountability,
    UndoConfirmation,
)
from tests.rig.people_on_duty import (
    INTERVAL_S,
    at_work,
    confirmed,
    duty,
    left_s,
    order,
    overdue,
    refusals,
)
from tests.rig.station_script import Script

ONE, ALL = CheckIn("FF-01", "", False, "k1"), CheckIn("", "", True, "k1")


@pytest.fixture
def script() -> Script:
    return at_work()


def shown(script: Script, unit_id: str = "FF-01") -> DutyView:
    state = script.pipeline.state
    (view,) = unit_views(state, [state.units[unit_id]], person_lookup({}))
    assert view.duty is not None
    return view.duty


def test_assignment_and_opening_confirm_no_member(
    script: Script,
) -> None:
    script.register("FF-04")
    script.act(Assign("FF-04", "p4", "Person 4", "blue", ""))
    for unit_id in ("FF-01", "FF-04"):
        view = shown(script, unit_id)
        assert (view.confirmed, view.checked_in_ms, view.checked_in_by) == ("not_yet", None, "")
        assert not view.located
        assert left_s(script, unit_id) == INTERVAL_S


def test_a_member_is_located_once_the_unit_is_received_in_this_incident(script: Script) -> None:
    script.status("FF-01")
    assert shown(script).located
    assert not shown(script, "FF-02").located
    script.act(CloseIncident("i1"))
    script.wait(1)
    script.act(OpenIncident("i2", "Dock"))
    assert not shown(script).located
    script.status("FF-01")
    assert shown(script).located


def test_record_distinguishes_own_unit_and_radio(script: Script) -> None:
    order(script, CommandKind.PAR_REQUEST)
    script.wait(1)
    script.reply("FF-01", "c1", CommandState.ACKNOWLEDGED)
    script.act(ConfirmCommand("c1", "FF-02"), by="ana")
    script.act(CheckIn("FF-03", "", False, "k1"), by="bo")
    views = [shown(script, f"FF-0{number}") for number in (1, 2, 3)]
    assert [(view.confirmed, view.checked_in_by, view.entry_id) for view in views] == [
        ("self", "Person 1", ""),
        ("radio", "ana", "c1"),
        ("radio", "bo", "k1"),
    ]
    deliveries = script.pipeline.state.commands["c1"].deliveries
    assert [one.acknowledged_via for one in deliveries.values()] == ["self", "radio", ""]


def test_end_of_the_alarm_names_the_confirmation(script: Script) -> None:
    script.wait(61)
    order(script, CommandKind.PAR_REQUEST)
    script.reply("FF-01", "c1", CommandState.ACKNOWLEDGED)
    script.wait(1)
    (ended,) = [one for one in overdue(script) if one.state is AlarmState.RESOLVED]
    assert ended.by == "not overdue; PAR confirmed by own unit, Person 1"


def test_longer_interval_keeps_the_unconfirmed_as_such(script: Script) -> None:
    script.wait(61)
    script.act(SetAccountability(600.0, 900.0))
    (ended,) = [one for one in overdue(script)[3:] if one.unit_id == "FF-01"]
    assert ended.by == "not overdue; PAR not yet confirmed"


@pytest.mark.parametrize(
    "confirmation", [ONE, ALL, CheckIn("", "red", False), ConfirmCommand("c1", "FF-01")]
)
def test_no_confirmation_touches_an_alarm_that_a_sensor_raised(
    script: Script, confirmation: Action
) -> None:
    """Nor does undoing it."""
    script.event("FF-01", EventKind.MAYDAY)
    script.event("FF-01", EventKind.FALL)
    script.wait(61, lambda: script.status("FF-01", motionless_s=40.0))
    order(script, CommandKind.PAR_REQUEST)
    rules = {"mayday", "fall", "no-motion"}
    before = [alarm for alarm in script.alarms if alarm.rule in rules]
    assert {alarm.rule for alarm in before} == rules
    script.act(confirmation)
    if not isinstance(confirmation, ConfirmCommand):
        script.act(ConfirmCommand("c1", "FF-01"))
    assert "missed-check-in" in {
        one.rule for one in script.alarms if one.state is AlarmState.RESOLVED
    }
    script.act(UndoConfirmation("c1", ""))
    assert [alarm for alarm in script.alarms if alarm.rule in rules] == before
    assert {one.state for one in before} == {AlarmState.RAISED}


def test_undone_it_stands_as_if_it_had_not_been_entered(script: Script) -> None:
    script.wait(10)
    script.act(CheckIn("FF-01", "", False, "k0"), by="Ana")
    script.wait(5)
    order(script, CommandKind.PAR_REQUEST)
    before = shown(script)
    script.wait(5)
    script.act(ONE)
    assert shown(script).asked_ms is None
    script.act(UndoConfirmation("k1", "FF-01"))
    assert shown(script) == before
    assert confirmed(script) == ("radio", "Ana")


def test_confirmation_undone_too_late_raises_the_alarm_at_once(script: Script) -> None:
    script.wait(50)
    script.act(ONE)
    script.wait(20)
    assert [one.unit_id for one in overdue(script)] == ["FF-02", "FF-03"]
    script.act(UndoConfirmation("k1", ""))
    assert overdue(script)[-1].unit_id == "FF-01"
    assert duty(script).confirmed == "not_yet"


def test_check_in_of_all_is_undone_for_one_or_for_all(script: Script) -> None:
    script.act(ALL)
    script.act(UndoConfirmation("k1", "FF-02"))
    states = [duty(script, f"FF-0{number}").confirmed for number in (1, 2, 3)]
    assert states == ["radio", "not_yet", "radio"]
    script.act(UndoConfirmation("k1", ""))
    states = [duty(script, f"FF-0{number}").confirmed for number in (1, 2, 3)]
    assert states == ["not_yet"] * 3
    assert refusals(script) == []


def test_command_answered_by_radio_waits_again_when_undone(script: Script) -> None:
    order(script, CommandKind.EVACUATE)
    script.act(ConfirmCommand("c1", "FF-01"))
    command = script.pipeline.state.commands["c1"]
    assert command.state_of(command.deliveries["FF-01"]) == "acknowledged"
    script.act(UndoConfirmation("c1", "FF-01"))
    assert command.state_of(command.deliveries["FF-01"]) == "queued"
    assert duty(script).open_request_ns is not None


def test_answer_of_the_own_unit_stays_when_that_by_radio_is_undone(script: Script) -> None:
    order(script, CommandKind.PAR_REQUEST)
    script.wait(1)
    script.act(ConfirmCommand("c1", "FF-01"))
    script.wait(1)
    script.reply("FF-01", "c1", CommandState.ACKNOWLEDGED)
    assert confirmed(script) == ("self", "Person 1")
    script.act(UndoConfirmation("c1", "FF-01"))
    assert confirmed(script) == ("self", "Person 1")
    delivery = script.pipeline.state.commands["c1"].deliveries["FF-01"]
    assert (delivery.acknowledged_via, delivery.acknowledged_by) == ("self", "Person 1")


@pytest.mark.parametrize(
    "action",
    [
        UndoConfirmation("", ""),
        UndoConfirmation("k9", ""),
        UndoConfirmation("k1", "FF-02"),
        UndoConfirmation("c1", "FF-01"),  # answered by the own unit: that is no entry by radio
        CheckIn("FF-02", "", False, "k1"),
        CheckIn("FF-02", "", False, "c1"),
    ],
)
def test_undo_of_an_ambiguous_confirmation_is_refused(script: Script, action: Action) -> None:
    order(script, CommandKind.PAR_REQUEST)
    script.reply("FF-01", "c1", CommandState.ACKNOWLEDGED)
    script.act(CheckIn("FF-01", "", False))  # of an old log, without an id
    script.act(ONE)
    before = list(duty(script).confirmations), list(duty(script, "FF-02").confirmations)
    script.act(action)
    assert len(refusals(script)) == 1
    assert (list(duty(script).confirmations), list(duty(script, "FF-02").confirmations)) == before


def test_undone_twice_is_refused(script: Script) -> None:
    script.act(ONE)
    script.act(UndoConfirmation("k1", ""))
    script.act(UndoConfirmation("k1", ""))
    assert refusals(script) == ["there is no confirmation by radio under this id to undo"]


def test_entry_of_a_closed_incident_stays(script: Script) -> None:
    order(script, CommandKind.EVACUATE)
    script.act(ConfirmCommand("c1", "FF-01"))
    script.act(CloseIncident("i1"))
    script.act(UndoConfirmation("c1", "FF-01"))
    assert refusals(script) == ["its incident is closed: what was entered in it stays as it is"]


def test_number_of_undoable_entries_is_bounded(script: Script) -> None:
    for number in range(2 * CONFIRMATIONS_KEPT):
        script.wait(1)
        order(script, CommandKind.PAR_REQUEST, f"c{number}")
        script.act(CheckIn("FF-01", "", False, f"k{number}"))
        script.act(ConfirmCommand(f"c{number}", "FF-02"))
        script.act(ConfirmCommand(f"c{number}", "FF-03"))
    assert len(duty(script).confirmations) == CONFIRMATIONS_KEPT
    assert len(duty(script).requests_ns) <= CONFIRMATIONS_KEPT
