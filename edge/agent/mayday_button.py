"""Mayday by the unit's button: raised, sent again, and cancelled."""

from __future__ import annotations

from edge.samples import CANCEL, MAYDAY, ButtonPress
from shared.clock import NS_PER_S
from shared.messages import EventKind

_ONE_PRESS_NS = 3 * NS_PER_S  # a thumb that presses several times


class MaydayButton:
    """State of the mayday.  It stays until the wearer cancels it; pressed again it is sent again,
    as an operator may have resolved the first one.
    """

    def __init__(self, *, is_active: bool = False) -> None:
        self.is_active = is_active
        self._sent_ns: int | None = None  # when it was pressed and sent

    def event_of(self, press: ButtonPress) -> EventKind | None:
        """Apply a press; returns the event to send, None: there is none."""
        if press.button == CANCEL:
            was_active, self.is_active = self.is_active, False
            return EventKind.MAYDAY_CANCELLED if was_active else None
        if press.button != MAYDAY:
            return None
        sent_ns, now_ns = self._sent_ns, press.t_ns
        if self.is_active and sent_ns is not None and 0 <= now_ns - sent_ns < _ONE_PRESS_NS:
            return None
        self.is_active, self._sent_ns = True, now_ns
        return EventKind.MAYDAY
