"""Scan of a log for one incident: membership and wearers of its units, and the actions that the
erasure inserts so that units and people outside the incident replay as before.

Units join and leave incidents by the rules of the live state
(``base_station.core.people_actions``), which are applied here to the operators' actions alone.  In
the redacted log every unit is in the same incidents as before, without a wearer in the erased one:

- a unit is unassigned before it joins the incident, and assigned again after it leaves;
- an assignment by which a unit joins the incident is replaced by joining without a wearer;
- assignments within the incident are removed.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from contextlib import suppress
from types import MappingProxyType

from base_station.core.erasure.erasure import (
    FOREVER_NS,
    Elsewhere,
    Erasure,
    HandBack,
    OtherIncident,
    Reassignment,
    Record,
    Wearing,
    actions_of,
    inserted_action_id,
    is_inserted,
    longest_first,
)
from base_station.core.people_actions import PeopleAction, apply_people_action
from base_station.core.state import Person, StationState
from shared.coded_text import coded
from shared.errors import UserError
from shared.messages import OperatorAction
from shared.messages.station import Assign, AssignIncident, RegisterUnit, Unassign


def erasure_of_incident(
    records: Iterable[Record],
    incident_id: str,
    first_message_ns: Mapping[str, int] = MappingProxyType({}),
    *,
    is_whole: bool = True,
) -> Erasure:
    """Return the erasure of an incident.

    ``records``: the operators' actions of the whole log.  ``first_message_ns``: by unit, of units
    that sent messages before they were registered.  Where the log is not whole, the registration of
    a unit may be lost.  UserError where the incident is unknown or still open.
    """
    actions = list(actions_of(records))
    registered = {one.action.unit_id for _, one in actions if isinstance(one.action, RegisterUnit)}
    named = {unit_id for _, one in actions for unit_id in _units_of(one)}
    lost = frozenset[str]() if is_whole else named - registered
    scan = _IncidentScan(incident_id, lost, first_message_ns)
    for t_ns, action in actions:
        scan.take(t_ns, action)
        if scan.is_over:
            break
    return scan.erasure()


class _IncidentScan:
    def __init__(
        self, incident_id: str, lost: Collection[str], first_message_ns: Mapping[str, int]
    ) -> None:
        """``lost``: units whose registration is lost; they are registered by their first action."""
        self._incident_id = incident_id
        self._lost = lost
        self._first_message = sorted((t_ns, unit_id) for unit_id, t_ns in first_message_ns.items())
        self._state = StationState()
        self._opened_ns = self._closed_ns = self._gone_ns = FOREVER_NS
        self._opening_id = ""
        self._unassigned_ids: set[str] = set()  # of actions
        self._members_since: dict[str, int] = {}  # by unit
        self._away_since: dict[tuple[str, str], int] = {}  # by person and unit
        self._others_since: dict[str, int] = {}  # by incident
        self._units: set[str] = set()  # worn by people in the incident
        self._people: dict[str, str] = {}  # names by person id, or none
        self._wearers: set[tuple[str, str]] = set()  # unit and person
        self._windows: list[Wearing] = []
        self._elsewhere: list[Elsewhere] = []
        self._others: list[OtherIncident] = []
        self._hand_backs: list[HandBack] = []
        self._taken: list[HandBack] = []  # hand-backs of outside units by people who get one inside
        self._reassignments: list[Reassignment] = []
        self._entries: list[str] = []

    @property
    def is_over(self) -> bool:
        """True where no console shows the incident any more."""
        return self._gone_ns < FOREVER_NS

    def erasure(self) -> Erasure:
        """Raises UserError as ``erasure_of_incident``."""
        if self._opened_ns == FOREVER_NS:
            raise UserError(
                coded(
                    "erase-incident-unknown",
                    "the log knows no incident {incident}",
                    incident=self._incident_id,
                )
            )
        if self._closed_ns == FOREVER_NS:
            raise UserError(
                coded(
                    "erase-incident-open",
                    "the incident {incident} is open; close it first",
                    incident=self._incident_id,
                )
            )
        self._note_elsewhere({}, self._gone_ns)
        windows = [one for one in self._windows if one.unit_id in self._units]
        return Erasure(
            tuple(sorted(windows, key=lambda one: (one.unit_id, one.from_ns))),
            longest_first(self._people.values()),
            incident_id=self._incident_id,
            from_ns=self._opened_ns,
            until_ns=self._closed_ns,
            hand_backs=(
                *(one for one in self._hand_backs if one.unit_id in self._units),
                *self._taken,
            ),
            reassignments=tuple(self._reassignments),
            entries=tuple(self._entries),
            about_until_ns=self._gone_ns,
            person_ids=frozenset(self._people),
            wearers=tuple(sorted(self._wearers)),
            elsewhere=tuple(one for one in self._elsewhere if one.person_id in self._people),
            others=tuple(self._others),
            openings_ns=(self._gone_ns,),
        )

    def take(self, t_ns: int, done: OperatorAction) -> None:
        """Step one action of the log."""
        if isinstance(done.action, Unassign):
            self._unassigned_ids.add(done.action_id)
        self._note_first_message(t_ns)
        members, worn, known = self._members(), self._worn(), set(self._state.units)
        self._apply(t_ns, done)
        is_opening = self._note_open(t_ns, done)
        if self._opened_ns == FOREVER_NS:
            return
        now = self._members()
        for unit_id in sorted(now - members):
            is_alone = len(self._state.open_incidents) == 1
            is_new = is_opening or (unit_id not in known and is_alone)
            self._enter(unit_id, self._opened_ns if is_new else t_ns, done, is_new=is_new)
        for unit_id in sorted(members - now):
            self._leave(unit_id, t_ns, done)
        if isinstance(done.action, Assign):
            self._assigned(done.action_id, done.action, worn)
        for unit_id in now:
            self._note_wearer(unit_id)
        self._note_elsewhere(self._away(now), t_ns)
        self._note_others(t_ns)

    def _note_first_message(self, t_ns: int) -> None:
        """Add units that sent messages before they were registered: they join the open incident."""
        while self._first_message and self._first_message[0][0] <= t_ns:
            received_ns, unit_id = self._first_message.pop(0)
            if unit_id in self._state.units:
                continue
            self._state.add_unit(unit_id)
            if unit_id in self._members():
                self._members_since[unit_id] = received_ns
                self._hand_backs.append(HandBack(self._opening_id, unit_id))

    def _apply(self, t_ns: int, done: OperatorAction) -> None:
        action = done.action
        self._state.t_ns = t_ns
        for unit_id in _units_of(done):
            if unit_id in self._lost or isinstance(action, RegisterUnit):
                self._register(unit_id)
        if isinstance(action, PeopleAction):
            with suppress(UserError):  # the live station refused it, too
                list(apply_people_action(self._state, done.by, action))

    def _register(self, unit_id: str) -> None:
        known = self._state.units.get(unit_id)
        unit = self._state.add_unit(unit_id) if known is None else known
        unit.registered = True

    def _note_open(self, t_ns: int, done: OperatorAction) -> bool:
        """Note the times of opening, closing and last display; True: this action opens it."""
        incident = self._state.incidents.get(self._incident_id)
        if self._opened_ns == FOREVER_NS:
            if incident is None:
                return False
            self._opened_ns, self._opening_id = t_ns, done.action_id
            return True
        if self._closed_ns == FOREVER_NS and incident is not None and not incident.is_open:
            self._closed_ns = t_ns
        if incident is None:
            self._gone_ns = t_ns
        return False

    def _enter(self, unit_id: str, from_ns: int, done: OperatorAction, *, is_new: bool) -> None:
        """``is_new``: the unit was not known before the incident was opened."""
        self._members_since[unit_id] = from_ns
        base_id = self._opening_id if is_new else done.action_id
        hand_back = HandBack(base_id, unit_id)
        self._hand_backs.append(hand_back)
        if isinstance(done.action, Assign) and not is_new:
            self._entries.append(done.action_id)
        # Units of an earlier erasure: no other record of the log names them.
        of_opening = inserted_action_id(self._opening_id, unit_id)
        if not self._unassigned_ids.isdisjoint({hand_back.inserted_id, of_opening}):
            self._units.add(unit_id)

    def _leave(self, unit_id: str, t_ns: int, done: OperatorAction) -> None:
        self._windows.append(Wearing(unit_id, self._members_since.pop(unit_id), t_ns))
        person = self._state.units[unit_id].wearer.person
        if person is None or isinstance(done.action, Assign):
            return  # unworn, or the action itself names the person
        self._note_person(unit_id, person)
        is_closing = self._closed_ns == t_ns
        again = f"{done.action_id}-again"  # the next incident of the unit may be erased, too
        self._reassignments.append(
            Reassignment(
                done.action_id,
                Assign(unit_id, person.person_id, person.name, person.crew, person.role, True),
                inserted_action_id(done.action_id if is_closing else again, unit_id),
            )
        )

    def _assigned(self, action_id: str, assign: Assign, worn: Mapping[str, Person]) -> None:
        """Note units outside the incident whose wearer is assigned a unit inside it."""
        if assign.unit_id not in self._members_since:
            return
        for unit_id, person in worn.items():
            is_outside = unit_id != assign.unit_id and unit_id not in self._members_since
            if is_outside and person.person_id == assign.person_id:
                self._taken.append(HandBack(action_id, unit_id))

    def _note_wearer(self, unit_id: str) -> None:
        person = self._state.units[unit_id].wearer.person
        if person is not None:
            self._note_person(unit_id, person)

    def _note_person(self, unit_id: str, person: Person) -> None:
        self._units.add(unit_id)
        self._people[person.person_id] = person.name
        self._wearers.add((unit_id, person.person_id))

    def _note_elsewhere(self, away: Mapping[tuple[str, str], object], t_ns: int) -> None:
        for key in self._away_since.keys() - away.keys():
            self._elsewhere.append(Elsewhere(*key, self._away_since.pop(key), t_ns))
        for key in away:
            self._away_since.setdefault(key, t_ns)

    def _away(self, members: set[str]) -> dict[tuple[str, str], str]:
        """Wearers of units outside the incident, each with the unit; after its closing only those
        in another incident.
        """
        is_closed = self._closed_ns < FOREVER_NS
        return {
            (person.person_id, unit_id): unit_id
            for unit_id, person in self._worn().items()
            if unit_id not in members
            and not (is_closed and self._state.open_incident_of(self._state.units[unit_id]) is None)
        }

    def _note_others(self, t_ns: int) -> None:
        opened = {one.incident_id for one in self._state.open_incidents} - {self._incident_id}
        opened = set() if self._closed_ns < FOREVER_NS else opened
        for incident_id in sorted(self._others_since.keys() - opened):
            since_ns = self._others_since.pop(incident_id)
            self._others.append(OtherIncident(incident_id, since_ns, t_ns))
        for incident_id in opened:
            self._others_since.setdefault(incident_id, t_ns)

    def _members(self) -> set[str]:
        """Units in the incident, while it is open."""
        incident = self._state.incidents.get(self._incident_id)
        if incident is None or not incident.is_open:
            return set()
        units = self._state.units.values()
        return {one.unit_id for one in units if one.incident_id == self._incident_id}

    def _worn(self) -> dict[str, Person]:
        """Wearers by unit."""
        units = self._state.units.values()
        return {one.unit_id: one.wearer.person for one in units if one.wearer.person is not None}


def _units_of(done: OperatorAction) -> tuple[str, ...]:
    """Units that an action registers, assigns, or moves to an incident."""
    match done.action:
        case RegisterUnit(unit_id=unit_id) | Assign(unit_id=unit_id):
            return (unit_id,)
        case AssignIncident(unit_ids=unit_ids):
            return unit_ids
        case Unassign(unit_id=unit_id) if is_inserted(done):
            return (unit_id,)
        case _:
            return ()
