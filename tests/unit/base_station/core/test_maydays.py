"""Maydays: one alarm for each press, whatever messages of it are lost, late or overtaken."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from shared.channels import EVENT, backfilled_key
from shared.codec import encode
from shared.messages import EventKind, UnitEvent
from shared.messages.station import (
    AcknowledgeAlarm,
    ResolveAlarm,
)
from tests.rig import message_factory
from tests.rig.alarm_transitions import U, changes
from tests.rig.station_script import Script


@pytest.fixture
def script() -> Script:
    script = Script()
    script.register(U)
    return script


def test_mayday_is_immediate_and_the_wearer_cannot_resolve_it(script: Script) -> None:
    (alarm,) = [o for o in script.event(U, EventKind.MAYDAY) if o in script.alarms]
    script.wait(20, lambda: script.status(U, mayday=True))
    script.event(U, EventKind.MAYDAY_CANCELLED)
    script.wait(20, lambda: script.status(U, mayday=False))
    assert changes(script, "mayday") == [("RAISED", "mayday")]
    script.act(ResolveAlarm(alarm.alarm_id, "spoke to him"))
    script.wait(5, lambda: script.status(U, mayday=False))
    assert changes(script, "mayday")[-1] == ("RESOLVED", "mayday")


def test_mayday_whose_event_was_lost_is_read_from_the_status(script: Script) -> None:
    script.wait(3, lambda: script.status(U, mayday=True))
    assert changes(script, "mayday") == [("RAISED", "mayday")]


@pytest.mark.parametrize("dealt_with", [AcknowledgeAlarm, lambda one: ResolveAlarm(one, "seen")])
def test_press_known_by_a_status_is_not_raised_again_by_backfill(
    script: Script, dealt_with: Callable[[str], AcknowledgeAlarm | ResolveAlarm]
) -> None:
    script.wait(1, lambda: script.status(U))
    pressed = UnitEvent(script.header(U), EventKind.MAYDAY)
    script.wait(1, lambda: script.status(U, mayday=True))
    script.wait(5)
    script.act(dealt_with(script.alarms[-1].alarm_id))
    script.wait(5, lambda: script.status(U, mayday=True))
    script.record(backfilled_key(U, EVENT.suffix), encode(pressed))
    script.wait(1)
    assert len(changes(script, "mayday")) == 2
    script.event(U, EventKind.MAYDAY)
    assert changes(script, "mayday")[2:] == [("RAISED", "mayday")]


def test_second_press_after_a_lost_cancellation_stands(script: Script) -> None:
    """The radio lost the first press and its cancellation."""
    script.wait(1, lambda: script.status(U))
    cancelled = UnitEvent(script.header(U), EventKind.MAYDAY_CANCELLED)
    script.wait(3)
    script.event(U, EventKind.MAYDAY)
    script.wait(1)
    script.act(AcknowledgeAlarm(script.alarms[-1].alarm_id))
    script.record(backfilled_key(U, EVENT.suffix), encode(cancelled))
    script.wait(3, lambda: script.status(U, mayday=True))
    assert changes(script, "mayday") == [("RAISED", "mayday"), ("ACKNOWLEDGED", "mayday")]


@pytest.mark.parametrize("is_pressed", [True, False])
@pytest.mark.parametrize("before_s", [0.0, 0.1])
def test_status_overtaken_by_an_alert_raises_and_cancels_nothing(
    script: Script, is_pressed: bool, before_s: float
) -> None:
    words = [EventKind.MAYDAY, EventKind.MAYDAY_CANCELLED, EventKind.MAYDAY]
    for kind in words if is_pressed else words[:2]:
        before = message_factory.status(script.header(U), mayday=not is_pressed)
        script.now_s += before_s
        script.event(U, kind)
        script.now_s += 0.1
    script.act(AcknowledgeAlarm(script.alarms[-1].alarm_id))
    count = len(changes(script, "mayday"))
    script.wait(1)
    script.say(before)
    script.wait(3, lambda: script.status(U, mayday=is_pressed))
    assert len(changes(script, "mayday")) == count


def test_press_received_with_an_earlier_cancellation_is_a_mayday(
    script: Script,
) -> None:
    """Backfilled messages of one batch may have one time."""
    script.event(U, EventKind.MAYDAY_CANCELLED)
    script.event(U, EventKind.MAYDAY)
    assert changes(script, "mayday") == [("RAISED", "mayday")]


def test_second_press_is_another_mayday(script: Script) -> None:
    script.event(U, EventKind.MAYDAY)
    script.act(ResolveAlarm(script.alarms[-1].alarm_id, ""))
    script.wait(5, lambda: script.status(U, mayday=True))
    assert changes(script, "mayday")[-1] == ("RESOLVED", "mayday"), "it is the same press"
    script.event(U, EventKind.MAYDAY)
    assert changes(script, "mayday")[-1] == ("RAISED", "mayday")
    assert script.alarms[0].alarm_id != script.alarms[-1].alarm_id


def test_press_after_a_cancellation_raises_again(script: Script) -> None:
    script.event(U, EventKind.MAYDAY)
    script.wait(1)
    script.event(U, EventKind.MAYDAY_CANCELLED)
    script.act(ResolveAlarm(script.alarms[-1].alarm_id, "spoke to him"))
    script.wait(5, lambda: script.status(U))
    assert changes(script, "mayday")[-1] == ("RESOLVED", "mayday")
    script.event(U, EventKind.MAYDAY)
    assert changes(script, "mayday")[-1] == ("RAISED", "mayday")


def test_late_mayday_of_an_earlier_run_counts(script: Script) -> None:
    script.event(U, EventKind.STARTED)
    late = script.header(U, captured_s=-5.0)
    script.event(U, EventKind.STOPPED)
    script.say(UnitEvent(late, EventKind.MAYDAY))
    assert changes(script, "mayday") == [("RAISED", "mayday")]


def test_press_cancelled_before_the_registration_is_no_mayday() -> None:
    script = Script()
    script.event(U, EventKind.MAYDAY)
    script.event(U, EventKind.MAYDAY_CANCELLED)
    script.register(U)
    assert changes(script, "mayday") == []
