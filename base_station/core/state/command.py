"""Commands to units, and their progress at each unit.  Plain data."""

from __future__ import annotations

from typing import Literal

import msgspec

from shared.coded_text import NO_CODE, TextCode, code_of_text
from shared.messages import ASKS_WEARER, CommandKind

AnsweredBy = Literal["", "self", "radio"]
DeliveryState = Literal[
    "queued", "sent", "received", "notified", "acknowledged", "refused", "expired"
]
Signal = Literal["", "sound", "light"]
# The others concern the unit alone.
NOTIFIES_WEARER = ASKS_WEARER | {
    CommandKind.LOCATE,
    CommandKind.MAYDAY_ACKNOWLEDGED,
    CommandKind.ALARM_ACKNOWLEDGED,
}


class Delivery(msgspec.Struct):
    """One command on its way to one unit; station times, None: not yet.

    Each event sets its own time, so that the order of arrival does not matter.  Only answers
    entered by radio can be undone.
    """

    unit_id: str
    sent_ns: int | None = None  # first
    received_ns: int | None = None
    acknowledged_ns: int | None = None
    acknowledged_by: str = ""
    acknowledged_via: AnsweredBy = ""  # the member's own unit, or by radio; empty: not yet
    refused_ns: int | None = None
    reason: str = ""  # of a refusal or a withdrawal
    expired_ns: int | None = None
    notified_ns: int | None = None  # an output of the unit has notified the wearer
    # Whether the unit has an output, as known at the last event; None: unknown.
    can_be_notified: bool | None = None
    end_sent_ns: int | None = None  # the unit may know that the order is over for it
    ended_ns: int | None = None  # it has answered the end
    repeat_id: str = ""  # under which it was sent again last; empty: it was not
    repeated_ns: int | None = None
    expires_ns: int | None = None  # of the repeat; None: as the command
    all_clear_id: str = ""  # of the command that has ended this evacuation for the unit
    signal: Signal = ""  # of LOCATE: signals that the wearer and others perceive; empty: unknown
    reason_code: TextCode = NO_CODE  # of ``reason``; NO_CODE: from a foreign unit

    def set_reason(self, reason: str) -> None:
        """Set the reason with its code, where it has one."""
        self.reason, self.reason_code = str(reason), code_of_text(reason)

    def expire(self, t_ns: int, reason: str) -> None:
        """Expire it without an answer."""
        self.expired_ns = t_ns
        self.set_reason(reason)


class SentCommand(msgspec.Struct):
    """Command of a person to units."""

    command_id: str
    kind: CommandKind
    text: str
    position_rate_hz: float
    issued_by: str
    issued_ns: int
    expires_ns: int
    deliveries: dict[str, Delivery]  # by unit
    incident_id: str = ""  # that was open when it was given; empty: none was
    # Of MAYDAY_ACKNOWLEDGED: the unit's message by which the mayday is known.
    mayday_boot_id: int = 0
    mayday_seq: int = 0
    alarm_id: str = ""  # of ALARM_ACKNOWLEDGED
    repeat_ids: list[str] = []  # under which it was sent again
    ended_command_id: str = ""  # of ALL_CLEAR: the evacuation that it has ended
    # All clear, closed incident, or signal stopped; None: it stands, answered or not.
    ended_ns: int | None = None

    @property
    def asks_wearer(self) -> bool:
        """True if it is done only when the wearer has acknowledged it."""
        return self.kind in ASKS_WEARER

    @property
    def notifies_wearer(self) -> bool:
        """True if an output of the unit is to notify the wearer of it."""
        return self.kind in NOTIFIES_WEARER

    @property
    def is_open(self) -> bool:
        return any(map(self.awaits, self.deliveries.values()))

    def awaits(self, delivery: Delivery) -> bool:
        """True if the delivery still waits for an answer, and can expire."""
        state = self.state_of(delivery)
        if state in {"queued", "sent"}:
            return True
        if self.asks_wearer:
            return state in {"received", "notified"}
        if self.kind is CommandKind.LOCATE and state == "notified":
            return delivery.expired_ns is None  # the unit signals until it is stopped
        return state == "received" and delivery.expired_ns is None and self._notifies(delivery)

    def expires_ns_of(self, delivery: Delivery) -> int:
        """Station time at which it expires for a unit."""
        return self.expires_ns if delivery.expires_ns is None else delivery.expires_ns

    def _notifies(self, delivery: Delivery) -> bool:
        return self.notifies_wearer and bool(delivery.can_be_notified)

    def state_of(self, delivery: Delivery) -> DeliveryState:
        """Return the state of a delivery; a late answer counts, too."""
        if delivery.acknowledged_ns is not None:
            return "acknowledged"
        received = delivery.received_ns is not None
        if delivery.refused_ns is not None and not received:
            return "refused"
        if delivery.expired_ns is not None and not (received and not self.asks_wearer):
            return "expired"
        if delivery.notified_ns is not None:
            return "notified"
        if received:
            return "received"
        return "queued" if delivery.sent_ns is None else "sent"


class Order(msgspec.Struct, frozen=True):
    """A command that a unit has not answered yet."""

    unit_id: str
    command_id: str
    kind: CommandKind
    issued_by: str
    expires_ns: int
    text: str
    position_rate_hz: float
    ended_command_id: str = ""  # of END_ORDER and ALL_CLEAR
    mayday_boot_id: int = 0  # of MAYDAY_ACKNOWLEDGED
    mayday_seq: int = 0
    repeats: str = ""  # id of the order that is sent again; empty: this is a new one
