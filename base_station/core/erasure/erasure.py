"""Erasure of people: the units that they wore, with times, and their names.

Found in the log alone, which knows it even where the database was lost.  Pure.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping
from types import MappingProxyType

import msgspec

from base_station.core.events import Received, event_of
from shared.channels import tracked_unit
from shared.errors import UserError
from shared.messages import Header, OperatorAction
from shared.messages.station import (
    Assign,
    CloseIncident,
    DoneApart,
    ForgetWearers,
    OpenIncident,
    Unassign,
)

FOREVER_NS = 2**63 - 1
Record = tuple[int, str, bytes]  # station time, key, payload
# What these say is where somebody was.
PLACE_ACTIONS = frozenset({"SetStart", "SetPin", "StartTogether", "SetMeeting"})
TEXT_ACTIONS = frozenset({"SendCommand", "ResolveAlarm"})  # words to somebody, or about them


class Wearing(msgspec.Struct, frozen=True):
    """Time in which a unit's wearer is to be erased; station times, ``until_ns`` excluded."""

    unit_id: str
    from_ns: int
    until_ns: int


class Erasure(msgspec.Struct, frozen=True):
    """Erasure of one person, or of all people in one incident."""

    wearings: tuple[Wearing, ...]
    names: tuple[str, ...]  # longest first; none where the log is of this version
    person_id: str = ""  # empty: everybody in the incident
    incident_id: str = ""
    from_ns: int = 0  # when the names are to be forgotten
    until_ns: int = FOREVER_NS
    returned_units: tuple[str, ...] = ()  # when the incident is opened: every unit of it
    assigned_after: tuple[Assign, ...] = ()  # what was worn when it was closed
    opening_id: str = ""  # of the action that opened it
    closing_id: str = ""
    about_until_ns: int = FOREVER_NS  # alarms of its units: until the next incident is opened
    person_ids: frozenset[str] = frozenset()  # whose references go: of the people in the incident
    openings_ns: tuple[int, ...] = ()  # of all incidents, in order: trails begin anew with each

    @property
    def unit_ids(self) -> frozenset[str]:
        return frozenset(one.unit_id for one in self.wearings)

    def is_inserted(self, action_id: str) -> bool:
        """True for an action that an erasure put into the log (``inserted_action_id``)."""
        return action_id.startswith((f"{self.opening_id}-", f"{self.closing_id}-"))

    def without_inserted(self, records: Iterable[Record]) -> Erasure:
        """Erasure without the actions that a part of the log has already."""
        if not (self.returned_units or self.assigned_after):
            return self
        there = {action.action_id for _, action in actions_of(records)}
        return msgspec.structs.replace(
            self,
            returned_units=tuple(
                unit_id
                for unit_id in self.returned_units
                if inserted_action_id(self.opening_id, unit_id) not in there
            ),
            assigned_after=tuple(
                assign
                for assign in self.assigned_after
                if inserted_action_id(self.closing_id, assign.unit_id) not in there
            ),
        )

    def covers(self, unit_id: str, t_ns: int) -> bool:
        """True where messages of this unit at that time are to be erased."""
        return any(
            one.unit_id == unit_id and one.from_ns <= t_ns < one.until_ns for one in self.wearings
        )

    def is_shown(self, t_ns: int) -> bool:
        """True where a console may have shown where somebody was: with the trail that stays until
        the next incident is opened.
        """
        return any(
            one.from_ns <= t_ns < self._next_opening_ns(one.until_ns) for one in self.wearings
        )

    def _next_opening_ns(self, t_ns: int) -> int:
        return next((one for one in self.openings_ns if one >= t_ns), FOREVER_NS)

    def is_about(self, unit_id: str, raised_ns: int) -> bool:
        """True if an alarm may name who is to be forgotten: also where it was raised when an
        incident was over, of what a unit could not say before.
        """
        until_ns = self.about_until_ns if unit_id in self.unit_ids else self.until_ns
        return self.from_ns <= raised_ns < until_ns

    def is_about_alarm(self, alarm_id: str) -> bool:
        """The same of one whose id is all that is known (``core.alarms.alarm_manager``)."""
        _, unit_id, raised_ns = [*alarm_id.rsplit(":", 2), "", ""][:3]
        return raised_ns.isdecimal() and self.is_about(unit_id, int(raised_ns))

    def covers_alarm(self, alarm_id: str) -> bool:
        """True if an alarm is about who wore the unit then."""
        _, unit_id, raised_ns = [*alarm_id.rsplit(":", 2), "", ""][:3]
        return raised_ns.isdecimal() and self.covers(unit_id, int(raised_ns))

    def is_of(self, person_ids: Iterable[str]) -> bool:
        """True if anybody of these is to be forgotten."""
        return not {self.person_id, *self.person_ids}.isdisjoint({*person_ids} - {""})

    def covers_separate_action(self, t_ns: int, apart: DoneApart) -> bool:
        """True if what was done apart, and written down at ``t_ns``, says where somebody was, or
        wore something, who is to be forgotten.  Of which time a place is, is one of its numbers.
        """
        kind, *values = re.split(r"[\s,]+", apart.what)
        if kind == "Assign":
            if self.person_id:
                return self.person_id in values
            return self.from_ns <= apart.t_ns < self.until_ns
        if kind in TEXT_ACTIONS and (self.is_of(values) or any(map(self.covers_alarm, values))):
            return True
        times_ns = [t_ns, apart.t_ns, *(int(value) for value in values if value.isdecimal())]
        concerned = self.unit_ids & {*values} if kind in PLACE_ACTIONS | TEXT_ACTIONS else ()
        return any(self.covers(unit_id, one) for unit_id in concerned for one in times_ns)


def inserted_action_id(action_id: str, unit_id: str) -> str:
    """Id of an action inserted at the time of another."""
    return f"{action_id}-{unit_id}"


def erasure_of_person(
    records: Iterable[Record], person_id: str, names: Collection[str], until_ns: int
) -> Erasure:
    """``records``: the operators' actions of the whole log; ``names``: as the database has them,
    for a log of an earlier version.
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
        _longest_first(names),
        person_id=person_id,
        openings_ns=tuple(openings_ns),
    )


def erasure_of_incident(records: Iterable[Record], incident_id: str) -> Erasure:
    """``records``: the operators' actions of the whole log.  UserError where it is not there or
    still open.
    """
    worn: dict[str, Assign] = {}  # by unit
    returned_units: dict[str, str] = {}  # units, by the action
    units: set[str] = set()
    people: dict[str, str] = {}  # names by person id, or none
    opened_ns = closed_ns = None
    opening_id = closing_id = ""
    others: set[str] = set()  # incidents that are open
    actions = iter(actions_of(records))
    for t_ns, action in actions:
        done = action.action
        if isinstance(done, OpenIncident):
            others.add(done.incident_id)
        elif isinstance(done, CloseIncident):
            others.discard(done.incident_id)
        if opened_ns is not None and others - {incident_id}:
            raise UserError(
                f"the incident {incident_id} was open together with another one; "
                "erase the people of it one by one"
            )
        if isinstance(done, OpenIncident) and done.incident_id == incident_id:
            opened_ns, opening_id = t_ns, action.action_id
            before = {  # that it was forgotten: the log tells of its units no other way
                unit_id
                for action_id, unit_id in returned_units.items()
                if action_id == inserted_action_id(opening_id, unit_id)
            }
            units = before | set(worn)
            people = {one.person_id: one.person_name for one in worn.values()}
        elif isinstance(done, CloseIncident) and done.incident_id == incident_id:
            closed_ns, closing_id = t_ns, action.action_id
            break
        elif isinstance(done, Assign):
            for unit_id in [one for one in worn if worn[one].person_id == done.person_id]:
                del worn[unit_id]
            worn[done.unit_id] = done
            units.add(done.unit_id)
            people[done.person_id] = done.person_name
        elif isinstance(done, Unassign):
            worn.pop(done.unit_id, None)
            returned_units[action.action_id] = done.unit_id
    if opened_ns is None:
        raise UserError(f"the log knows no incident {incident_id}")
    if closed_ns is None:
        raise UserError(f"the incident {incident_id} is open; close it first")
    next_opening_ns = next(
        (t_ns for t_ns, later in actions if isinstance(later.action, OpenIncident)), FOREVER_NS
    )
    return Erasure(
        tuple(Wearing(unit_id, opened_ns, closed_ns) for unit_id in sorted(units)),
        _longest_first(people.values()),
        incident_id=incident_id,
        from_ns=opened_ns,
        until_ns=closed_ns,
        returned_units=tuple(sorted(units)),
        assigned_after=tuple(worn.values()),
        opening_id=opening_id,
        closing_id=closing_id,
        about_until_ns=next_opening_ns,
        person_ids=frozenset(people),
        openings_ns=(next_opening_ns,),
    )


def first_erased_ns(records: Iterable[Record], erasure: Erasure) -> dict[str, int]:
    """By unit, when a station that leads first forgot in memory who had worn it: that is in the
    logs of both stations.  ``records`` as above.
    """
    returned_units = {
        unit_id: max(one.until_ns for one in erasure.wearings if one.unit_id == unit_id)
        for unit_id in erasure.unit_ids
    }
    settled: dict[str, int] = {}
    for t_ns, action in actions_of(records):
        match action.action:
            case ForgetWearers(unit_id=unit_id) if t_ns >= returned_units.get(unit_id, FOREVER_NS):
                settled.setdefault(unit_id, t_ns)
    return settled


class CaptureClocks:
    """Capture times of messages by the station's clock.  The least delayed one bounds it; of a run
    of which nothing came live the unit itself, if it knew the station's time.
    """

    def __init__(self, first_erased_ns: Mapping[str, int] = MappingProxyType({})) -> None:
        """``first_erased_ns``: by unit, from when on no message tells more of a run that was heard
        before; so the other station, which forgets later, places every message as this one did.
        """
        self._offsets_ns: dict[tuple[str, int], int] = {}
        self._settled_ns = first_erased_ns
        self._settled: set[tuple[str, int]] = set()

    def note(self, t_ns: int, header: Header) -> None:
        run = header.unit_id, header.boot_id
        wearer = tracked_unit(header.unit_id) or header.unit_id
        if t_ns <= self._settled_ns.get(wearer, FOREVER_NS):
            self._settled.add(run)
        elif run in self._settled:
            return
        offset_ns = t_ns - header.t_mono_ns
        self._offsets_ns[run] = min(self._offsets_ns.get(run, offset_ns), offset_ns)

    def captured_ns(self, header: Header) -> int | None:
        """None where nobody can tell."""
        offset_ns = self._offsets_ns.get((header.unit_id, header.boot_id))
        if offset_ns is not None:
            return header.t_mono_ns + offset_ns
        return header.t_utc_ns if header.utc_std_s > 0.0 else None


def actions_of(records: Iterable[Record]) -> Iterable[tuple[int, OperatorAction]]:
    for record in records:
        event = event_of(*record)
        if isinstance(event, Received) and isinstance(event.message, OperatorAction):
            yield event.t_ns, event.message


def _longest_first(names: Iterable[str]) -> tuple[str, ...]:
    return tuple(sorted((one for one in names if one.strip()), key=lambda one: (-len(one), one)))
