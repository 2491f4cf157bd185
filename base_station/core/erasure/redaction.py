"""Redaction of a log, record by record: removes the data of an erased person or incident.  Pure.

A unit's message from a time that is erased becomes a heartbeat with the same header and nothing
else: the message does not count as missing, so no station fetches it from the unit's journal again.
Texts to and about an erased person become ``(forgotten)``; they are found by their field.  Names
are in logs of earlier versions only (``names_in_older_logs``).
"""

from __future__ import annotations

from collections.abc import Callable, Collection

import msgspec
from google.protobuf.message import Message as WireMessage

from base_station.core.erasure.erasure import CaptureClocks, Erasure, Record, raised_of
from base_station.core.erasure.names_in_older_logs import OlderNames, is_program_text
from base_station.core.events import Received, Rejected, event_of
from base_station.core.person_references import reference_to, without_people
from base_station.core.state import ERASED_TEXT
from shared.channels import (
    DESCRIPTION,
    HEARTBEAT,
    OPERATOR,
    Direction,
    backfilled_key,
    is_backfilled,
    parse_key,
    parse_unread_key,
    tracked_unit,
)
from shared.codec import encode
from shared.errors import UnknownChannelError
from shared.mcap_log.schemas import is_console, is_derived, wire_type_of
from shared.messages import (
    STATION_ID,
    AlarmChange,
    FusedPosition,
    Header,
    Heartbeat,
    OperatorAction,
)
from shared.messages.alarm import NO_PARAMETERS
from shared.messages.pins import SetMeeting, SetPin, StartTogether
from shared.messages.station import (
    Action,
    Assign,
    AssignIncident,
    CheckIn,
    DoneApart,
    ImportFile,
    RemoveImport,
    ResolveAlarm,
    SendCommand,
    SetStart,
    Unassign,
)


class Redactor:
    """Call it with every record of the log, in order; it returns the records that replace it."""

    def __init__(
        self,
        erasure: Erasure,
        clocks: CaptureClocks,
        inserted_ids: frozenset[str] = frozenset(),
    ) -> None:
        """``clocks``: of the records before.  ``inserted_ids``: ids of the actions that the erasure
        inserts and that this part of the log has already.
        """
        self._erasure = erasure
        self._clocks = clocks
        self._inserted_ids = inserted_ids
        self._unit_ids = erasure.unit_ids
        self._older = OlderNames(erasure.names)
        self._references = [reference_to(one).encode() for one in erasure.person_ids]

    def __call__(self, record: Record) -> list[Record]:
        t_ns, key, payload = record
        if is_derived(key):
            return self._derived(record)
        if self._is_of_others(key) and not self._mentions(payload):
            return [record]
        event = event_of(t_ns, key, payload)
        if not isinstance(event, Received):
            return self._unread(record, event)
        return self._received(record, event)

    def _unread(self, record: Record, event: Rejected) -> list[Record]:
        """Redact a record that cannot be read.  Where it may be from an erased time, a heartbeat
        replaces it, so that it is not fetched again.  The capture time of a record from a journal
        is unknown.
        """
        t_ns, key, payload = record
        if event.number is None:
            return [] if self._mentions(payload) else [record]
        sender, boot_id, seq = event.number
        wearer = tracked_unit(sender) or sender
        came_late = is_backfilled(key) or parse_unread_key(key) is not None
        at_any_time = came_late and self._erasure.may_cover(wearer, t_ns)
        if not (at_any_time or self._erasure.covers(wearer, t_ns) or self._mentions(payload)):
            return [record]
        alive = Heartbeat(Header(sender, boot_id, seq, 0), 0, 0)
        return [(t_ns, backfilled_key(sender, HEARTBEAT.suffix), encode(alive))]

    def _received(self, record: Record, event: Received) -> list[Record]:
        match event.message:
            case OperatorAction() as action:
                return [self._acted(one, action) for one in self._actions(record, action)]
            case FusedPosition() as fused:
                gone = self._erasure.covers(fused.unit_id, fused.t_meas_ns)
                return [] if gone else [record]
            case AlarmChange() as change:
                return [self._alarm(record, change)]
            case _ if parse_key(record[1])[1].direction is Direction.UP:
                return [self._unit(record, event)]
            case _:
                return [self._renamed(record)]

    def _is_of_others(self, key: str) -> bool:
        """True if it comes from a unit that no erased person wore."""
        try:
            unit_id, channel = parse_key(key)
        except UnknownChannelError:
            return False
        wearer = tracked_unit(unit_id) or unit_id
        return channel.direction is Direction.UP and wearer not in self._unit_ids

    def _unit(self, record: Record, event: Received) -> Record:
        """Return a unit's message, or the heartbeat that replaces it where it is from an erased
        time, or comes from a journal and may be from one.
        """
        t_ns, key, _ = record
        sender, channel = parse_key(key)
        header = event.message.header
        times_ns: list[int] = []
        if not event.backfilled:
            self._clocks.note(t_ns, header)
            times_ns.append(t_ns)
        captured_ns = self._clocks.captured_ns(t_ns, header)
        if captured_ns is not None:
            times_ns.append(captured_ns)
        wearer = tracked_unit(sender) or sender
        at_any_time = not times_ns and self._erasure.may_cover(wearer, t_ns)
        covered = at_any_time or any(self._erasure.covers(wearer, one) for one in times_ns)
        if channel in (DESCRIPTION, HEARTBEAT) or not covered:
            return self._renamed(record)
        alive = HEARTBEAT.key(sender)
        if event.backfilled:
            alive = backfilled_key(sender, HEARTBEAT.suffix)
        return t_ns, alive, encode(Heartbeat(header, 0, 0))

    def _acted(self, record: Record, message: OperatorAction) -> Record:
        """Replace the names in an action; in one about an alarm also those of the alarm."""
        action = message.action
        raised = raised_of(action.alarm_id) if isinstance(action, ResolveAlarm) else None
        if raised is None or not self._erasure.is_about(*raised):
            return self._renamed(record)
        people = self._erasure.people_at(record[0]) | self._erasure.people_in_alarm(*raised)
        return self._renamed(record, people)

    def _alarm(self, record: Record, change: AlarmChange) -> Record:
        t_ns, key, _ = record
        raised = change.unit_id, change.raised_ns
        if not self._erasure.covers(*raised):
            is_about = self._erasure.is_about(*raised)
            return self._renamed(
                record, self._erasure.people_in_alarm(*raised) if is_about else None
            )
        by = self._without_names(without_note(change.by), self._erasure.person_ids)
        note = ERASED_TEXT if change.note else ""
        erased = msgspec.structs.replace(
            change, text=ERASED_TEXT, by=by, code="", parameters=NO_PARAMETERS, note=note
        )
        return t_ns, key, encode(erased)

    def _derived(self, record: Record) -> list[Record]:
        """Redact a record that is computed from others.  One of the console's picture is removed
        whole: a replay computes it again from the records that are left.
        """
        t_ns, key, payload = record
        if is_console(key):
            return [] if self._erasure.is_shown(t_ns) or self._mentions(payload) else [record]
        if self._erasure.covers(key.split("/")[1], t_ns):
            return []
        return [self._renamed(record)]

    def _actions(self, record: Record, message: OperatorAction) -> list[Record]:
        t_ns, key, _ = record
        instead = self._in_incident(t_ns, message) if self._erasure.incident_id else [message]
        records = []
        for one in instead:
            kept = self._without_places(t_ns, self._without_texts(t_ns, one))
            if kept is message:
                records.append(record)
            elif kept is not None:
                records.append((t_ns, key, encode(kept)))
        return records

    def _in_incident(self, t_ns: int, message: OperatorAction) -> list[OperatorAction]:
        """Remove the wearers of units in the incident; outside it they stay."""
        before = [
            msgspec.structs.replace(
                message, action_id=one.inserted_id, action=Unassign(one.unit_id)
            )
            for one in self._erasure.hand_backs
            if one.action_id == message.action_id and one.inserted_id not in self._inserted_ids
        ]
        behind = [
            msgspec.structs.replace(message, action_id=one.inserted_id, action=one.assign)
            for one in self._erasure.reassignments
            if one.action_id == message.action_id and one.inserted_id not in self._inserted_ids
        ]
        return [*before, *self._left_in_incident(t_ns, message), *behind]

    def _left_in_incident(self, t_ns: int, message: OperatorAction) -> list[OperatorAction]:
        erasure = self._erasure
        match message.action:
            case (
                ImportFile(incident_id=erasure.incident_id)
                | RemoveImport(incident_id=erasure.incident_id)
            ):
                return []  # the files go, too
            case Assign(unit_id=unit_id) if message.action_id in erasure.entries:
                comes = AssignIncident(erasure.incident_id, (unit_id,))
                return [msgspec.structs.replace(message, action=comes)]
            case Assign(unit_id=unit_id) | Unassign(unit_id=unit_id) if (
                erasure.covers(unit_id, t_ns) and message.action_id not in self._inserted_ids
            ):
                return []
            case _:
                return [message]

    def _without_texts(self, t_ns: int, message: OperatorAction) -> OperatorAction:
        kept = without_texts(t_ns, message.action, self._erasure)
        return message if kept is message.action else msgspec.structs.replace(message, action=kept)

    def _without_places(self, t_ns: int, message: OperatorAction) -> OperatorAction | None:
        """Remove the places of erased people; None where nothing else is in the action."""
        action, covers = message.action, self._erasure.covers
        match action:
            case SetStart(unit_id=unit_id):
                return None if covers(unit_id, t_ns) else message
            case SetPin(unit_id=unit_id) | SetMeeting(unit_id=unit_id):
                other = action.other_unit_id if isinstance(action, SetMeeting) else unit_id
                at_ns = action.t_ns or t_ns
                gone = any(covers(one, at) for one in (unit_id, other) for at in (t_ns, at_ns))
                return None if gone else message
            case StartTogether(unit_ids=unit_ids):
                at_ns = action.t_ns or t_ns
                kept = tuple(
                    one for one in unit_ids if not any(covers(one, at) for at in (t_ns, at_ns))
                )
                if kept == unit_ids:
                    return message
                fewer = msgspec.structs.replace(action, unit_ids=kept)
                return msgspec.structs.replace(message, action=fewer) if kept else None
            case DoneApart(what=what):
                left = remaining_text(action, t_ns, self._erasure, self._older)
                untold = msgspec.structs.replace(action, what=left)
                return message if left == what else msgspec.structs.replace(message, action=untold)
            case _:
                return message

    def _renamed(self, record: Record, people: Collection[str] | None = None) -> Record:
        """Replace every name, and every reference to ``people``, in all texts; the author of an
        action stays.  ``people`` is None: those who are erased at the record's time.
        """
        t_ns, key, payload = record
        if people is None:
            if not self._erasure.from_ns <= t_ns < self._erasure.until_ns:
                return record
            people = self._erasure.people_at(t_ns)
        if not self._mentions(payload):
            return record
        wire_type = wire_type_of(key)
        assert wire_type is not None  # it could be read
        wire = wire_type.FromString(payload)
        by = wire.by if key == OPERATOR.key(STATION_ID) else None
        _change_texts(wire, lambda text: self._without_names(text, people))
        if by is not None:
            wire.by = by
        return t_ns, key, wire.SerializeToString()

    def _mentions(self, payload: bytes) -> bool:
        """True if the bytes may mention an erased person."""
        known = any(reference in payload for reference in self._references)
        return known or self._older.may_be_in(payload)

    def _without_names(self, text: str, people: Collection[str]) -> str:
        return without_people(self._older.erased(text), people, ERASED_TEXT)


def without_texts(t_ns: int, action: Action, erasure: Erasure) -> Action:
    """Return the action without texts to or about erased people, and without their references as
    recipients in the incident; the same object where nothing changes.
    """
    match action:
        case Assign(person_id=erasure.person_id, person_name=name) if name:
            return msgspec.structs.replace(action, person_name=ERASED_TEXT, crew="", role="")
        case SendCommand() if erasure.covers(action.unit_id, t_ns) or erasure.is_of(
            action.person_ids, t_ns
        ):
            return _order_without(action, t_ns, erasure)
        case CheckIn(person_ids=people) if erasure.incident_id and erasure.is_of(people, t_ns):
            people = _people_kept(people, t_ns, erasure)
            of = action.incident_id if people else erasure.incident_id
            return msgspec.structs.replace(action, person_ids=people, incident_id=of)
        case ResolveAlarm(alarm_id=alarm_id, note=note) if note and erasure.covers_alarm(alarm_id):
            return msgspec.structs.replace(action, note=ERASED_TEXT)
        case _:
            return action


def _order_without(order: SendCommand, t_ns: int, erasure: Erasure) -> SendCommand:
    """Erase texts of orders, except of one to others, too."""
    text = ERASED_TEXT if order.text else ""
    if not erasure.incident_id:
        return msgspec.structs.replace(order, text=text)
    people = _people_kept(order.person_ids, t_ns, erasure)
    if people:
        return msgspec.structs.replace(order, person_ids=people)
    of = order.incident_id or erasure.incident_id  # no other record holds it any more
    return msgspec.structs.replace(order, text=text, person_ids=(), incident_id=of)


def _people_kept(person_ids: tuple[str, ...], t_ns: int, erasure: Erasure) -> tuple[str, ...]:
    """People who are not erased, or are outside the incident at that time."""
    gone = erasure.people_at(t_ns)
    return tuple(one for one in person_ids if one not in gone)


def without_note(by: str) -> str:
    """Name of the person who resolved an alarm, without the note that follows it in older logs."""
    resolver, noted, _ = by.partition(": ")
    return f"{resolver}{noted}{ERASED_TEXT}" if noted else by


def remaining_text(apart: DoneApart, t_ns: int, erasure: Erasure, names: OlderNames) -> str:
    """Text of an action of a separated station, logged at ``t_ns``, without erased data."""
    if erasure.covers_separate_action(t_ns, apart):
        return ERASED_TEXT
    times_ns = (t_ns, apart.t_ns)
    if not any(erasure.from_ns <= one < erasure.until_ns for one in times_ns):
        return apart.what
    people = erasure.people_at(t_ns) | erasure.people_at(apart.t_ns)
    return without_people(names.erased(apart.what), people, ERASED_TEXT)


def _change_texts(wire: WireMessage, change: Callable[[str], str]) -> None:
    """Change every text of a message and its parts, except those that the program reads."""
    for field, value in wire.ListFields():
        if is_program_text(field.name):
            continue
        if field.message_type is not None:
            for part in value if field.is_repeated else [value]:
                _change_texts(part, change)
        elif field.type == field.TYPE_STRING and field.is_repeated:
            value[:] = [change(one) for one in value]
        elif field.type == field.TYPE_STRING:
            setattr(wire, field.name, change(value))
