"""PAR, work and rest of members on duty in the open incident."""

from __future__ import annotations

import uuid
from typing import Annotated

from fastapi import APIRouter
from pydantic import BaseModel, Field, StringConstraints

from base_station.api.authentication import Viewer
from base_station.api.forms import ID, Form, Id, PersonIdText, UnitId, UnitIdOrNone
from base_station.api.idempotent_request import Perform
from base_station.api.request_incident import open_or_404
from base_station.api.routes.commands import EveryoneTarget, Target, UnitTarget, members_of
from base_station.api.services import Station
from base_station.core.accountability import LONGEST_S, SHORTEST_S
from base_station.views.wire import DutyView, IncidentView, PersonView
from shared.messages.station import CheckIn, SetAccountability, SetRest, UndoConfirmation

router = APIRouter(tags=["accountability"])

Seconds = Annotated[float, Field(ge=SHORTEST_S, le=LONGEST_S)]


CheckInId = Annotated[str, StringConstraints(pattern=ID)]


class OnDuty(BaseModel):
    """A member whose PAR is to be confirmed."""

    unit_id: str
    incident_id: str
    person_id: str
    name: str
    crew: str
    state: str  # green | not_confirmed | warning | overdue
    left_s: float  # until the next PAR is due; negative: overdue
    checked_in_ms: int | None  # at the last PAR confirmation; None: not yet confirmed
    checked_in_by: str  # self: the member; radio: who entered it; empty: not yet confirmed
    asked_ms: int | None
    work_since_ms: int | None
    rest_since_ms: int | None
    confirmed: str  # self: by the member's own unit | radio | not_yet
    on_duty_ms: int
    located: bool  # a message of the unit has come in this incident
    entry_id: str  # of a confirmation by radio: the check-in, or the command; else empty


class NewCheckIn(Form):
    """PAR confirmed by radio."""

    target: Target
    incident_id: PersonIdText | None = None  # only of its members
    check_in_id: CheckInId | None = None  # of the client's choice, to undo it by; None: any


class UndoCheckIn(Form):
    unit_id: UnitIdOrNone = ""  # empty: all members that the check-in confirmed


class Times(Form):
    par_interval_s: Seconds
    work_limit_s: Seconds


class Rest(Form):
    resting: bool


@router.get("/accountability")
def list_on_duty(station: Station, _: Viewer, incident_id: Id | None = None) -> list[OnDuty]:
    """Members whose PAR is to be confirmed, the most urgent first; of one incident, or of all."""
    picture = station.picture()
    incidents = {one.incident_id: one for one in picture.incidents}
    found = [
        _on_duty(unit.unit_id, unit.person, unit.duty, incidents[unit.incident_id], picture.now_ms)
        for unit in picture.units
        if unit.person is not None and unit.duty is not None and unit.incident_id in incidents
        if incident_id in (None, unit.incident_id)
    ]
    return sorted(found, key=lambda one: one.left_s)


@router.get("/accountability/usual")
def usual_times(station: Station, _: Viewer) -> Times:
    """Default PAR interval and work limit of an incident, used where a request to open one gives
    none.
    """
    usual = station.accountability
    return Times(par_interval_s=usual.par_interval_s, work_limit_s=usual.work_limit_s)


@router.post("/check-ins", status_code=204)
def check_in(new: NewCheckIn, station: Station, perform: Perform) -> None:
    """Confirm a PAR that the member answered by radio.  This resolves the alarm that the PAR is
    overdue, and no other alarm.
    """
    unit_id = new.target.unit_id if isinstance(new.target, UnitTarget) else ""
    everyone = isinstance(new.target, EveryoneTarget)
    check_in_id = new.check_in_id or uuid.uuid4().hex
    incident_id = open_or_404(station, new.incident_id).incident_id if new.incident_id else ""
    people = members_of(new.target, station)
    perform(CheckIn(unit_id, "", everyone, check_in_id, people, incident_id))


@router.post("/check-ins/{check_in_id}/undo", status_code=204)
def undo_check_in(check_in_id: Id, perform: Perform, undo: UndoCheckIn | None = None) -> None:
    """Undo a PAR confirmation that was entered in error.  The PAR is then as if it had not been
    entered; answers that members gave on their own units stay.
    """
    perform(UndoConfirmation(check_in_id, undo.unit_id if undo else ""))


@router.put("/incidents/{incident_id}/accountability", status_code=204)
def set_times(incident_id: Id, times: Times, station: Station, perform: Perform) -> None:
    open_or_404(station, incident_id)
    perform(SetAccountability(times.par_interval_s, times.work_limit_s, incident_id))


@router.put("/units/{unit_id}/rest", status_code=204)
def set_rest(unit_id: UnitId, rest: Rest, perform: Perform) -> None:
    """Send the wearer to rehab, or mark the wearer as ready for work again."""
    perform(SetRest(unit_id, rest.resting))


def _on_duty(
    unit_id: str, person: PersonView, duty: DutyView, incident: IncidentView, now_ms: int
) -> OnDuty:
    left_s = (duty.due_ms - now_ms) / 1000.0
    return OnDuty(
        unit_id=unit_id,
        incident_id=incident.incident_id,
        person_id=person.person_id,
        name=person.name,
        crew=person.crew,
        state=_state(duty, incident, left_s),
        left_s=left_s,
        checked_in_ms=duty.checked_in_ms,
        checked_in_by=duty.checked_in_by,
        asked_ms=duty.asked_ms,
        work_since_ms=duty.work_since_ms,
        rest_since_ms=duty.rest_since_ms,
        confirmed=duty.confirmed,
        on_duty_ms=duty.on_duty_ms,
        located=duty.located,
        entry_id=duty.entry_id,
    )


def _state(duty: DutyView, incident: IncidentView, left_s: float) -> str:
    if left_s <= 0.0:
        return "overdue"
    if left_s <= incident.par_warning_s:
        return "warning"
    return "not_confirmed" if duty.confirmed == "not_yet" else "green"
