"""Members of an open incident: the crews and people that work in it, and in no other."""

from __future__ import annotations

from fastapi import APIRouter

from base_station.api.authentication import Viewer
from base_station.api.forms import Form, Id, UnitId
from base_station.api.idempotent_request import Perform
from base_station.api.problems import Problem
from base_station.api.request_incident import open_or_404
from base_station.api.routes.commands import EveryoneTarget, Target, UnitTarget, members_of
from base_station.api.services import Services, Station
from base_station.views.answer import Answer
from base_station.views.wire import UnitView
from shared.coded_text import coded
from shared.messages.station import AssignIncident

router = APIRouter(tags=["incidents"])


class Member(Answer, frozen=True):
    """A unit in an incident, with its wearer."""

    unit_id: str
    person_id: str | None  # None: it is not worn
    name: str
    crew: str


class NewMembers(Form):
    target: Target


@router.get("/incidents/{incident_id}/members")
def list_members(incident_id: Id, station: Station, _: Viewer) -> list[Member]:
    """Members of an open incident now: people first, by crew and name."""
    open_or_404(station, incident_id)
    return _members(station, incident_id)


@router.get("/unassigned")
def list_unassigned(station: Station, _: Viewer) -> list[Member]:
    """Registered units that are in no open incident."""
    return _members(station, "")


@router.post("/incidents/{incident_id}/members")
def assign_members(
    incident_id: Id, new: NewMembers, station: Station, perform: Perform
) -> list[Member]:
    """Assign units and their wearers to this incident, and to no other.  Their PAR is then to be
    confirmed here.  If the incident has a site of its own, their paths begin there.
    """
    open_or_404(station, incident_id)
    perform(AssignIncident(incident_id, _units_of(new.target, station)))
    return _members(station, incident_id)


@router.delete("/incidents/{incident_id}/members/{unit_id}", status_code=204)
def release_member(incident_id: Id, unit_id: UnitId, station: Station, perform: Perform) -> None:
    """Remove a unit and its wearer from the incident; they are then in none."""
    if not any(one.unit_id == unit_id for one in _members(station, incident_id)):
        raise Problem(
            404,
            coded(
                "not-a-member",
                "{unit} is not in the incident {incident}.",
                unit=unit_id,
                incident=incident_id,
            ),
        )
    perform(AssignIncident("", (unit_id,)))


def _units_of(target: object, station: Services) -> tuple[str, ...]:
    """Units that the people of a target wear.  Problem 409 where they wear none."""
    if isinstance(target, UnitTarget):
        return (target.unit_id,)
    people = set(members_of(target, station))
    worn = [one for one in station.picture().units if one.registered and one.person]
    everyone = isinstance(target, EveryoneTarget)
    units = tuple(
        one.unit_id for one in worn if everyone or (one.person and one.person.person_id in people)
    )
    if not units:
        raise Problem(
            409,
            coded(
                "members-without-units",
                "None of them wears a registered unit: assign a unit first.",
            ),
        )
    return units


def _members(station: Services, incident_id: str) -> list[Member]:
    picture = station.picture()
    opened = {one.incident_id for one in picture.incidents if one.closed_ms is None}
    found = [
        _member(unit)
        for unit in picture.units
        if unit.registered
        and incident_id == (unit.incident_id if unit.incident_id in opened else "")
    ]
    return sorted(found, key=lambda one: (one.person_id is None, one.crew, one.name, one.unit_id))


def _member(unit: UnitView) -> Member:
    person = unit.person
    return Member(
        unit_id=unit.unit_id,
        person_id=person.person_id if person else None,
        name=person.name if person else unit.label,
        crew=person.crew if person else "",
    )
