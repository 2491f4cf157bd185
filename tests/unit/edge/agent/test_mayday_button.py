"""Presses of the button that raise, repeat and cancel a mayday."""

from __future__ import annotations

import pytest

from edge.agent.mayday_button import MaydayButton
from edge.samples import ACKNOWLEDGE, CANCEL, MAYDAY, ButtonPress
from shared.clock import NS_PER_S
from shared.messages import EventKind


@pytest.mark.parametrize(("after_s", "event"), [(0.0, None), (2.9, None), (3.0, EventKind.MAYDAY)])
def test_a_press_is_sent_again_after_three_seconds(after_s: float, event: EventKind | None) -> None:
    button = MaydayButton()
    assert button.event_of(ButtonPress(NS_PER_S, MAYDAY)) is EventKind.MAYDAY
    again = ButtonPress(NS_PER_S + round(after_s * NS_PER_S), MAYDAY)
    assert button.event_of(again) is event
    assert button.is_active


def test_only_an_active_mayday_is_cancelled() -> None:
    button = MaydayButton()
    assert button.event_of(ButtonPress(0, CANCEL)) is None
    button.event_of(ButtonPress(1, MAYDAY))
    assert button.event_of(ButtonPress(2, CANCEL)) is EventKind.MAYDAY_CANCELLED
    assert not button.is_active
    assert button.event_of(ButtonPress(3, MAYDAY)) is EventKind.MAYDAY


def test_a_mayday_from_before_a_restart_is_sent_again_by_the_first_press() -> None:
    button = MaydayButton(is_active=True)
    assert button.event_of(ButtonPress(0, MAYDAY)) is EventKind.MAYDAY


def test_another_button_changes_nothing() -> None:
    button = MaydayButton(is_active=True)
    assert button.event_of(ButtonPress(0, ACKNOWLEDGE)) is None
    assert button.is_active
