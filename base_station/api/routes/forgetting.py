"""Erasure of personal data; the fact, and the user who requested it, stay in the audit."""

from __future__ import annotations

from collections.abc import Collection

from fastapi import APIRouter
from pydantic import BaseModel

from base_station.api.authentication import Administrator
from base_station.api.forms import Form, Id, Name
from base_station.api.problems import Problem
from base_station.api.refusals import NO_PERSON, ONLY_REPLAYS
from base_station.api.routes.incidents import incident_or_404
from base_station.api.services import Services, Station
from base_station.privacy.erasure_queue import ErasureJob, ErasureQueue
from base_station.views.text_code import text_code_view_or_none
from base_station.views.wire import CommandView, TextCodeView
from shared.coded_text import coded
from shared.errors import UserError
from shared.messages.station import Unassign

router = APIRouter(tags=["forgetting"])


class NameConfirmation(Form):
    name: Name  # description of the subject, as it is shown: an erasure cannot be undone


class PersonConfirmation(NameConfirmation):
    unassign: bool = False  # units that the person wears; otherwise that is refused


class Progress(BaseModel):
    forgetting_id: str
    by: str
    kind: str  # person | incident
    subject_id: str
    state: str  # waiting | working | done | failed
    problem: str  # a sentence for a person
    share: float  # of the log that was looked through
    records: int  # of the log that changed or went
    files: int  # that were written anew or removed
    problem_code: TextCodeView | None = None  # of ``problem``, where it has one


@router.get("/forgettings")
def list_forgettings(station: Station, _: Administrator) -> list[Progress]:
    """Erasures that are under way, and the last finished ones."""
    return [] if station.erasures is None else list(map(_progress, station.erasures.all()))


@router.post("/people/{person_id}/forget", status_code=202)
def forget_person(
    person_id: Id, confirmation: PersonConfirmation, station: Station, who: Administrator
) -> Progress:
    """Erase the name, photo and all positions of a person.  The work goes on until it is finished,
    also after restarts.  A person who was removed from the roster is found by any former name.
    """
    _desk(station)
    person = station.roster.person(person_id)
    names = station.roster.names_of(person_id) if person is None else {person.name}
    if not names:
        raise Problem(404, NO_PERSON)
    _require_name(confirmation, names)
    worn = station.worn_by(person_id)
    if worn and not confirmation.unassign:
        units = ", ".join(worn)
        raise Problem(
            409,
            coded(
                "erase-wears",
                "{name} wears {units}; unassign that first, or send unassign.",
                name=confirmation.name,
                units=units,
            ),
        )
    return _progress(_accept(station, who.username, "person", person_id))


@router.post("/incidents/{incident_id}/forget", status_code=202)
def forget_incident(
    incident_id: Id, confirmation: NameConfirmation, station: Station, who: Administrator
) -> Progress:
    """Erase the people of an incident and their positions; its name, times and alarms stay."""
    _desk(station)
    incident = incident_or_404(station, incident_id)
    name = station.roster.shown(incident.name)
    _require_name(confirmation, {name})
    if incident.closed_ns is None:
        raise Problem(
            409,
            coded(
                "erase-named-open",
                "The incident {incident} is open; close it first.",
                incident=name,
            ),
        )
    return _progress(_accept(station, who.username, "incident", incident_id))


def accept_from_command(station: Services, by: str, kind: str, subject_id: str) -> ErasureJob:
    """Accept an erasure that was ordered and confirmed by a command on the station's machine.
    Raises UserError with the reason where it is refused.
    """
    refusal = None if station.ha_status is None else station.ha_status.refusal()
    if refusal is not None:
        raise UserError(f"nothing was changed: {refusal}")
    try:
        return _accept(station, by, kind, subject_id)
    except Problem as problem:
        raise UserError(problem.detail) from problem


def _accept(station: Services, by: str, kind: str, subject_id: str) -> ErasureJob:
    """Queue the erasure.  The person's units are unassigned first: later messages of these units
    would otherwise never be erased.
    """
    desk = _desk(station)
    if kind == "person":
        for unit_id in station.worn_by(subject_id):
            station.perform(by, Unassign(unit_id))
        station.projection.flush()  # otherwise it would be stored behind the erasure
    return desk.add(by, kind, subject_id)


def _desk(station: Services) -> ErasureQueue:
    if station.erasures is None:
        raise Problem(409, ONLY_REPLAYS)
    incident = station.picture().incident
    if incident is not None and incident.closed_ms is None:
        raise Problem(
            409,
            coded(
                "erase-while-open",
                "The incident {incident} is open; close it first.",
                incident=incident.name,
            ),
        )
    if any(one.text and _is_under_way(one) for one in station.picture().commands):
        raise Problem(
            409,
            coded(
                "erase-message-under-way",
                "A message has not reached all to whom it goes, and would not any more: "
                "wait until it has, or its time is over.",
            ),
        )
    station.projection.flush()  # pending records would be stored afterwards
    return station.erasures


def _is_under_way(command: CommandView) -> bool:
    return any(one.state in {"queued", "sent"} for one in command.units)


def _require_name(confirmation: NameConfirmation, names: Collection[str]) -> None:
    if confirmation.name not in names:
        raise Problem(
            422, coded("erase-name-differs", "The name is another: give it exactly as it is shown.")
        )


def _progress(one: ErasureJob) -> Progress:
    return Progress(
        forgetting_id=one.forgetting_id,
        by=one.by,
        kind=one.kind,
        subject_id=one.subject_id,
        state=one.state.value,
        problem=one.problem,
        share=one.share,
        records=one.records,
        files=one.files,
        problem_code=text_code_view_or_none(one.problem_code),
    )
