"""Pins and beacons: known places of people, set, moved and removed."""

from __future__ import annotations

import math
import uuid
from typing import Annotated

from fastapi import APIRouter
from pydantic import Field

from base_station.api.authentication import Viewer
from base_station.api.forms import (
    MAX_TIME_MS,
    Form,
    Id,
    Metres,
    Note,
    PersonIdText,
    ShortText,
    UnitIdText,
)
from base_station.api.idempotent_request import Perform
from base_station.api.problems import Problem
from base_station.api.request_incident import site_incident_id
from base_station.api.services import Services, Station
from base_station.views.wire import BeaconView, PinView
from shared.clock import NS_PER_MS
from shared.coded_text import coded
from shared.messages.pins import (
    PlaceBeacon,
    RemoveBeacon,
    RemovePin,
    SetMeeting,
    SetPin,
    StartTogether,
)

router = APIRouter(tags=["pins"])

_NO_PIN = coded("pin-unknown", "There is no such pin.")
_NO_BEACON = coded("beacon-unknown", "There is no such beacon.")

Milliseconds = Annotated[int, Field(ge=0, le=MAX_TIME_MS)]
Std = Annotated[float, Field(gt=0.0, le=1000.0)]
Floor = Annotated[int, Field(ge=-100, le=1000)]
Heading = Annotated[float, Field(ge=-2 * math.pi, le=2 * math.pi)]


class PlaceForm(Form):
    """Place in the incident frame, with the standard deviation of what is known of it."""

    north_m: Metres
    east_m: Metres
    std_m: Std = 1.0
    floor: Floor | None = None
    heading_rad: Heading | None = None  # which way the wearer looked or went
    heading_std_rad: Annotated[float, Field(gt=0.0, le=math.pi)] = 0.35
    note: Note = ""


class PinForm(PlaceForm):
    unit_id: UnitIdText
    t_ms: Milliseconds | None = None  # station time; None: now


class StartForm(PlaceForm):
    unit_ids: Annotated[list[UnitIdText], Field(min_length=1, max_length=200)]
    t_ms: Milliseconds = 0  # 0: where each unit's path begins


class MeetingForm(Form):
    unit_id: UnitIdText
    other_unit_id: UnitIdText
    t_ms: Milliseconds | None = None
    std_m: Std = 1.0
    note: Note = ""


class BeaconForm(Form):
    label: ShortText = ""
    north_m: Metres
    east_m: Metres
    floor: Floor | None = None
    std_m: Std = 0.5
    reach_m: Annotated[float, Field(ge=0.0, le=100.0)] = 3.0
    incident_id: PersonIdText | None = None  # incident of the site; None: the only open one


# Fields that a moved one may keep; they have the same names in its view.
_PIN_MAY_KEEP = frozenset({"t_ms", "std_m", "floor", "heading_rad", "heading_std_rad", "note"})
_BEACON_MAY_KEEP = frozenset({"label", "floor", "std_m", "reach_m"})


@router.get("/pins")
def list_pins(station: Station, _: Viewer) -> list[PinView]:
    """Pins in the order in which they were set, each with its verdict."""
    return list(station.picture().pins)


@router.post("/pins", status_code=201)
def set_pin(form: PinForm, station: Station, perform: Perform) -> PinView:
    """Set a pin: the unit was at this place at this time.  Its whole trail is solved again."""
    done = perform(_place_pin(station, uuid.uuid4().hex, form))
    return _pin_or_404(station, done.created_id)


@router.post("/pins/start", status_code=201)
def start_together(form: StartForm, station: Station, perform: Perform) -> list[PinView]:
    """Set a common start of several units: they were together at this place, either where their
    paths begin or at the given time.
    """
    fields = form.model_dump(exclude={"t_ms", "unit_ids"})
    unit_ids = tuple(form.unit_ids)
    action = StartTogether(uuid.uuid4().hex, unit_ids, form.t_ms * NS_PER_MS, **fields)
    made = f"{perform(action).created_id}:"
    return [view for view in station.picture().pins if view.pin_id.startswith(made)]


@router.post("/pins/meeting", status_code=201)
def set_meeting(form: MeetingForm, station: Station, perform: Perform) -> PinView:
    """Set a meeting of two people, at a place that may be unknown."""
    met = uuid.uuid4().hex, form.unit_id, form.other_unit_id
    action = SetMeeting(*met, _time(station, form.t_ms), form.std_m, form.note)
    return _pin_or_404(station, perform(action).created_id)


@router.put("/pins/{pin_id}")
def move_pin(pin_id: Id, form: PinForm, station: Station, perform: Perform) -> PinView:
    """Replace a pin by one at another place or time; fields that are left out keep their values."""
    before = _pin_or_404(station, pin_id)
    if before.kind not in {"place", "start"}:
        raise Problem(
            409,
            coded(
                "pin-of-another-kind",
                "This pin is a {kind}; remove it, and set another.",
                kind=before.kind,
            ),
        )
    left_out = _PIN_MAY_KEEP - form.model_fields_set
    form = form.model_copy(update={name: getattr(before, name) for name in left_out})
    perform(_place_pin(station, pin_id, form))
    return _pin_or_404(station, pin_id)


@router.delete("/pins/{pin_id}", status_code=204)
def remove_pin(pin_id: Id, station: Station, perform: Perform) -> None:
    """Remove a pin; all trails are then as if it had never been set."""
    pins = station.picture().pins
    if not any(pin_id in (one.pin_id, one.pin_id.partition(":")[0]) for one in pins):
        raise Problem(404, _NO_PIN)
    perform(RemovePin(pin_id))


@router.get("/beacons")
def list_beacons(station: Station, _: Viewer) -> list[BeaconView]:
    return list(station.picture().beacons)


@router.put("/beacons/{beacon_id}")
def place_beacon(beacon_id: Id, form: BeaconForm, station: Station, perform: Perform) -> BeaconView:
    """Set or change the place of a beacon or tag; fields that are left out keep their values."""
    before = _beacon(station, beacon_id)
    if before is not None:
        left_out = _BEACON_MAY_KEEP - form.model_fields_set
        form = form.model_copy(update={name: getattr(before, name) for name in left_out})
    named = site_incident_id(station, form.incident_id)
    perform(PlaceBeacon(beacon_id, **form.model_dump() | {"incident_id": named}))
    placed = _beacon(station, beacon_id)
    if placed is None:  # another user has just removed it
        raise Problem(404, _NO_BEACON)
    return placed


@router.delete("/beacons/{beacon_id}", status_code=204)
def remove_beacon(beacon_id: Id, station: Station, perform: Perform) -> None:
    if _beacon(station, beacon_id) is None:
        raise Problem(404, _NO_BEACON)
    perform(RemoveBeacon(beacon_id))


def _place_pin(station: Services, pin_id: str, form: PinForm) -> SetPin:
    fields = form.model_dump(exclude={"t_ms", "unit_id"})
    return SetPin(pin_id, form.unit_id, _time(station, form.t_ms), **fields)


def _beacon(station: Services, beacon_id: str) -> BeaconView | None:
    return next((one for one in station.picture().beacons if one.beacon_id == beacon_id), None)


def _time(station: Services, t_ms: int | None) -> int:
    return station.clock.utc_ns() if t_ms is None else t_ms * NS_PER_MS


def _pin_or_404(station: Services, pin_id: str) -> PinView:
    for view in station.picture().pins:
        if view.pin_id == pin_id:
            return view
    raise Problem(404, _NO_PIN)
