"""Commands to units, and how far each has got with each unit.  Plain data."""

from __future__ import annotations

from typing import Literal

import msgspec

from shared.messages import ASKS_WEARER, CommandKind

AnsweredBy = Literal["", "self", "radio"]
DeliveryState = Literal["queued", "sent", "received", "acknowledged", "refused", "expired"]


class Delivery(msgspec.Struct):
    """One command on its way to one unit; station times, None: not yet.

    Times are filled in, so that the order in which news come does not matter; what was entered by
    radio alone can be undone.
    """

    unit_id: str
    sent_ns: int | None = None  # first
    received_ns: int | None = None
    acknowledged_ns: int | None = None
    acknowledged_by: str = ""
    acknowledged_via: AnsweredBy = ""  # the member's own unit, or by radio; empty: not yet
    refused_ns: int | None = None
    reason: str = ""  # of a refusal
    expired_ns: int | None = None


class SentCommand(msgspec.Struct):
    """What a person told units to do."""

    command_id: str
    kind: CommandKind
    text: str
    position_rate_hz: float
    issued_by: str
    issued_ns: int
    expires_ns: int
    deliveries: dict[str, Delivery]  # by unit
    incident_id: str = ""  # that was open when it was given; empty: none was

    @property
    def asks_wearer(self) -> bool:
        """Whether it is done only when somebody has acknowledged it."""
        return self.kind in ASKS_WEARER

    @property
    def is_open(self) -> bool:
        return any(map(self.awaits, self.deliveries.values()))

    def awaits(self, delivery: Delivery) -> bool:
        """Whether anything more is to come of it in time."""
        state = self.state_of(delivery)
        return state in {"queued", "sent"} or (state == "received" and self.asks_wearer)

    def state_of(self, delivery: Delivery) -> DeliveryState:
        """What happened too late is still what happened."""
        if delivery.acknowledged_ns is not None:
            return "acknowledged"
        received = delivery.received_ns is not None
        if delivery.refused_ns is not None and not received:
            return "refused"
        if delivery.expired_ns is not None and not (received and not self.asks_wearer):
            return "expired"
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
