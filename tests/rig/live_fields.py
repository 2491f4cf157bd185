"""Descriptions of members of the live picture that no answer of the API has."""

from __future__ import annotations

from collections.abc import Mapping

# Of the messages themselves.
MESSAGE_FIELDS: Mapping[str, str] = {
    "type": "Which message it is.",
    "seq": "Number of the message; each delta has the next one.",
    "now_ms": "Station time; in a replay, the time of the incident.",
    "units": "All units; in a delta those that changed, each of them whole.",
    "alarms": "All that are not resolved and the last resolved ones; in a delta those that "
    "changed.",
    "commands": "All that are open and the last closed ones; in a delta those that changed.",
    "pins": "In the order of setting; in a delta all of them, where any changed.",
    "beacons": "At known places; in a delta all of them, where any changed.",
    "external": "People and markers of other teams, where the site has an anchor; in a delta all "
    "of them, where any changed.",
    "plan": "GeoJSON as it was set; null: there is none.",
    "anchor": "Place of the incident frame on the Earth; null: not known.",
    "health": "The station's own state; in a delta where it changed.",
    "incident": "The open one; null: there is none; in a delta where something of it changed.",
    "replay": "Where a replay stands; null: the picture is live.",
    "dispatches": "Reports of the dispatch centre from which no incident was opened, oldest first.",
    "after_seq": "Number of the message that it follows.",
    "passed": "By unit: where it was between the two messages, at most once a second; only where "
    "several were merged.",
    "plan_placed": "False: nobody knows yet where on the plan people are.",
    "trails": "Whole trails, by unit, of units whose past changed.",
    "points": "By time.",
    "unit_id": "The unit that was there.",
}

# Of what stands in them.
LIVE_FIELDS: Mapping[str, str] = {
    "FieldDelta.units": "By unit: the members of a unit that changed.",
    # ---- an incident
    "IncidentView.dispatch": "The dispatch from which it was opened; null: none.",
    "number": "The dispatch's number at the dispatch centre.",
    "type_code": "The dispatch centre's code for the type of the incident.",
    "address": "Where it is, in words.",
    "called_ms": "When the call was taken; null: not known.",
    "dispatched_ms": "When units were sent; null: not known.",
    "updated_ms": "When the dispatch centre changed it last; null: not known.",
    "has_ended": "The dispatch centre has closed or cancelled it.",
    "warnings": "Parts of the report that were left out, in words.",
    "warning_codes": "Codes of warnings, in their order, for texts in other languages.",
    "is_dismissed": "Somebody decided that it opens no incident here.",
    "DispatchView.units": "Call signs of vehicles or crews.",
    "DispatchView.type": "Type of the incident, in words.",
    "DispatchView.priority": "Priority, as the dispatch centre has it.",
    "DispatchView.source": "Format in which it came: eido or json.",
    "DispatchView.received_ms": "When it came; null: it has opened an incident.",
    "DispatchView.remarks": "Free text of the dispatch centre.",
    # ---- a unit
    "IncidentView.par_warning_s": "How long before a PAR is due that is announced, seconds.",
    "UnitView.person": "Who wears it; null: nobody.",
    "link": "Whether messages come: live, late (stale), not any more (lost), or never yet.",
    "status": "The newest state of the unit and its wearer; null: none has come.",
    "status_ms": "When that was.",
    "ambient_degc": "Air temperature around the equipment; null: none has come.",
    "ambient_ms": "When that came.",
    "ambient_sensors": "Its readings by name; empty: one sensor.",
    "heat_level": "caution, warning or critical; empty: none of these.",
    "heat_used": "Part of the equipment's heat budget used in this incident, 0 to 1 and above.",
    "UnitView.position": "Where the wearer is; null: not known.",
    "inside_since_ms": "When the wearer went into the building; null: is not inside.",
    "duty": "PAR, work and rest; null: nobody wears it, or no incident is open.",
    "UnitView.alarms": "Ids of its alarms that are not resolved.",
    "UnitView.clock": "What it knows of the station's time; null: nothing yet.",
    "cloned": "Two machines speak under its name; one of them is shown.",
    "gps": "Why its last fix is not used; empty: it is; null: none has come.",
    "switched_off": "It was switched off in order: its silence since is no loss.",
    "preflight": "What it found when it checked itself at its start; null: it has not yet.",
    "PreflightView.level": "ok, or how bad the gravest finding is.",
    "PreflightView.text": "All findings in one text, the gravest first; empty: ok.",
    "findings": "The findings, the gravest first.",
    "finding_codes": "Codes of findings, in their order, for texts in other languages.",
    # ---- its status
    "activity": "What the wearer does, such as walking.",
    "motionless_s": "For how long the wearer has not moved.",
    "StatusView.battery": "Charge, 0 to 1; null: not known.",
    "mayday": "The wearer calls for help.",
    "steps": "Steps since the unit started.",
    "StatusView.distance_m": "Walked since the unit started.",
    "battery_left_s": "Time until the battery is empty; null: not known.",
    "battery_state": "Whether it is charged, such as discharging.",
    "electronics": "Temperatures inside the unit, which are not those of the air around it.",
    "posture": "How the body is held, such as upright or lying.",
    "posture_confidence": "Probability of the posture, 0 to 1.",
    "mobility": "How the wearer moves on, such as walking or crawling.",
    "temperature_degc": "The reading.",
    # ---- a position
    "ellipse_major_m": "Longer semi-axis of the region that holds the place with 95 %.",
    "ellipse_minor_m": "Shorter semi-axis of it.",
    "ellipse_heading_rad": "Heading of the longer axis.",
    "quality_reason": "Why the quality is not good; empty: it is.",
    "reason_codes": "Code of the reason, for texts in other languages; empty: it has none.",
    "since_gps_s": "Time since a fix of GPS was used; null: never.",
    "floor_down_m": "Height of that floor, metres below the origin of the incident frame, as "
    "planned or as learnt from where people walk; null: not known.",
    "reach": "Border of where a wearer who is not received can have walked to, as [east, north] "
    "in metres; empty: the ellipse is all that is known.",
    # ---- the rest
    "due_ms": "When the next PAR is due.",
    "rest_due_ms": "When work has lasted long enough; null: nobody works.",
    "ahead_ms": "The unit's own UTC less the station's.",
    "ClockView.std_ms": "Standard deviation of that.",
    "marker_id": "Its id in the other system.",
    "remarks": "Free text of the other team.",
    "radius_m": "Radius of the region in which it is; null: not known.",
    "stale_ms": "From then on the place is old.",
    "UnitView.incident_id": "The incident in which the unit and its wearer are; it may be closed "
    "since; empty: unassigned; null: in a recording of an earlier version.",
    "Snapshot.incidents": "All that are open, and closed ones until the next is opened on their "
    "site, in the order of opening.",
    "Snapshot.sites": "Grounds beside the one of the incident that is shown.",
    "SiteView.plan": "The plan of that ground as GeoJSON; null: there is none.",
    "SiteView.anchor": "Where it lies on the Earth; null: nobody has said.",
    "SiteView.plan_placed": "Whether it is known where on the plan people are.",
}
