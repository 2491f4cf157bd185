"""Assignments of units to people."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Depends
from pydantic import BaseModel

from base_station.api.authentication import Viewer
from base_station.api.current_tables import CurrentStation
from base_station.api.forms import Form, Limit, PersonIdText, UnitId, UnitIdText, window
from base_station.api.idempotent_request import Perform
from base_station.api.problems import Problem
from base_station.api.refusals import NO_PERSON
from base_station.api.services import Station
from base_station.storage.db.window import Window
from base_station.views.answer import to_ms, to_ms_or_none
from shared.messages.station import Assign, Unassign

router = APIRouter(tags=["assignments"])


class AssignmentAnswer(BaseModel):
    unit_id: str
    person_id: str
    person_name: str
    crew: str
    role: str
    from_ms: int
    until_ms: int | None


class NewAssignment(Form):
    unit_id: UnitIdText
    person_id: PersonIdText


@router.get("/assignments")
def list_assignments(
    station: CurrentStation, _: Viewer, when: Annotated[Window, Depends(window)], limit: Limit = 100
) -> list[AssignmentAnswer]:
    """Assignments of units to people that were valid at some time of the window, newest first."""
    held = station.roster.newest_assignments(when.from_ns, when.until_ns, limit)
    return [
        AssignmentAnswer(
            unit_id=one.unit_id,
            person_id=one.person_id,
            person_name=wearer.name,
            crew=wearer.crew,
            role=wearer.role,
            from_ms=to_ms(one.from_ns),
            until_ms=to_ms_or_none(one.until_ns),
        )
        for one, wearer in zip(held, map(station.roster.wearer, held), strict=True)
    ]


@router.post("/assignments", status_code=204)
def assign(new: NewAssignment, station: Station, perform: Perform) -> None:
    """Assign a unit to a person, who from now on wears this unit and no other."""
    person = station.roster.person(new.person_id)
    if person is None:
        raise Problem(404, NO_PERSON)
    perform(Assign(new.unit_id, person.person_id))


@router.delete("/assignments/{unit_id}", status_code=204)
def unassign(unit_id: UnitId, perform: Perform) -> None:
    """End the assignment of a unit: from now on nobody wears it."""
    perform(Unassign(unit_id))
