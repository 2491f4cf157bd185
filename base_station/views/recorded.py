"""Console messages as the log stores them: those of ``wire``, with references in place of names,
and with the points that were added to trails.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import msgspec

from base_station.core.person_references import reference_to
from base_station.storage.db.known_people import KnownPerson, PersonLookup, shown_text
from base_station.views.alarm_parameters import named_parameters
from base_station.views.wire import (
    AlarmView,
    BeaconView,
    CommandView,
    Delta,
    DispatchView,
    IncidentView,
    PersonView,
    PinView,
    Snapshot,
    TrailPoint,
    UnitView,
)


class RecordedDelta(Delta, frozen=True, tag="delta", omit_defaults=True):
    points: Mapping[str, tuple[TrailPoint, ...]] = {}  # by unit, behind earlier points


class _EncodedSnapshot(Snapshot, frozen=True, tag="snapshot"):
    plan: msgspec.Raw  # null, where there is none: msgspec reads no optional raw value


_SNAPSHOTS: Final = msgspec.json.Decoder(_EncodedSnapshot)


def read_snapshot(encoded: bytes) -> Snapshot:
    """Decode a snapshot.  Raises msgspec.MsgspecError."""
    values = msgspec.structs.asdict(_SNAPSHOTS.decode(encoded))
    plan = bytes(values.pop("plan"))
    return Snapshot(**values, plan=None if plan == b"null" else msgspec.Raw(plan))


def reference_person(person_id: str) -> KnownPerson:
    """``PersonLookup`` for recording, which gives the reference as the name: the log has no
    names.
    """
    return KnownPerson(reference_to(person_id))


def named_unit(unit: UnitView, people: PersonLookup) -> UnitView:
    person = None if unit.person is None else _named_person(unit.person, people)
    label = shown_text(unit.label, people)
    return msgspec.structs.replace(unit, person=person, label=label)


def _named_person(person: PersonView, people: PersonLookup) -> PersonView:
    """Person with the present name; a log of an earlier version has the name of its time, which
    stays.
    """
    known = people(person.person_id)
    if person.name != reference_to(person.person_id):
        return msgspec.structs.replace(person, photo_url=known.photo_url)
    return PersonView(person.person_id, known.name, known.crew, known.role, known.photo_url)


def named_alarm(alarm: AlarmView, people: PersonLookup) -> AlarmView:
    texts = {name: shown_text(getattr(alarm, name), people) for name in ("text", "by", "note")}
    parameters = named_parameters(alarm.parameters, people)
    return msgspec.structs.replace(alarm, **texts, parameters=parameters)


def named_command(command: CommandView, people: PersonLookup) -> CommandView:
    units = tuple(
        msgspec.structs.replace(one, acknowledged_by=shown_text(one.acknowledged_by, people))
        for one in command.units
    )
    text = shown_text(command.text, people)
    return msgspec.structs.replace(command, text=text, units=units)


def named_incident(incident: IncidentView, people: PersonLookup) -> IncidentView:
    known = incident.dispatch
    dispatch = None if known is None else named_dispatch(known, people)
    name = shown_text(incident.name, people)
    return msgspec.structs.replace(incident, name=name, dispatch=dispatch)


def named_dispatch(dispatch: DispatchView, people: PersonLookup) -> DispatchView:
    return msgspec.structs.replace(dispatch, remarks=shown_text(dispatch.remarks, people))


def named_pin(pin: PinView, people: PersonLookup) -> PinView:
    code = pin.text_code
    if code is not None:
        texts = {name: shown_text(text, people) for name, text in code.texts.items()}
        code = msgspec.structs.replace(code, texts=texts)
    note, text = shown_text(pin.note, people), shown_text(pin.text, people)
    return msgspec.structs.replace(pin, note=note, text=text, text_code=code)


def named_beacon(beacon: BeaconView, people: PersonLookup) -> BeaconView:
    return msgspec.structs.replace(beacon, label=shown_text(beacon.label, people))
