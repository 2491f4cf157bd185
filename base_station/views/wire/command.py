"""Views of a command to units and of its delivery."""

from __future__ import annotations

from typing import Annotated

from base_station.views.answer import Answer
from base_station.views.wire.schema import one_of
from base_station.views.wire.text_code import TextCodeView


class DeliveryView(Answer, frozen=True):
    """Progress of a command with one unit."""

    unit_id: str
    state: Annotated[
        str,
        one_of("queued", "sent", "received", "notified", "acknowledged", "refused", "expired"),
    ]
    sent_ms: int | None
    received_ms: int | None
    notified_ms: int | None  # an output of the unit has notified the wearer
    acknowledged_ms: int | None
    acknowledged_by: str  # self: the member; radio: who entered it
    reason: str  # of a refusal, or of a withdrawal
    # self: on the member's own unit; empty: not yet
    acknowledged_via: Annotated[str, one_of("self", "radio", "")]
    can_be_notified: bool | None  # as known at the last event; None: not known yet
    repeated_ms: int | None = None  # when the order was sent again last
    ended_ms: int | None = None  # the unit has answered that it knows that the order is over
    # Of a LOCATE: how the unit signals its place; empty: not known.
    signal: Annotated[str, one_of("sound", "light", "")] = ""
    reason_code: TextCodeView | None = None  # of ``reason``, where it has one


class CommandView(Answer, frozen=True):
    """A command to units; a delta carries it whole."""

    command_id: str
    kind: str  # lower-case name of shared.messages.CommandKind
    text: str
    issued_by: str
    issued_ms: int
    expires_ms: int
    asks_wearer: bool  # done only when the wearer has acknowledged it
    notifies_wearer: bool  # an output of each unit that has one is to notify its wearer
    open: bool  # open for further answers
    units: tuple[DeliveryView, ...]
    incident_id: str  # that was open when it was given; empty: none was
    ended_ms: int | None = None  # all clear, stopped, or its incident closed; None: it stands
    ended_command_id: str = ""  # of an all clear: the evacuation that it has ended
