"""An event of a station as a sentence for a person."""

from __future__ import annotations

import msgspec

from base_station.department_wire import AlarmEvent, ParEvent, unpack_body
from base_station.storage.db.department_models import ReportedEvent
from base_station.storage.db.known_people import PersonLookup, shown_text

_PAR_TEXTS = {
    "self": "confirmed by the member's own unit",
    "radio": "confirmed by radio",
    "not_yet": "not confirmed",
}
_WITHOUT_BODY = {
    "incident": "an incident was opened, renamed or closed",
    "person": "a name was given, changed or forgotten",
    "": "a newer Muster reports something that this one does not know: update it",
}


def event_text(row: ReportedEvent, people: PersonLookup) -> str:
    if row.kind in _WITHOUT_BODY:
        return _WITHOUT_BODY[row.kind]
    body = unpack_body(msgspec.Raw(row.body))
    match body:
        case AlarmEvent():
            who = f" by {shown_text(body.by, people)}" if body.by else ""
            return f"{body.unit_id} {body.rule} {body.state}{who}: {shown_text(body.text, people)}"
        case ParEvent():
            requested = ", requested" if body.requested_ms is not None else ""
            name = people(body.person_id).name
            return f"{body.unit_id} {name}: PAR {_PAR_TEXTS.get(body.confirmed, '')}{requested}"
        case _:
            return ""
