"""The reader: gestures in order, a button that is removed and returns, and each fault once."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from edge.samples import ACKNOWLEDGE, CANCEL, MAYDAY
from edge.wearer import reader as reader_module
from tests.rig.scripted_button import ScriptedButton, pressed
from tests.rig.waiting import until


@pytest.fixture
def button(monkeypatch: pytest.MonkeyPatch) -> Iterator[ScriptedButton]:
    monkeypatch.setattr(reader_module, "_RETRY_S", 0.01)
    button = ScriptedButton()
    button.reader.start()
    button.let_look()
    yield button
    button.clock.advance(60.0)
    button.reader.close()


def faults(button: ScriptedButton) -> list[str]:
    found: list[str] = []

    def have_come() -> bool:
        found.extend(button.reader.take_faults())
        return bool(found)

    until(have_come, "a fault")
    return found


def test_gestures_are_handed_over_in_order(button: ScriptedButton) -> None:
    button.press(3.5)
    button.release(1.0)
    for _ in range(2):
        button.press(0.2)
        button.release(0.3)
    button.advance(1.0)
    button.press(0.2)
    button.release(1.0)
    assert pressed(button.reader, 3) == [MAYDAY, CANCEL, ACKNOWLEDGE]
    assert button.reader.take() == ()
    assert button.reader.take_faults() == ()


def test_a_button_that_goes_is_reported_once_and_read_again(button: ScriptedButton) -> None:
    for _ in range(3):
        button.is_there = False
        button.let_look()
        button.is_there = True
        button.let_look()
    assert faults(button) == ["button scripted: cannot be read: there is no button; plug it in"]
    button.press(3.5)
    assert pressed(button.reader, 1) == [MAYDAY]
    assert button.opened == 4
    assert button.closed >= 3


def test_fault_after_a_time_of_reading_is_reported_again(button: ScriptedButton) -> None:
    for _ in range(2):
        button.is_there = False
        assert "there is no button" in faults(button)[0]
        button.is_there = True
        button.let_look()
        button.advance(11.0)


def test_a_hold_ends_with_the_connection(button: ScriptedButton) -> None:
    button.press(1.5)
    button.is_there = False
    button.let_look()
    button.release()
    button.is_there = True
    button.advance(5.0)
    button.press(0.2)
    button.release(1.0)
    assert pressed(button.reader, 1) == [ACKNOWLEDGE]


def test_a_button_that_is_stuck_is_a_fault_and_one_mayday(button: ScriptedButton) -> None:
    button.press(600.0)
    assert pressed(button.reader, 1) == [MAYDAY]
    (fault,) = faults(button)
    assert "pressed for 60 s" in fault
    button.is_there = False
    button.let_look()
    button.is_there = True
    button.advance(600.0)
    assert [one for one in button.reader.take_faults() if "pressed for 60 s" not in one] == [
        "button scripted: cannot be read: there is no button; plug it in"
    ]
    assert button.reader.take() == ()


def test_a_driver_that_breaks_is_reported_once_and_opened_again(button: ScriptedButton) -> None:
    def break_down() -> None:
        raise ZeroDivisionError("of the driver")

    button.fails = break_down
    assert faults(button) == ["button scripted: cannot be read: ZeroDivisionError: of the driver"]
    button.let_look()
    assert button.reader.take_faults() == ()
    button.fails = lambda: None
    button.let_look()
    button.press(3.5)
    assert pressed(button.reader, 1) == [MAYDAY]


def test_at_the_end_a_mayday_that_is_being_called_is_waited_for(monkeypatch) -> None:
    monkeypatch.setattr(reader_module, "_DECIDED_S", 120.0)
    button = ScriptedButton()
    button.reader.start()
    button.press(1.0)

    class Passing(type(button.clock)):  # type: ignore[misc]
        def monotonic_ns(self) -> int:
            self.advance(0.05)
            return int(super().monotonic_ns())

    button.clock.__class__ = Passing
    button.reader.close()
    assert [one.button for one in button.reader.take()] == [MAYDAY]
    assert button.closed == 1


def test_at_the_end_a_stuck_button_is_not_waited_for(monkeypatch) -> None:
    monkeypatch.setattr(reader_module, "_DECIDED_S", 1e9)
    button = ScriptedButton()
    button.reader.start()
    button.press(10.0)
    assert pressed(button.reader, 1) == [MAYDAY]
    button.reader.close()
    assert button.closed == 1


def test_unstarted_reader_is_closed_at_once(monkeypatch) -> None:
    monkeypatch.setattr(reader_module, "_DECIDED_S", 1e9)
    ScriptedButton().reader.close()
