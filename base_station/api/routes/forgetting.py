"""Personal data goes; that it went, and who wished it, stays in the audit."""

from __future__ import annotations

from fastapi import APIRouter
from pydantic import BaseModel

from base_station.api.forms import Form, Id, Name
from base_station.api.problems import Problem
from base_station.api.routes.incidents import incident_or_404
from base_station.api.security import Administrator
from base_station.api.services import Services, Station
from base_station.forgetting.forgetter import Forgetter, Forgotten

router = APIRouter(tags=["forgetting"])


class Confirmation(Form):
    name: Name  # of what is to be forgotten, as it is shown: it cannot be undone


class Done(BaseModel):
    records: int  # of the log that changed or went
    files: int  # that were written anew or removed


@router.post("/people/{person_id}/forget")
def forget_person(
    person_id: Id, confirmation: Confirmation, station: Station, who: Administrator
) -> Done:
    """Name, photo and everywhere the person was; takes a while where the log is long."""
    forgetter = _forgetter(station)
    person = station.roster.person(person_id)
    if person is None:
        raise Problem(404, "There is no such person.")
    _require_name(confirmation, person.name)
    worn = station.roster.worn_by(person_id)
    if worn:
        raise Problem(409, f"{person.name} wears {', '.join(worn)}; unassign that first.")
    done = forgetter.person(who.username, person_id)
    station.roster.forget_photo(person_id)
    return _done(done)


@router.post("/incidents/{incident_id}/forget")
def forget_incident(
    incident_id: Id, confirmation: Confirmation, station: Station, who: Administrator
) -> Done:
    """Who was there and where; its name, its times and that there were alarms stay."""
    forgetter = _forgetter(station)
    incident = incident_or_404(station, incident_id)
    _require_name(confirmation, incident.name)
    if incident.closed_ns is None:
        raise Problem(409, f"The incident {incident.name} is open; close it first.")
    return _done(forgetter.incident(who.username, incident_id))


def _forgetter(station: Services) -> Forgetter:
    if station.forgetter is None:
        raise Problem(409, "This station only replays; nothing can be changed here.")
    incident = station.picture().incident
    if incident is not None and incident.closed_ms is None:
        raise Problem(409, f"The incident {incident.name} is open; close it first.")
    station.settle()  # what still is to be stored would be stored afterwards
    return station.forgetter


def _require_name(confirmation: Confirmation, name: str) -> None:
    if confirmation.name != name:
        raise Problem(422, "The name is another: give it exactly as it is shown.")


def _done(done: Forgotten) -> Done:
    return Done(records=done.records, files=done.files)
