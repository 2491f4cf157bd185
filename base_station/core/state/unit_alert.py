"""Alerts that a unit has raised: the mayday of its wearer, and a fall."""

from __future__ import annotations

import msgspec

from shared.messages import Header


class UnitAlert(msgspec.Struct):
    """Last alert of one kind; it may have waited in the unit's journal."""

    t_ns: int | None = None  # station time of receipt; None: there was none
    event_ns: int = 0  # when the unit raised it
    is_dated: bool = True  # else that time is unknown

    @property
    def dated_ns(self) -> int | None:
        """Time at which the unit raised it; None: unknown."""
        return self.event_ns if self.is_dated else None

    def note(self, t_ns: int, event_ns: int, *, is_dated: bool = True) -> None:
        """Note that it was raised; ``t_ns``: station time of receipt."""
        self.t_ns, self.event_ns, self.is_dated = t_ns, event_ns, is_dated


class MaydayCall(UnitAlert):
    """Last press of the mayday button, and its cancellation."""

    boot_id: int = 0  # of the message that reported the press
    seq: int = 0
    cancelled_ns: int | None = None  # since then
    cancelled_event_ns: int = 0

    @property
    def is_active(self) -> bool:
        """True for a mayday that was not cancelled."""
        return self.t_ns is not None and self.cancelled_ns is None

    def press(self, header: Header, t_ns: int, event_ns: int, *, is_dated: bool = True) -> None:
        """Note a press that the message with this header reports."""
        self.note(t_ns, event_ns, is_dated=is_dated)
        self.boot_id, self.seq, self.cancelled_ns = header.boot_id, header.seq, None

    def cancel(self, t_ns: int, event_ns: int) -> None:
        """Note that the wearer has cancelled the mayday."""
        self.cancelled_ns, self.cancelled_event_ns = t_ns, event_ns
