"""Events for the department: transitions of alarms, and changes since the last reports.

An event's id follows from its content, so that both machines of two stations, and a station that
reports it again after a kill, give it the same id.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from hashlib import sha256

import msgspec

from base_station.department_wire import (
    AlarmEvent,
    EventBody,
    IncidentEvent,
    ParEvent,
    PersonEvent,
    pack,
)
from base_station.forwarders.department.outbox import NewEvent
from base_station.views.answer import to_ms
from base_station.views.wire import IncidentView, PersonView, UnitView
from shared.messages import AlarmChange

_DIGEST_CHARACTERS = 24
_INCIDENT, _PAR, _PERSON = "incident/", "par/", "person/"


class _Reported(msgspec.Struct, frozen=True, array_like=True):
    """Last report about a subject."""

    event_id: str
    body: bytes


@dataclass(slots=True)
class Differences:
    """Events, and what is reported with them."""

    events: list[NewEvent] = field(default_factory=list)
    reported: dict[str, bytes | None] = field(default_factory=dict)
    forgotten: list[str] = field(default_factory=list)  # people, by subject


def alarm_event(change: AlarmChange) -> NewEvent:
    t_ns, state = change.header.t_utc_ns, change.state.name.lower()
    body = AlarmEvent(
        alarm_id=change.alarm_id,
        rule=change.rule,
        unit_id=change.unit_id,
        priority=change.priority,
        state=state,
        level=change.level,
        text=change.text,
        by=change.by,
        raised_ms=to_ms(change.raised_ns),
        changed_ms=to_ms(t_ns),
        code=change.code,
        parameters=change.parameters,
    )
    subject = f"alarm/{change.alarm_id}"
    event_id = f"{subject}/{t_ns}/{state}/{change.level}"
    return NewEvent(event_id, subject, to_ms(t_ns), pack(body))


def differences(
    incidents: Iterable[IncidentView],
    units: Iterable[UnitView],
    reported: Mapping[str, bytes],
    is_forgotten: Callable[[str], bool],
    now_ms: int,
) -> Differences:
    """Changes since the state that was ``reported`` last, by subject."""
    found = Differences()
    shown = {f"{_INCIDENT}{one.incident_id}": _incident_event(one) for one in incidents}
    for subject, event in shown.items():
        _compare(found, subject, event, reported, now_ms)
    for subject in _subjects(reported, _INCIDENT):
        last = _last(reported, subject)
        event = msgspec.msgpack.decode(last.body, type=IncidentEvent)
        if subject not in shown and event.closed_ms is None:
            closed = msgspec.structs.replace(event, closed_ms=now_ms)
            _compare(found, subject, closed, reported, now_ms)
    for unit in units:
        if unit.person is not None and not is_forgotten(unit.person.person_id):
            subject = f"{_PERSON}{unit.person.person_id}"
            _compare(found, subject, _person_event(unit.person), reported, now_ms)
        if unit.person is not None and unit.duty is not None:
            _compare(found, f"{_PAR}{unit.unit_id}", _par_event(unit), reported, now_ms)
    for subject in _subjects(reported, _PERSON):
        if is_forgotten(subject.removeprefix(_PERSON)):
            _note_forgotten(found, subject, now_ms)
    return found


def forgotten_body(subject: str) -> bytes:
    """Body that replaces those of all events about an erased person."""
    return pack(PersonEvent(subject.removeprefix(_PERSON), "", "", ""))


def _compare(
    found: Differences, subject: str, body: EventBody, reported: Mapping[str, bytes], now_ms: int
) -> None:
    packed, before = pack(body), _last(reported, subject)
    if packed == before.body:
        return
    # A return to a former state is another event: the id follows from the one before, too.
    digest = sha256(before.event_id.encode() + packed).hexdigest()[:_DIGEST_CHARACTERS]
    event_id = f"{subject}/{digest}"
    found.events.append(NewEvent(event_id, subject, now_ms, packed))
    found.reported[subject] = msgspec.msgpack.encode(_Reported(event_id, packed))


def _note_forgotten(found: Differences, subject: str, now_ms: int) -> None:
    body = forgotten_body(subject)
    found.events.append(NewEvent(f"{subject}/forgotten", subject, now_ms, body))
    found.reported[subject] = None
    found.forgotten.append(subject)


def _last(reported: Mapping[str, bytes], subject: str) -> _Reported:
    last = reported.get(subject)
    return _Reported("", b"") if last is None else msgspec.msgpack.decode(last, type=_Reported)


def _incident_event(incident: IncidentView) -> IncidentEvent:
    return IncidentEvent(
        incident.incident_id, incident.name, incident.opened_ms, incident.closed_ms
    )


def _person_event(person: PersonView) -> PersonEvent:
    return PersonEvent(person.person_id, person.name, person.crew, person.role)


def _par_event(unit: UnitView) -> ParEvent:
    assert unit.person is not None
    assert unit.duty is not None
    return ParEvent(
        unit_id=unit.unit_id,
        person_id=unit.person.person_id,
        incident_id=unit.incident_id or "",
        confirmed=unit.duty.confirmed,
        confirmed_ms=unit.duty.checked_in_ms,
        requested_ms=unit.duty.asked_ms,
        due_ms=unit.duty.due_ms,
    )


def _subjects(reported: Mapping[str, bytes], kind: str) -> Iterator[str]:
    return (subject for subject in reported if subject.startswith(kind))
