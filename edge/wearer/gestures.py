"""Gestures made with one button: from its contact's changes to what the wearer means.

Pure: time comes with the changes.  What comes out depends on those alone, not on how often
``advance`` is called.

- held for 2 s, or as long as is set: MAYDAY, at once when the time is over;
- two short presses: CANCEL;
- one short press: ACKNOWLEDGE, when no second one has followed.

A press of between one second and that is an abandoned hold, and means nothing.
"""

from __future__ import annotations

from dataclasses import dataclass

from edge.samples import ACKNOWLEDGE, CANCEL, MAYDAY, ButtonPress
from edge.wearer.interface import ContactChange
from shared.clock import NS_PER_MS, NS_PER_S

BOUNCE_NS = 30 * NS_PER_MS  # a state that lasts shorter is none
SHORT_NS = NS_PER_S  # a press in thick gloves
SECOND_WITHIN_NS = 600 * NS_PER_MS  # from the release of the first press to the second one
HOLD_NS = 2 * NS_PER_S
HOLD_LEAST_NS = 3 * NS_PER_S // 2  # well beyond a short press
HOLD_MOST_NS = 5 * NS_PER_S  # longer is long for who is in danger
STUCK_NS = 60 * NS_PER_S


@dataclass(frozen=True, slots=True)
class ButtonStuck:
    """The button has been pressed for longer than anyone presses."""

    t_ns: int


Gesture = ButtonPress | ButtonStuck


class GestureRecognizer:
    """Recogniser of one button's gestures; changes are pushed in order of time."""

    def __init__(self, hold_ns: int = HOLD_NS) -> None:
        """``hold_ns``: after which a hold is a mayday."""
        self._hold_ns = hold_ns
        self._raw = False  # the contact, bounce and all
        self._raw_ns = 0  # since when
        self._is_pressed = False
        self._pressed_ns = 0
        self._first_ns: int | None = None  # release of a short press that a second may follow
        self._is_called = False  # this hold has given its mayday
        self._is_stuck = False  # this hold has been reported
        self._was_called = False  # by a hold at whose end the button was gone

    @property
    def is_undecided(self) -> bool:
        """True while what the wearer does may become a gesture."""
        is_held = (self._is_pressed or self._raw) and not self._is_called
        return is_held or self._raw != self._is_pressed or self._first_ns is not None

    def push(self, change: ContactChange) -> list[Gesture]:
        found = self.advance(change.t_ns)
        if not change.is_pressed:
            self._was_called = False
        if change.is_pressed != self._raw:
            self._raw, self._raw_ns = change.is_pressed, change.t_ns
        return found

    def advance(self, now_ns: int) -> list[Gesture]:
        """Take it that the contact has not changed since, up to now."""
        found: list[Gesture] = []
        if self._raw != self._is_pressed and now_ns - self._raw_ns >= BOUNCE_NS:
            found += self._press(self._raw_ns) if self._raw else self._release(self._raw_ns)
        if self._raw != self._is_pressed:
            return found  # it may bounce
        return found + (self._hold(now_ns) if self._is_pressed else self._miss_second(now_ns))

    def lose(self, now_ns: int) -> list[Gesture]:
        """Take note that the button is gone: a hold is broken off.  One that has given its mayday
        and is found going on later is the same hold, and gives no second one.
        """
        found = self.advance(now_ns)
        self._was_called = self._is_pressed and self._is_called
        self._raw = self._is_pressed = self._is_called = False
        return found

    def _press(self, t_ns: int) -> list[Gesture]:
        found = self._miss_second(t_ns)
        self._is_pressed, self._pressed_ns = True, t_ns
        self._is_called, self._is_stuck, self._was_called = self._was_called, False, False
        return found

    def _release(self, t_ns: int) -> list[Gesture]:
        found = self._hold(t_ns)
        is_short = t_ns - self._pressed_ns <= SHORT_NS and not self._is_called
        self._is_pressed = self._is_called = False
        if not is_short:
            return found
        if self._first_ns is None:
            self._first_ns = t_ns
            return found
        self._first_ns = None
        return [*found, ButtonPress(t_ns, CANCEL)]

    def _hold(self, now_ns: int) -> list[Gesture]:
        """Return what follows from a press that has lasted until now."""
        found: list[Gesture] = []
        held_ns = now_ns - self._pressed_ns
        if self._first_ns is not None and held_ns > SHORT_NS:  # no second short one
            found.append(self._acknowledgement())
        if held_ns >= self._hold_ns and not self._is_called:
            self._is_called = True
            found.append(ButtonPress(self._pressed_ns + self._hold_ns, MAYDAY))
        if held_ns > STUCK_NS and not self._is_stuck:
            self._is_stuck = True
            found.append(ButtonStuck(self._pressed_ns + STUCK_NS))
        return found

    def _miss_second(self, now_ns: int) -> list[Gesture]:
        """Return the single press that it was, where no second one has followed in time."""
        if self._first_ns is None or now_ns - self._first_ns <= SECOND_WITHIN_NS:
            return []
        return [self._acknowledgement()]

    def _acknowledgement(self) -> ButtonPress:
        assert self._first_ns is not None
        press = ButtonPress(self._first_ns, ACKNOWLEDGE)
        self._first_ns = None
        return press
