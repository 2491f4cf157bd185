"""A picture of the ground about the site, given by an administrator; no map server is used."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Body, Query, Response
from pydantic import BaseModel

from base_station.api.authentication import Administrator, Viewer
from base_station.api.document import file_response
from base_station.api.forms import MAX_UPLOAD_BYTES, Id
from base_station.api.images import normalize_map
from base_station.api.problems import Problem
from base_station.api.services import Station
from base_station.api.uploads import UploadRoute
from base_station.site.base_map import DEGREES, Corners, corners_of
from shared.coded_text import coded

router = APIRouter(tags=["site"], route_class=UploadRoute)

LatLon = tuple[float, float]


class BaseMapAnswer(BaseModel):
    """Three corners of the picture, in degrees (WGS-84)."""

    image_url: str
    upper_left: LatLon
    upper_right: LatLon
    lower_left: LatLon


@router.get("/site/base-map")
def get_base_map(station: Station, _: Viewer) -> BaseMapAnswer | None:
    found = station.base_maps.corners()
    return None if found is None else _view(*found)


@router.put("/site/base-map", max_body_size=MAX_UPLOAD_BYTES)
def set_base_map(
    image: Annotated[bytes, Body(media_type="image/png")],
    world: Annotated[list[float], Query(min_length=6, max_length=6)],
    station: Station,
    who: Administrator,
    crs: Annotated[str, Query(max_length=20)] = DEGREES,
) -> BaseMapAnswer:
    """Set the picture below the plan: PNG, JPEG or WebP, stored without its metadata.  ``world``:
    the numbers of its world file, in the order of its lines; ``crs``: EPSG number of the grid in
    which they are.
    """
    with station.image_lock:
        webp, image_hash, (width_px, height_px), smaller = normalize_map(image)
    a, d, b, e, c, f = world
    half = 0.5 * (smaller - 1.0)  # the middle of a larger pixel
    moved = [*(smaller * value for value in (a, d, b, e)), c + half * (a + b), f + half * (d + e)]
    corners = corners_of(moved, crs, width_px, height_px)
    station.base_maps.put(webp, image_hash, corners)
    station.records.audit(who.username, "SetBaseMap", image_hash)
    return _view(image_hash, corners)


@router.delete("/site/base-map", status_code=204)
def remove_base_map(station: Station, who: Administrator) -> None:
    if not station.base_maps.remove():
        raise Problem(404, coded("base-map-none", "There is no base map."))
    station.records.audit(who.username, "RemovedBaseMap", "")


@router.get(
    "/site/base-map/{image_hash}", response_class=Response, responses=file_response("image/webp")
)
def get_base_map_image(image_hash: Id, station: Station, _: Viewer) -> Response:
    webp = station.base_maps.image(image_hash)
    if webp is None:
        raise Problem(404, coded("base-map-unknown", "There is no such base map."))
    # The address changes with the picture; only this browser may keep it.
    headers = {"Cache-Control": "private, max-age=86400", "ETag": f'"{image_hash}"'}
    return Response(webp, media_type="image/webp", headers=headers)


def _view(image_hash: str, corners: Corners) -> BaseMapAnswer:
    return BaseMapAnswer(
        image_url=f"/api/v1/site/base-map/{image_hash}",
        upper_left=corners.upper_left,
        upper_right=corners.upper_right,
        lower_left=corners.lower_left,
    )
