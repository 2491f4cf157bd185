"""The wearable units: received, registered and labelled ones, and their start positions."""

from __future__ import annotations

import math
from contextlib import AbstractContextManager, suppress
from typing import Annotated

from fastapi import APIRouter
from pydantic import BaseModel, Field

from base_station.api.authentication import Viewer
from base_station.api.current_tables import CurrentStation
from base_station.api.forms import (
    Form,
    Metres,
    PersonIdText,
    ShortText,
    UnitId,
    UnitIdOrNone,
    UnitIdText,
)
from base_station.api.idempotent_request import Perform
from base_station.api.problems import Problem
from base_station.api.refusals import not_found_if_unknown
from base_station.api.request_incident import site_incident_id
from base_station.api.services import Services, Station
from base_station.storage.db import models
from base_station.storage.db.roster import Roster
from base_station.views.answer import to_ms_or_none
from base_station.views.stored_units import stored_sensors
from base_station.views.wire import UnitView, WornSensorView
from shared.channels import validate_unit_id
from shared.coded_text import coded
from shared.errors import StoreError
from shared.messages.station import RegisterUnit, SetReference, SetStart

router = APIRouter(tags=["units"])


class UnitAnswer(BaseModel):
    unit_id: str
    label: str
    registered: bool
    person_id: str | None
    last_heard_ms: int | None
    software_version: str
    source: str
    sensor_name: str
    tracker: str
    calibration: str
    has_gps: bool
    sensors: list[WornSensorView]


class NewUnit(Form):
    unit_id: UnitIdText
    label: ShortText = ""


class Label(Form):
    label: ShortText


class UnitStartForm(Form):
    """Place at which the unit's own frame began, in the incident frame, with the standard deviation
    of what is known of it.
    """

    north_m: Metres
    east_m: Metres
    down_m: Metres = 0.0
    heading_rad: Annotated[float, Field(ge=-2 * math.pi, le=2 * math.pi)] = 0.0
    std_m: Annotated[float, Field(gt=0.0, le=1000.0)] = 1.0
    heading_std_rad: Annotated[float, Field(gt=0.0, le=math.pi)] = math.pi


class Reference(Form):
    unit_id: UnitIdOrNone
    incident_id: PersonIdText | None = None  # incident of the site; None: the only open one
    down_m: Metres = 0.0


@router.get("/units")
def list_units(station: CurrentStation, _: Viewer) -> list[UnitAnswer]:
    return [_unit(unit, worn, station.roster) for unit, worn in station.roster.units()]


@router.post("/units", status_code=201)
def register_unit(new: NewUnit, station: Station, perform: Perform) -> UnitAnswer:
    """Register a unit, whose messages are used from now on.  Registering it again changes its
    label.
    """
    validate_unit_id(new.unit_id)
    perform(RegisterUnit(new.unit_id, new.label))
    return _unit_as_decided(station, new.unit_id)


@router.put("/units/{unit_id}")
def label_unit(unit_id: UnitId, change: Label, station: Station, perform: Perform) -> UnitAnswer:
    _registered_or_404(station, unit_id)
    perform(RegisterUnit(unit_id, change.label))
    return _unit_as_decided(station, unit_id)


@router.put("/units/{unit_id}/start", status_code=204)
def set_start(unit_id: UnitId, start: UnitStartForm, station: Station, perform: Perform) -> None:
    with _not_found_if_unknown(station, unit_id):
        perform(SetStart(unit_id, **start.model_dump()))


@router.put("/reference-barometer", status_code=204)
def set_reference(reference: Reference, station: Station, perform: Perform) -> None:
    """Set the reference unit, which stays in one place: its barometer measures the weather for all
    units.  If its start position is set, its satellite receiver also measures the common error of
    all receivers of the site.  An empty id removes it.
    """
    with _not_found_if_unknown(station, reference.unit_id):
        named = site_incident_id(station, reference.incident_id)
        perform(SetReference(reference.unit_id, reference.down_m, named))


def _not_found_if_unknown(station: Services, unit_id: str) -> AbstractContextManager[None]:
    return not_found_if_unknown(
        station,
        f"There is no unit {unit_id}.",
        shown=lambda picture: not unit_id or any(one.unit_id == unit_id for one in picture.units),
        stored=lambda: station.roster.unit(unit_id) is not None,
    )


def _registered_or_404(station: Services, unit_id: str) -> UnitView:
    for view in station.picture().units:
        if view.unit_id == unit_id and view.registered:
            return view
    raise Problem(
        404, coded("unit-not-listed", "There is no registered unit {unit}.", unit=unit_id)
    )


def _unit_as_decided(station: Services, unit_id: str) -> UnitAnswer:
    """The unit as the live picture has it.  The live picture does not contain the unit's
    description; that is taken from the database, in its present state.
    """
    view = _registered_or_404(station, unit_id)
    stored = None
    with suppress(StoreError):
        stored = station.roster.unit(unit_id)
    return UnitAnswer(
        unit_id=view.unit_id,
        label=view.label,
        registered=view.registered,
        person_id=None if view.person is None else view.person.person_id,
        last_heard_ms=view.last_heard_ms,
        software_version=stored.software_version if stored else "",
        source=stored.source if stored else "",
        sensor_name=stored.sensor_name if stored else "",
        tracker=stored.tracker if stored else "",
        calibration=stored.calibration if stored else "",
        has_gps=stored is not None and stored.has_gps,
        sensors=list(stored_sensors(stored)) if stored else [],
    )


def _unit(unit: models.Unit, worn: models.Assignment | None, roster: Roster) -> UnitAnswer:
    return UnitAnswer(
        unit_id=unit.unit_id,
        label=roster.shown(unit.label),
        registered=unit.registered_ns is not None,
        person_id=None if worn is None else worn.person_id,
        last_heard_ms=to_ms_or_none(unit.last_heard_ns),
        software_version=unit.software_version,
        source=unit.source,
        sensor_name=unit.sensor_name,
        tracker=unit.tracker,
        calibration=unit.calibration,
        has_gps=unit.has_gps,
        sensors=list(stored_sensors(unit)),
    )
