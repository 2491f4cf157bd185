"""The site: the building's plan, and where on the Earth it stands."""

from __future__ import annotations

import math
from typing import Annotated

import msgspec
from fastapi import APIRouter, Depends, Request, Response
from pydantic import Field

from base_station.api.authentication import Viewer
from base_station.api.current_tables import CurrentStation
from base_station.api.document import file_response
from base_station.api.forms import MAX_UPLOAD_BYTES, Form, Id
from base_station.api.idempotent_request import Perform
from base_station.api.problems import Problem
from base_station.api.request_incident import site_incident_id
from base_station.api.routes.incidents import incident_or_404
from base_station.api.services import Services, Station
from base_station.api.uploads import UploadRoute
from base_station.views.station import anchor_view
from base_station.views.wire import AnchorView
from shared.coded_text import coded, text_of_error
from shared.errors import UserError
from shared.messages.station import SetAnchor, SetPlan

router = APIRouter(tags=["site"], route_class=UploadRoute)


class AnchorForm(Form):
    """Origin of the incident frame (WGS-84) and the true heading of the plan's north."""

    lat_deg: Annotated[float, Field(ge=-90.0, le=90.0)]
    lon_deg: Annotated[float, Field(ge=-180.0, le=180.0)]
    height_m: Annotated[float, Field(ge=-1000.0, le=10_000.0)] = 0.0
    plan_rotation_rad: Annotated[float, Field(ge=-2 * math.pi, le=2 * math.pi)] = 0.0


async def _json_body(request: Request) -> bytes:
    """The body as it came: parsing a plan of 11 MB in the event loop would stop all consoles for a
    second.
    """
    body = await request.body()
    kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if kind not in _PLAN_CONTENT:
        raise Problem(400, _SEND_JSON)
    return body


_PlanBody = Annotated[bytes, Depends(_json_body)]
_SEND_JSON = coded(
    "plan-not-sent-as-json",
    "send one JSON object as the body, with the header Content-Type: application/json",
)
_PLAN_CONTENT = {
    media_type: {"schema": {"type": "object", "title": "Plan", "required": ["type", "muster"]}}
    for media_type in ("application/geo+json", "application/json")
}


@router.get("/site/anchor")
def get_anchor(
    station: CurrentStation, _: Viewer, incident_id: Id | None = None
) -> AnchorView | None:
    """The anchor of an incident's site, or of the station's own."""
    anchor = station.records.anchor(site_id=_site_id(station, incident_id))
    return None if anchor is None else anchor_view(anchor)


@router.put("/site/anchor", status_code=204)
def set_anchor(
    form: AnchorForm, station: Station, perform: Perform, incident_id: Id | None = None
) -> None:
    """Set the anchor of a site.  ``incident_id`` names the incident whose site it is; it may be
    left out if one incident is open, or none.
    """
    named = site_incident_id(station, incident_id)
    perform(SetAnchor(**form.model_dump(), incident_id=named))


@router.get("/site/plan", response_class=Response, responses=file_response("application/geo+json"))
def get_plan(station: CurrentStation, _: Viewer, incident_id: Id | None = None) -> Response:
    """The plan of an incident's site, or of the station's own."""
    geojson = station.records.plan(site_id=_site_id(station, incident_id))
    if geojson is None:
        raise Problem(404, coded("plan-none", "There is no plan."))
    return Response(geojson, media_type="application/geo+json")


@router.put(
    "/site/plan",
    status_code=204,
    max_body_size=MAX_UPLOAD_BYTES,
    openapi_extra={"requestBody": {"required": True, "content": _PLAN_CONTENT}},
)
def set_plan(
    perform: Perform, station: Station, plan: _PlanBody, incident_id: Id | None = None
) -> None:
    """Set the plan of a site: GeoJSON (RFC 7946) in site metres, of which the documentation of
    messages shows an example.  It is checked whole; a feature that cannot be used is named in the
    problem (422). ``incident_id`` names the incident whose site it is; it may be left out if one
    incident is open, or none.
    """
    named = site_incident_id(station, incident_id)
    if not _is_object(plan):
        raise Problem(400, _SEND_JSON)
    try:
        station.plans.check(plan)
    except UserError as error:
        raise Problem(422, text_of_error(error)) from error
    perform(SetPlan(plan, named))


def _site_id(station: Services, incident_id: str | None) -> str:
    return "" if incident_id is None else incident_or_404(station, incident_id).site_id


def _is_object(body: bytes) -> bool:
    """True if the body is JSON and begins as an object does; its content is checked later."""
    try:
        return bytes(msgspec.json.decode(body, type=msgspec.Raw)).lstrip().startswith(b"{")
    except (msgspec.DecodeError, UnicodeDecodeError):
        return False
