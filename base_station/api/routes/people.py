"""The roster of people, and their photos."""

from __future__ import annotations

import secrets
from typing import Annotated, Literal

from fastapi import APIRouter, Body, Query, Response
from pydantic import BaseModel

from base_station.api.authentication import Commander, Viewer
from base_station.api.current_tables import CurrentStation
from base_station.api.document import file_response
from base_station.api.forms import MAX_UPLOAD_BYTES, Form, Id, Name, ShortText
from base_station.api.idempotent_request import Perform
from base_station.api.images import normalize_photo
from base_station.api.people_csv import MOST_CSV_BYTES, CsvFault, CsvPerson, read_people
from base_station.api.problems import Problem
from base_station.api.refusals import NO_PERSON
from base_station.api.services import Services, Station
from base_station.api.uploads import UploadRoute
from base_station.storage.db import models
from base_station.storage.db.people_import import ImportStep, ListedPerson
from base_station.views.text_code import text_code_view_or_none
from base_station.views.wire import PersonView, TextCodeView
from shared.coded_text import Measure, code_of_text, coded, text_of_error
from shared.errors import UserError
from shared.messages.station import Assign

router = APIRouter(tags=["people"], route_class=UploadRoute)


class PersonForm(Form):
    name: Name
    crew: ShortText = ""
    role: ShortText = ""


class ListedPersonAnswer(BaseModel):
    line: int
    name: str
    crew: str
    role: str
    change: Literal["add", "change", "same"]


class FaultyLine(BaseModel):
    line: int
    fault: str
    fault_code: TextCodeView | None  # of ``fault``, where it has one


class PeopleImport(BaseModel):
    people: list[ListedPersonAnswer]
    faulty_lines: list[FaultyLine]


def _person(person: models.PersonRow, station: Services) -> PersonView:
    return PersonView(
        person_id=person.person_id,
        name=person.name,
        crew=person.crew,
        role=person.role,
        photo_url=station.roster.known(person.person_id).photo_url,
    )


@router.get("/people")
def list_people(station: Station, _: Viewer) -> list[PersonView]:
    return [_person(person, station) for person in station.roster.people()]


@router.post("/people", status_code=201)
def add_person(form: PersonForm, station: Station, perform: Perform) -> PersonView:
    person = station.roster.add_person(form.name, form.crew, form.role, perform.row_id)
    perform.require_row(person.person_id)
    added = {f"added-{person.person_id}": ("AddedPerson", person.person_id)}
    station.records.audit_once(perform.by, added)
    return _person(person, station)


@router.post("/people/import", max_body_size=MOST_CSV_BYTES)
def import_people(
    csv: Annotated[bytes, Body(media_type="text/csv")],
    station: Station,
    who: Commander,
    preview: bool = False,
) -> PeopleImport:
    """Import people from a CSV file with the columns Name, Crew and Role.  People with a known name
    are changed, others are added.  If any line has a fault, nothing is imported (422). The request
    may be repeated.
    """
    try:
        listed, faults = read_people(csv)
    except UserError as error:
        raise Problem(422, text_of_error(error)) from error
    wanted = [ListedPerson(one.name, one.crew, one.role) for one in listed]
    steps = station.roster.preview_import(wanted)
    faults = sorted(faults + _ambiguous(listed, steps))
    if not preview:
        if faults:
            raise Problem(422, _refusal(faults))
        steps = station.roster.import_people(wanted)
        _announce(steps, station, who.username)
    return PeopleImport(
        people=[
            ListedPersonAnswer(
                line=one.line, name=step.name, crew=step.crew, role=step.role, change=step.kind
            )
            for one, step in zip(listed, steps, strict=True)
            if step.kind != "ambiguous"
        ],
        faulty_lines=[_faulty_line(fault) for fault in faults],
    )


def _ambiguous(listed: list[CsvPerson], steps: list[ImportStep]) -> list[CsvFault]:
    return [
        CsvFault(
            one.line,
            coded(
                "csv-person-ambiguous",
                "{name} is the name of two people here; rename one of them first",
                name=step.name,
            ),
        )
        for one, step in zip(listed, steps, strict=True)
        if step.kind == "ambiguous"
    ]


def _faulty_line(fault: CsvFault) -> FaultyLine:
    code = text_code_view_or_none(code_of_text(fault.text))
    return FaultyLine(line=fault.line, fault=str(fault.text), fault_code=code)


def _refusal(faults: list[CsvFault]) -> str:
    return coded(
        "people-faulty",
        "no person was added: line {line}: {fault}{more}",
        line=faults[0].line,
        fault=faults[0].text,
        more=Measure(
            len(faults), f" (the first of {len(faults)} faults)" if len(faults) > 1 else ""
        ),
    )


def _announce(steps: list[ImportStep], station: Services, by: str) -> None:
    """Show wearers with the new crew at once; the audit names every person."""
    done = {
        f"imported-{secrets.token_hex(8)}": (
            "AddedPerson" if step.kind == "add" else "ChangedPerson",
            step.person_id,
        )
        for step in steps
        if step.kind != "same"
    }
    if done:
        station.records.audit_once(by, done)
    changed = {step.person_id for step in steps if step.kind == "change"}
    for unit in station.picture().units if changed else ():
        if unit.person is not None and unit.person.person_id in changed:
            station.perform(by, Assign(unit.unit_id, unit.person.person_id))


@router.get("/people/{person_id}")
def get_person(person_id: Id, station: Station, _: Viewer) -> PersonView:
    person = station.roster.person(person_id)
    if person is None:
        raise Problem(404, NO_PERSON)
    return _person(person, station)


@router.put("/people/{person_id}")
def change_person(person_id: Id, form: PersonForm, station: Station, who: Commander) -> PersonView:
    """Change a person's name, crew or role; a wearer is shown with them at once."""
    person = station.roster.change_person(person_id, form.name, form.crew, form.role)
    if person is None:
        raise Problem(404, NO_PERSON)
    for unit_id in station.worn_by(person_id):
        station.perform(who.username, Assign(unit_id, person_id))  # shows it anew
    station.records.audit(who.username, "ChangedPerson", person_id)
    return _person(person, station)


@router.delete("/people/{person_id}", status_code=204)
def remove_person(person_id: Id, station: CurrentStation, who: Commander) -> None:
    if not station.roster.remove_person(person_id):
        raise Problem(404, NO_PERSON)
    station.records.audit(who.username, "RemovedPerson", person_id)


@router.put("/people/{person_id}/photo", status_code=204, max_body_size=MAX_UPLOAD_BYTES)
def set_photo(
    person_id: Id,
    photo: Annotated[bytes, Body(media_type="image/jpeg")],
    station: Station,
    who: Commander,
) -> None:
    """Set a person's photo: JPEG, PNG or WebP, stored as a small square without its metadata."""
    if station.roster.person(person_id) is None:
        raise Problem(404, NO_PERSON)
    with station.image_lock:
        jpeg, photo_hash = normalize_photo(photo)
    person = station.roster.set_photo(person_id, jpeg, photo_hash)
    if person is None:
        raise Problem(404, NO_PERSON)
    for unit_id in station.worn_by(person_id):
        station.perform(who.username, Assign(unit_id, person_id))  # shows it anew
    station.records.audit(who.username, "SetPhoto", person_id)


@router.get(
    "/people/{person_id}/photo", response_class=Response, responses=file_response("image/jpeg")
)
def get_photo(
    person_id: Id, station: Station, _: Viewer, _version: Annotated[str, Query(alias="v")] = ""
) -> Response:
    found = station.roster.photo(person_id)
    if found is None:
        raise Problem(404, coded("photo-missing", "There is no photo of this person."))
    jpeg, photo_hash = found
    # The address changes with the photo; only this browser may keep it.
    headers = {"Cache-Control": "private, max-age=86400", "ETag": f'"{photo_hash}"'}
    return Response(jpeg, media_type="image/jpeg", headers=headers)
