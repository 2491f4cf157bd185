"""Descriptions of fields about reports and alerts of the dispatch centre."""

from __future__ import annotations

from collections.abc import Mapping

FIELDS: Mapping[str, str] = {
    "dispatch_number": "Number of the dispatch from which the incident was opened; empty: none.",
    "NewIncident.dispatch_number": "Number of the dispatch from which it is opened; empty: none. "
    "The dispatch is offered no longer, and its later reports go with the incident.",
    "number": "The dispatch centre's number of the incident.",
    "outcome": "What came of it: offered (it is new), opened (as an incident, as the settings have "
    "it), updated, unchanged (the same was known), or outdated (something newer was known).",
    "AlertReceipt.outcome": "What came of it: shown, cancelled, expired, replaced (by one that "
    "came before), not actual (an exercise, a test, or no alert at all), or without a place.",
    "DispatchReceipt.incident_id": "The open incident of this dispatch; null: none.",
    "DispatchReceipt.units": "The call signs of the report, and what the station knows by them.",
    "warnings": "Parts of the report that were left out, and why.",
    "warning_codes": "Codes of warnings, in their order, for texts in other languages.",
    "dispatch": "The newest report.",
    "call_signs": "The call signs of the report, and what the station knows by them.",
    "call_sign": "As the dispatch centre has it.",
    "words": "The call sign in words, where its letters are known.",
    "CallSignAnswer.crew": "The crew of that name; empty: none.",
    "CallSignAnswer.unit_ids": "Wearables whose id or label is that name.",
    "alert_id": "Sender and identifier of the alert.",
    "AlertReceipt.markers": "How many markers the alert has on the plan.",
    "replaced": "Alerts that this one updates or cancels, by sender and identifier.",
    "DispatchView.source": "The format in which it came: eido or json.",
    "DispatchView.type": "Kind of the incident, in words.",
    "type_code": "Kind of the incident, as the dispatch centre has it.",
    "DispatchView.priority": "As the dispatch centre has it.",
    "address": "Address of the incident.",
    "DispatchView.lat_deg": "Latitude of the incident (WGS-84); null: not known.",
    "DispatchView.lon_deg": "Longitude of the incident (WGS-84); null: not known.",
    "DispatchView.units": "Call signs of the vehicles or crews that were sent.",
    "called_ms": "When the call came in; null: not known.",
    "dispatched_ms": "When the units were sent; null: not known.",
    "DispatchView.updated_ms": "When the dispatch centre changed it last; null: not known.",
    "DispatchView.remarks": "What else the dispatch centre has written.",
    "has_ended": "Whether the dispatch centre has closed or cancelled it.",
    "DispatchView.received_ms": "When the station got the first report; null: it has opened an "
    "incident.",
    "is_dismissed": "Whether a person has dismissed it.",
}
