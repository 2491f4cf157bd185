"""Drawings of buildings from elsewhere, read as drafts of plans; the station keeps none of them."""

from __future__ import annotations

from typing import Annotated, Any

import msgspec
from fastapi import APIRouter, Body, Depends, Query
from pydantic import BaseModel

from base_station.api.authentication import Commander
from base_station.api.forms import MAX_UPLOAD_BYTES, ShortText
from base_station.api.problems import Problem
from base_station.api.services import Station
from base_station.api.uploads import UploadRoute
from base_station.drawings.draft import LengthUnit, Options
from base_station.drawings.process import draft_of
from shared.coded_text import text_of_error
from shared.errors import UserError

router = APIRouter(tags=["site"], route_class=UploadRoute)


class DrawnPictureAnswer(BaseModel):
    webp: str
    width_px: int
    height_px: int


class TextCodeAnswer(BaseModel):
    code: str
    texts: dict[str, str]
    numbers: dict[str, float]


class PlanDraft(BaseModel):
    picture: DrawnPictureAnswer | None
    plan: dict[str, Any] | None
    lat_deg: float | None
    lon_deg: float | None
    plan_rotation_rad: float
    is_place_surveyed: bool
    pages: int
    notes: list[str]
    note_codes: list[TextCodeAnswer]


def _options(
    name: ShortText = "",
    page: Annotated[int, Query(ge=1, le=10_000)] = 1,
    unit: LengthUnit | None = None,
) -> Options:
    return Options(name, page, unit)


@router.post("/site/drafts", max_body_size=MAX_UPLOAD_BYTES)
def draft_plan(
    drawing: Annotated[bytes, Body(media_type="application/octet-stream")],
    station: Station,
    _: Commander,
    options: Annotated[Options, Depends(_options)],
) -> PlanDraft:
    """Make the draft of a plan from a drawing: a picture that is to be scaled, or a plan that can
    be set.
    """
    try:
        with station.image_lock:
            draft = draft_of(drawing, options)
    except UserError as error:
        raise Problem(422, text_of_error(error)) from error
    return PlanDraft.model_validate(msgspec.to_builtins(draft))
