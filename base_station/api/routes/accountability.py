"""The roll call (PAR), work and rest of who is on duty in the open incident."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter
from pydantic import BaseModel, Field

from base_station.accountability import LONGEST_S, SHORTEST_S
from base_station.api.acting import Act
from base_station.api.forms import Form, Id, UnitId
from base_station.api.problems import Problem
from base_station.api.routes.commands import CrewTarget, Target, UnitTarget
from base_station.api.security import Viewer
from base_station.api.services import Station
from base_station.views.wire import DutyView, IncidentView, PersonView
from shared.messages.station import CheckIn, SetAccountability, SetRest

router = APIRouter(tags=["accountability"])

Seconds = Annotated[float, Field(ge=SHORTEST_S, le=LONGEST_S)]


class OnDuty(BaseModel):
    """Somebody who is to be heard from."""

    unit_id: str
    person_id: str
    name: str
    crew: str
    state: str  # green | warning | overdue
    left_s: float  # until the next check-in is due; negative: overdue
    checked_in_ms: int
    checked_in_by: str
    asked_ms: int | None
    work_since_ms: int | None
    rest_since_ms: int | None


class NewCheckIn(Form):
    target: Target


class Times(Form):
    par_interval_s: Seconds
    work_limit_s: Seconds


class Rest(Form):
    resting: bool


@router.get("/accountability")
def list_on_duty(station: Station, _: Viewer) -> list[OnDuty]:
    """Who is to be heard from, the most urgent first."""
    picture = station.picture()
    incident = picture.incident
    if incident is None or incident.closed_ms is not None:
        return []
    found = [
        _on_duty(unit.unit_id, unit.person, unit.duty, incident, picture.now_ms)
        for unit in picture.units
        if unit.person is not None and unit.duty is not None
    ]
    return sorted(found, key=lambda one: one.left_s)


@router.get("/accountability/usual")
def usual_times(station: Station, _: Viewer) -> Times:
    """With which an incident is opened where nobody says others."""
    usual = station.accountability
    return Times(par_interval_s=usual.par_interval_s, work_limit_s=usual.work_limit_s)


@router.post("/check-ins", status_code=204)
def check_in(new: NewCheckIn, act: Act) -> None:
    """Somebody has heard from them: that, and nothing that a unit measures, completes a PAR."""
    unit_id = new.target.unit_id if isinstance(new.target, UnitTarget) else ""
    crew = new.target.crew if isinstance(new.target, CrewTarget) else ""
    act(CheckIn(unit_id, crew, everyone=not unit_id and not crew))


@router.put("/incidents/{incident_id}/accountability", status_code=204)
def set_times(incident_id: Id, times: Times, station: Station, act: Act) -> None:
    incident = station.picture().incident
    if incident is None or incident.incident_id != incident_id or incident.closed_ms is not None:
        raise Problem(404, f"There is no open incident {incident_id}.")
    act(SetAccountability(times.par_interval_s, times.work_limit_s))


@router.put("/units/{unit_id}/rest", status_code=204)
def set_rest(unit_id: UnitId, rest: Rest, act: Act) -> None:
    """The wearer goes to rest, or is ready for work again."""
    act(SetRest(unit_id, rest.resting))


def _on_duty(
    unit_id: str, person: PersonView, duty: DutyView, incident: IncidentView, now_ms: int
) -> OnDuty:
    left_s = (duty.due_ms - now_ms) / 1000.0
    state = "green" if left_s > incident.par_warning_s else "warning" if left_s > 0 else "overdue"
    return OnDuty(
        unit_id=unit_id,
        person_id=person.person_id,
        name=person.name,
        crew=person.crew,
        state=state,
        left_s=left_s,
        checked_in_ms=duty.checked_in_ms,
        checked_in_by=duty.checked_in_by,
        asked_ms=duty.asked_ms,
        work_since_ms=duty.work_since_ms,
        rest_since_ms=duty.rest_since_ms,
    )
