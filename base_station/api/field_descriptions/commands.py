"""Descriptions of fields about commands to units and their delivery."""

from __future__ import annotations

from collections.abc import Mapping

FIELDS: Mapping[str, str] = {
    "UnitTarget.unit_id": "The one unit that is meant.",
    "CrewTarget.crew": "The crew that is meant, as the roster names it: who is a member now.",
    "FloorTarget.floor": "The floor that is meant: who is on it now, and whose floor is not known.",
    "everyone": "Always true: everybody who wears a unit is meant.",
    "target": "Whom it is for: one unit, one crew, one floor, or everyone.",
    "NewCommand.incident_id": "Only to who is in this open incident; null: to all of the target.",
    "CommandView.text": "The message to the wearer; empty: there is none.",
    "NewCommand.text": "The message to the wearer; only with the kind text.",
    "command_id": "The command's id.",
    "CommandView.kind": "evacuate, par_request, text, locate, set_position_rate, or "
    "mayday_acknowledged or alarm_acknowledged, which the station sends to the unit when an alarm "
    "about its wearer is acknowledged.",
    "issued_by": "The user who gave it.",
    "issued_ms": "When it was given.",
    "expires_ms": "Until when it is sent to units that have not answered.",
    "expires_s": "For how many seconds it is sent to units that have not answered.",
    "position_rate_hz": "Positions a second; only with the kind set_position_rate.",
    "asks_wearer": "Whether it is done only when the wearer, or another for the wearer, has "
    "acknowledged it.",
    "open": "Whether any unit's delivery can still change.",
    "CommandView.units": "How far it has got with each unit.",
    "DeliveryView.state": "queued, sent, received, notified, acknowledged, refused or expired.",
    "sent_ms": "When it was last sent to the unit; null: not yet.",
    "received_ms": "When the unit had received it; null: not yet.",
    "notified_ms": "When an output of the unit had notified the wearer; null: not yet.",
    "notifies_wearer": "Whether outputs of the units notify the wearers of it.",
    "can_be_notified": "Whether the unit has an output that notifies its wearer; null: not known "
    "yet.",
    "acknowledged_ms": "When it was acknowledged; null: not yet.",
    "acknowledged_by": "Whose the answer is: the member, or the user who entered it.",
    "acknowledged_via": "How the answer came: self (on the member's own unit) or radio; empty: not "
    "yet.",
    "CommandView.incident_id": "The incident that was open when it was given; empty: none was.",
    "repeated_ms": "When the order was last sent to the unit again; null: it was not.",
    "DeliveryView.reason_code": "Code of the reason; null: it has none.",
    "DeliveryView.ended_ms": "When the unit had answered that the order is over; null: not yet.",
    "signal": "How the unit signals its place: sound or light; empty: not known.",
    "CommandView.ended_ms": "When it ended: by an all clear, by being stopped, or with its "
    "incident; null: it stands.",
    "ended_command_id": "The evacuation that an all clear has ended; empty: it is none.",
    "Repeat.unit_id": "The unit to which it is sent again; null: all that have not answered.",
    "reason": "Why the unit refused it, or why it was withdrawn; empty: neither.",
}
