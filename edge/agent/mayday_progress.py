"""Progress of the wearer's maydays: called, received by the station, acknowledged there."""

from __future__ import annotations

from collections.abc import Iterable

from shared.messages import Command, EventKind, Header, Message, UnitEvent


class MaydayProgress:
    """Maydays of one boot, from the unit's own messages and the station's answers."""

    def __init__(self) -> None:
        self._active: Header | None = None  # of the newest call, until it is cancelled
        self._sent: Header | None = None  # of a call that is not known to have arrived
        self.called = 0
        self.received = 0  # of these, by the station
        self.acknowledgement = ""  # id of the command that acknowledged the newest call, or empty

    def note_own(self, messages: Iterable[Message]) -> None:
        """Note the unit's own messages, as they are sent."""
        for message in messages:
            if not isinstance(message, UnitEvent):
                continue
            if message.kind is EventKind.MAYDAY:
                self._active = self._sent = message.header
                self.called += 1
                self.acknowledgement = ""
            elif message.kind is EventKind.MAYDAY_CANCELLED:
                self._active = None
                self.acknowledgement = ""

    def note_received(self, acknowledged_seq: int) -> None:
        """Note the number up to which the station has all of the unit's messages."""
        if self._sent is not None and acknowledged_seq >= self._sent.seq:
            self._sent = None
            self.received += 1

    def is_acknowledged_by(self, command: Command) -> bool:
        """True if the command acknowledges the newest call: the station had that message or a later
        one of it.  False for a call of an earlier boot, as this boot has called again.
        """
        call = self._active
        return (
            call is not None
            and command.mayday_boot_id == call.boot_id
            and command.mayday_seq >= call.seq
        )

    def note_acknowledged(self, command_id: str) -> None:
        """Note that the station has acknowledged the newest call."""
        self.acknowledgement = command_id
