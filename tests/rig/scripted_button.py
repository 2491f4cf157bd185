"""A wearer's button that a test presses, on a clock that the test sets."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable

from edge.samples import ButtonPress
from edge.wearer.interface import ButtonError, ContactChange
from edge.wearer.reader import ButtonReader
from shared.clock import ManualClock
from tests.rig.waiting import until


class ScriptedButton:
    """The driver; ``reader`` reads it."""

    def __init__(self) -> None:
        self.clock = ManualClock()
        self.clock.advance(100.0)
        self.reader = ButtonReader("button scripted", self, self.clock)
        self.is_there = True
        self.is_pressed = False
        self.fails: Callable[[], None] = lambda: None
        self.opened = self.closed = self.looks = 0
        self._changes: deque[ContactChange] = deque()

    def press(self, held_s: float = 0.0) -> None:
        self._turn(is_pressed=True)
        self.advance(held_s)

    def release(self, after_s: float = 0.0) -> None:
        self._turn(is_pressed=False)
        self.advance(after_s)

    def advance(self, duration_s: float) -> None:
        """Let time pass, when the reader has seen what was before it."""
        self.let_look()
        self.clock.advance(duration_s)
        self.let_look()

    def let_look(self) -> None:
        looks = self.looks
        until(lambda: self.looks >= looks + 3, "the reader looks")

    def open(self) -> None:
        self.looks += 1
        if not self.is_there:
            raise ButtonError("there is no button; plug it in")
        self.opened += 1
        self._changes.clear()
        self._turn(is_pressed=self.is_pressed)

    def wait(self, timeout_s: float) -> None:
        time.sleep(min(timeout_s, 0.002))

    def read(self) -> tuple[ContactChange, ...]:
        self.looks += 1
        self.fails()
        if not self.is_there:
            raise ButtonError("there is no button; plug it in")
        return tuple(self._changes.popleft() for _ in range(len(self._changes)))

    def close(self) -> None:
        self.closed += 1

    def _turn(self, *, is_pressed: bool) -> None:
        self.is_pressed = is_pressed
        self._changes.append(ContactChange(self.clock.monotonic_ns(), is_pressed))


def pressed(reader: ButtonReader, count: int) -> list[str]:
    """The next presses, when there are as many."""
    found: list[ButtonPress] = []

    def have_come() -> bool:
        found.extend(reader.take())
        return len(found) >= count

    until(have_come, f"{count} presses")
    return [one.button for one in found]
