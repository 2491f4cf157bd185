"""Erasure of people: the units that they wore, with times, and their names.

Both are found in the log alone, because the database may be lost.  Pure.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable

import msgspec

from base_station.core.events import Received, event_of
from shared.messages import Header, OperatorAction
from shared.messages.station import (
    Assign,
    DoneApart,
    OpenIncident,
    Unassign,
)

FOREVER_NS = 2**63 - 1
_OWN_ID = re.compile(r"[0-9a-f]{16}-\d+")  # of an action without an id
Record = tuple[int, str, bytes]  # station time, key, payload
# Actions with places of people.
PLACE_ACTIONS = frozenset({"SetStart", "SetPin", "StartTogether", "SetMeeting"})
TEXT_ACTIONS = frozenset({"SendCommand", "ResolveAlarm"})  # texts to people, or about them


class Wearing(msgspec.Struct, frozen=True):
    """Time in which a unit's wearer is to be erased; station times, ``until_ns`` excluded."""

    unit_id: str
    from_ns: int
    until_ns: int


class Elsewhere(msgspec.Struct, frozen=True):
    """Time in which a person of an incident that is to be erased wore a unit outside it."""

    person_id: str
    unit_id: str
    from_ns: int
    until_ns: int  # excluded


class HandBack(msgspec.Struct, frozen=True):
    """Unassigning of a unit that stands in the log before another action."""

    action_id: str  # of that other action
    unit_id: str

    @property
    def inserted_id(self) -> str:
        return inserted_action_id(self.action_id, self.unit_id)


class Reassignment(msgspec.Struct, frozen=True):
    """Assignment of a unit to its wearer that stands in the log behind another action."""

    action_id: str  # of that other action
    assign: Assign
    inserted_id: str


class OtherIncident(msgspec.Struct, frozen=True):
    """Time in which another incident was open beside the one that is to be erased."""

    incident_id: str
    from_ns: int
    until_ns: int  # excluded


class Erasure(msgspec.Struct, frozen=True):
    """Erasure of one person, or of all people in one incident."""

    wearings: tuple[Wearing, ...]  # of an incident: when its units were in it
    names: tuple[str, ...]  # longest first; none where the log is of this version
    person_id: str = ""  # empty: everybody in the incident
    incident_id: str = ""
    from_ns: int = 0  # when the incident was open
    until_ns: int = FOREVER_NS
    hand_backs: tuple[HandBack, ...] = ()  # where units come into the incident
    reassignments: tuple[Reassignment, ...] = ()  # where they leave it
    entries: tuple[str, ...] = ()  # ids of assignments by which a unit comes into it
    about_until_ns: int = FOREVER_NS  # alarms of its units: until no console shows it any more
    person_ids: frozenset[str] = frozenset()  # people whose references are removed
    wearers: tuple[tuple[str, str], ...] = ()  # in the incident: unit and person
    elsewhere: tuple[Elsewhere, ...] = ()  # when such references stay
    others: tuple[OtherIncident, ...] = ()
    openings_ns: tuple[int, ...] = ()  # of all incidents, in order: trails begin anew with each

    @property
    def unit_ids(self) -> frozenset[str]:
        return frozenset(one.unit_id for one in self.wearings)

    def inserted_in(self, records: Iterable[Record]) -> frozenset[str]:
        """Ids of the inserted actions that a part of the log has already."""
        if not (self.hand_backs or self.reassignments):
            return frozenset()
        inserted_ids = {one.inserted_id for one in self.hand_backs}
        inserted_ids |= {one.inserted_id for one in self.reassignments}
        return frozenset(one.action_id for _, one in actions_of(records)) & inserted_ids

    def covers(self, unit_id: str, t_ns: int) -> bool:
        """True where messages of this unit at that time are to be erased."""
        return any(
            one.unit_id == unit_id and one.from_ns <= t_ns < one.until_ns for one in self.wearings
        )

    def may_cover(self, unit_id: str, t_ns: int) -> bool:
        """True where a message of this unit that was captured at an unknown time, and logged at
        ``t_ns``, may have to be erased.
        """
        return any(one.unit_id == unit_id and one.from_ns <= t_ns for one in self.wearings)

    def is_shown(self, t_ns: int) -> bool:
        """True where a console may have shown the position of an erased person: trails stay until
        the next incident is opened.
        """
        return any(
            one.from_ns <= t_ns < self._next_opening_ns(one.until_ns) for one in self.wearings
        )

    def _next_opening_ns(self, t_ns: int) -> int:
        return next((one for one in self.openings_ns if one >= t_ns), FOREVER_NS)

    def people_at(self, t_ns: int) -> frozenset[str]:
        """People whose references are removed from records of that time: all in the incident while
        it is open, except those who are outside it then.
        """
        if not self.from_ns <= t_ns < self.until_ns:
            return frozenset()
        return self.person_ids - {one.person_id for one in self._elsewhere_at(t_ns)}

    def people_in_alarm(self, unit_id: str, raised_ns: int) -> frozenset[str]:
        """People whose references are removed from an alarm.  A unit may report late, when it has
        left the incident: the alarm is then about its wearer in the incident.
        """
        if not self.is_about(unit_id, raised_ns):
            return frozenset()
        elsewhere = list(self._elsewhere_at(raised_ns))
        wear_it = {one.person_id for one in elsewhere if one.unit_id == unit_id}
        wore_it = {person_id for worn, person_id in self.wearers if worn == unit_id}
        here = self.person_ids - {one.person_id for one in elsewhere}
        return here | (wore_it - wear_it)

    def _elsewhere_at(self, t_ns: int) -> Iterable[Elsewhere]:
        return (one for one in self.elsewhere if one.from_ns <= t_ns < one.until_ns)

    def times_alone(self, erased_ids: Collection[str]) -> list[tuple[int, int]]:
        """Times, begin and end, in which no other incident was open; incidents of ``erased_ids`` do
        not count.
        """
        times_ns, from_ns = list[tuple[int, int]](), self.from_ns
        for one in sorted(self.others, key=lambda other: other.from_ns):
            if one.incident_id in erased_ids:
                continue
            times_ns.append((from_ns, one.from_ns))
            from_ns = max(from_ns, one.until_ns)
        times_ns.append((from_ns, self.until_ns))
        return [(begin_ns, end_ns) for begin_ns, end_ns in times_ns if begin_ns < end_ns]

    def is_about(self, unit_id: str, raised_ns: int) -> bool:
        """True if an alarm may name an erased person: also one that was raised after the incident,
        by a late report of a unit.
        """
        until_ns = self.about_until_ns if unit_id in self.unit_ids else self.until_ns
        return self.from_ns <= raised_ns < until_ns

    def covers_alarm(self, alarm_id: str) -> bool:
        """True if an alarm is about an erased wearer of the unit."""
        raised = raised_of(alarm_id)
        return raised is not None and self.covers(*raised)

    def is_of(self, person_ids: Iterable[str], t_ns: int) -> bool:
        """True if one of these people is erased from records of that time."""
        return not {self.person_id, *self.people_at(t_ns)}.isdisjoint({*person_ids} - {""})

    def covers_separate_action(self, t_ns: int, apart: DoneApart) -> bool:
        """True if an action of a separated station, logged at ``t_ns``, has a place, a text or an
        assignment of an erased person.  The time of a place is one of the numbers in its text.
        """
        kind, *values = re.split(r"[\s,]+", apart.what)
        if kind == "Assign":
            if self.person_id:
                return self.person_id in values
            elsewhere = {one.person_id for one in self._elsewhere_at(apart.t_ns)}
            return self.from_ns <= apart.t_ns < self.until_ns and elsewhere.isdisjoint(values)
        times_ns = [t_ns, apart.t_ns, *(int(value) for value in values if value.isdecimal())]
        if kind in TEXT_ACTIONS and (
            self.is_of(values, apart.t_ns) or any(map(self.covers_alarm, values))
        ):
            return True
        concerned = self.unit_ids & {*values} if kind in PLACE_ACTIONS | TEXT_ACTIONS else ()
        return any(self.covers(unit_id, one) for unit_id in concerned for one in times_ns)


def raised_of(alarm_id: str) -> tuple[str, int] | None:
    """Unit of an alarm and time when it was raised, both read from its id
    (``core.alarms.alarm_manager``); None: another program made the id.
    """
    _, unit_id, raised_ns = [*alarm_id.rsplit(":", 2), "", ""][:3]
    return (unit_id, int(raised_ns)) if raised_ns.isdecimal() else None


def inserted_action_id(action_id: str, unit_id: str) -> str:
    """Id of an action inserted at the time of another."""
    return f"{action_id}-{unit_id}"


def is_inserted(done: OperatorAction) -> bool:
    """True for an action that an erasure has put into the log."""
    action = done.action
    if not isinstance(action, Assign | Unassign) or _OWN_ID.fullmatch(done.action_id):
        return False
    return done.action_id.endswith(inserted_action_id("", action.unit_id))


def erasure_of_person(
    records: Iterable[Record], person_id: str, names: Collection[str], until_ns: int
) -> Erasure:
    """Return the erasure of a person.

    ``records``: the operators' actions of the whole log.  ``names``: from the database, for a log
    of an earlier version.
    """
    names = {*names}
    since: dict[str, int] = {}  # by unit, while the person wears it
    wearings: list[Wearing] = []
    openings_ns: list[int] = []

    def hand_back(unit_id: str, t_ns: int) -> None:
        if unit_id in since:
            wearings.append(Wearing(unit_id, since.pop(unit_id), t_ns))

    for t_ns, action in actions_of(records):
        if isinstance(action.action, Assign):
            assign = action.action
            mine = assign.person_id == person_id
            for unit_id in list(since):
                if (unit_id == assign.unit_id) != mine:  # worn by another, or changed for another
                    hand_back(unit_id, t_ns)
            if mine:
                names.add(assign.person_name)
                since.setdefault(assign.unit_id, t_ns)
        elif isinstance(action.action, Unassign):
            hand_back(action.action.unit_id, t_ns)
        elif isinstance(action.action, OpenIncident):
            openings_ns.append(t_ns)
    for unit_id in list(since):
        hand_back(unit_id, until_ns)
    return Erasure(
        tuple(wearings),
        longest_first(names),
        person_id=person_id,
        openings_ns=tuple(openings_ns),
    )


class CaptureClocks:
    """Capture times of messages by the station's clock.

    The live message with the least delay gives the clock offset of a unit's run.  A run without
    live messages has the unit's own UTC, if the unit knew it.

    The time of a record depends only on the records before it in the log.  So two stations compute
    the same time, though one of them has later records that the other never receives.
    """

    def __init__(self) -> None:
        self._offsets_ns: dict[tuple[str, int], int] = {}

    def note(self, t_ns: int, header: Header) -> None:
        """Note a live message, in the order of the log.  An erased message has left a heartbeat
        with the same header, so a repeated erasure computes the same times.
        """
        run = header.unit_id, header.boot_id
        offset_ns = t_ns - header.t_mono_ns
        self._offsets_ns[run] = min(self._offsets_ns.get(run, offset_ns), offset_ns)

    def captured_ns(self, t_ns: int, header: Header) -> int | None:
        """Capture time, at most ``t_ns``, of a message that was logged then; None: unknown."""
        offset_ns = self._offsets_ns.get((header.unit_id, header.boot_id))
        if offset_ns is not None:
            return min(header.t_mono_ns + offset_ns, t_ns)
        return min(header.t_utc_ns, t_ns) if header.utc_std_s > 0.0 else None


def actions_of(records: Iterable[Record]) -> Iterable[tuple[int, OperatorAction]]:
    for record in records:
        event = event_of(*record)
        if isinstance(event, Received) and isinstance(event.message, OperatorAction):
            yield event.t_ns, event.message


def longest_first(names: Iterable[str]) -> tuple[str, ...]:
    """Return the names, the longest first; blank ones are left out."""
    return tuple(sorted((one for one in names if one.strip()), key=lambda one: (-len(one), one)))
