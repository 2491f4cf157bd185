"""The site: the building's plan, and where on the Earth it stands."""

from __future__ import annotations

import math
from typing import Annotated, Any

import msgspec
from fastapi import APIRouter, Response
from pydantic import Field

from base_station.api.acting import Act
from base_station.api.forms import MOST_UPLOADED_BYTES, Form
from base_station.api.problems import Problem
from base_station.api.security import AfterLogin, Viewer
from base_station.api.services import Station
from base_station.site.plan import read_plan, require_floors
from base_station.views.station import anchor_view
from base_station.views.wire import AnchorView
from shared.errors import UserError
from shared.messages.station import SetAnchor, SetPlan

router = APIRouter(tags=["site"], route_class=AfterLogin)


class AnchorForm(Form):
    """The incident frame's origin (WGS-84) and the true heading of the plan's north."""

    lat_deg: Annotated[float, Field(ge=-90.0, le=90.0)]
    lon_deg: Annotated[float, Field(ge=-180.0, le=180.0)]
    height_m: Annotated[float, Field(ge=-1000.0, le=10_000.0)] = 0.0
    plan_rotation_rad: Annotated[float, Field(ge=-2 * math.pi, le=2 * math.pi)] = 0.0


@router.get("/site/anchor")
def get_anchor(station: Station, _: Viewer) -> AnchorView | None:
    anchor = station.records.anchor()
    return None if anchor is None else anchor_view(anchor)


@router.put("/site/anchor", status_code=204)
def set_anchor(form: AnchorForm, act: Act) -> None:
    act(SetAnchor(**form.model_dump()))


@router.get("/site/plan", response_class=Response)
def get_plan(station: Station, _: Viewer) -> Response:
    geojson = station.records.plan()
    if geojson is None:
        raise Problem(404, "There is no plan.")
    return Response(geojson, media_type="application/geo+json")


@router.put("/site/plan", status_code=204, max_body_size=MOST_UPLOADED_BYTES)
def set_plan(plan: dict[str, Any], act: Act) -> None:
    """GeoJSON in site metres; the documentation of messages shows one."""
    try:
        geojson = msgspec.json.encode(plan)
        require_floors(read_plan(geojson))
    except (UserError, ValueError, OverflowError) as error:
        raise Problem(422, str(error)) from error
    act(SetPlan(geojson))
