"""How good an incident's positions were, said by the station itself."""

from __future__ import annotations

import msgspec
from fastapi import APIRouter, Response
from pydantic import BaseModel

from base_station.api.forms import Id
from base_station.api.routes.incidents import incident_or_404
from base_station.api.routes.trails import hindsight_of
from base_station.api.security import Viewer
from base_station.api.services import Station
from base_station.assessment.report import with_people
from base_station.assessment.wearers import wearers

router = APIRouter(tags=["incidents"])


class Figures(BaseModel):
    """ISO/IEC 18305: circular, vertical and spherical error in metres."""

    ce50_m: float
    ce95_m: float
    ve50_m: float
    ve95_m: float
    se50_m: float
    se95_m: float


class PinResidual(BaseModel):
    pin_id: str
    note: str
    used: bool
    shown_m: float | None
    trail_m: float
    sigmas: float
    floor_right: bool | None


class TrustSeconds(BaseModel):
    """For how long the light was which, and why it was not green."""

    green_s: float
    amber_s: float
    red_s: float
    causes: list[tuple[str, float]]


class UnitAssessment(BaseModel):
    unit_id: str
    people: list[str]
    seconds: float
    walked_m: float
    stated: Figures | None
    against_smoothed: Figures | None
    floor_probability: float | None
    floor_right: float | None
    trust: TrustSeconds
    pin_residuals: list[PinResidual]
    loop_closure_m: float | None
    loop_closure_percent: float | None
    reentry_jumps_m: list[float]


class Assessment(BaseModel):
    incident_id: str
    smoother: str
    made_ms: int
    units: list[UnitAssessment]
    stated: Figures | None
    against_smoothed: Figures | None


@router.get("/incidents/{incident_id}/assessment", response_model=Assessment)
def assess_incident(incident_id: Id, station: Station, _: Viewer) -> Response:
    """What was promised at the time, and how it stands up to what is known afterwards."""
    incident = incident_or_404(station, incident_id)
    live = station.records.tracks_of(incident)
    report = hindsight_of(station).assess(incident, live)
    report = with_people(report, wearers(station.roster, incident))
    return Response(msgspec.json.encode(report), media_type="application/json")
