"""Descriptions of fields about incidents, their members and the personnel accountability report."""

from __future__ import annotations

from collections.abc import Mapping

FIELDS: Mapping[str, str] = {
    # ---- accountability
    "Confirmation.unit_id": "The unit whose wearer has answered by radio.",
    "NewCheckIn.incident_id": "Only of who is in this open incident; null: of all of the target, "
    "and of everyone only where one incident is open.",
    "OnDuty.state": "green (confirmed), not_confirmed (not yet), warning (soon due) or overdue.",
    "left_s": "Seconds until the next PAR is due; negative: overdue.",
    "checked_in_ms": "When the PAR was last confirmed; null: not yet.",
    "checked_in_by": "Whose the last PAR confirmation is: the member, where it came by own unit, "
    "or the user who entered that by radio; empty: not yet confirmed.",
    "confirmed": "How the PAR was last confirmed: self (on the member's own unit) or radio; "
    "not_yet: it never was in this incident.",
    "on_duty_ms": "Since when the member has been on duty in the open incident.",
    "located": "Whether a message of the unit has come in this incident.",
    "OnDuty.entry_id": "Of a PAR confirmation by radio: the id of the check-in, or of the "
    "command, by which it can be undone; empty: there is none to undo.",
    "check_in_id": "The check-in's id, of the client's choice, by which it can be undone; null: "
    "the station gives one.",
    "UndoCheckIn.unit_id": "The one member's unit; empty: of all whom the check-in confirmed.",
    "asked_ms": "When a PAR was requested that is not answered yet; null: none is.",
    "work_since_ms": "When the present work began; null: not at work.",
    "rest_since_ms": "When the present rest began; null: not at rest.",
    "resting": "true: goes to rest (rehab); false: is ready for work again.",
    # ---- incidents
    "incident_id": "The incident's id.",
    "beside_others": "True: it is opened although others are open, and nobody is in it at first; "
    "else it is refused then.",
    "site_id": "The ground that it belongs to; empty: the station's own site.",
    "Member.name": "The wearer's name; of a unit that nobody wears its label.",
    "Member.person_id": "Id of the person who wears it; null: nobody does.",
    "NewMembers.target": "Who comes to the incident: one unit with its wearer, one crew, one "
    "floor, or everyone who wears a unit.",
    "opened_ms": "When the incident was opened.",
    "opened_by": "The user who opened it.",
    "closed_ms": "When the incident was closed; null: it is open.",
    "closed_by": "The user who closed it; empty: it is open.",
    "par_interval_s": "How often everybody on duty is to be heard from (PAR), in seconds; left "
    "out: as the station is configured.",
    "work_limit_s": "After how many seconds of work rest is due; left out: as the station is "
    "configured.",
    "from_ms": "Beginning of the time that is meant.",
    "until_ms": "End of the time that is meant; null: it goes on.",
    "to_ms": "End of the time that is meant; left out: now.",
    "despite_alarm_ids": "Open alarms over which the incident is closed knowingly.",
    "despite_unit_ids": "Units of people who are inside and over whom it is closed knowingly.",
}
