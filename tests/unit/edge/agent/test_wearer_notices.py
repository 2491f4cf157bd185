"""Notices of the wearer follow from the unit's state alone, the most urgent first."""

from __future__ import annotations

import pytest

from edge.agent.open_commands import NOTIFIES_WEARER, OpenCommand
from edge.agent.wearer_notices import NO_MOTION_S, PRE_ALERT_S, WearerState, notices
from edge.notifiers.signals import Notice, Signal, sentence
from shared.messages import CommandKind


def signals(state: WearerState, *kinds: CommandKind) -> list[Signal]:
    commands = [OpenCommand(kind.name, kind, "", 0) for kind in kinds]
    return [notice.signal for notice in notices(state, commands)]


def test_a_unit_that_is_well_is_silent() -> None:
    assert notices(WearerState(is_worn=True, battery=0.5), ()) == ()


@pytest.mark.parametrize(
    ("state", "signal"),
    [
        (WearerState(is_worn=True, motionless_s=PRE_ALERT_S), Signal.PRE_ALERT),
        (WearerState(is_worn=True, motionless_s=NO_MOTION_S), Signal.NO_MOTION),
        (WearerState(is_on_foot=False), Signal.NOT_ON_FOOT),
        (WearerState(battery=0.19), Signal.BATTERY_LOW),
        (WearerState(unlinked_s=30.0), Signal.LINK_LOST),
        (WearerState(maydays_called=1), Signal.MAYDAY_CALLED),
        (WearerState(maydays_received=1), Signal.MAYDAY_SENT),
    ],
)
def test_each_state_has_its_signal(state: WearerState, signal: Signal) -> None:
    assert signals(state) == [signal]


def test_a_unit_that_lies_on_a_shelf_gives_no_pre_alert() -> None:
    assert signals(WearerState(motionless_s=500.0)) == []


def test_a_second_mayday_is_a_notice_of_its_own() -> None:
    first, second = (notices(WearerState(maydays_received=count), ()) for count in (1, 2))
    assert first != second


def test_evacuation_comes_before_all_and_nothing_is_left_out() -> None:
    state = WearerState(is_worn=True, motionless_s=25.0, battery=0.1)
    assert signals(state, CommandKind.TEXT, CommandKind.EVACUATE) == [
        Signal.EVACUATE,
        Signal.PRE_ALERT,
        Signal.TEXT,
        Signal.BATTERY_LOW,
    ]


@pytest.mark.parametrize("kind", sorted(NOTIFIES_WEARER))
def test_each_command_of_which_the_wearer_is_notified_has_a_signal(kind: CommandKind) -> None:
    assert len(signals(WearerState(), kind)) == 1


def test_a_message_is_spoken_with_its_text() -> None:
    assert sentence(Notice(Signal.TEXT, "c1", "come out")) == "Message: come out"
