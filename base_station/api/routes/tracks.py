"""Tracks of units: one point a second, or fewer."""

from __future__ import annotations

from typing import Annotated

import msgspec
from fastapi import APIRouter, Depends, Query, Response
from starlette.concurrency import run_in_threadpool

from base_station.api.authentication import Viewer
from base_station.api.current_tables import CurrentStation
from base_station.api.forms import Id, UnitId, window
from base_station.api.routes.incidents import incident_or_404
from base_station.api.services import Services
from base_station.storage.db.records import TrackSample
from base_station.storage.db.window import Window
from base_station.views.answer import Answer, to_ms

router = APIRouter(tags=["tracks"])

EverySeconds = Annotated[int, Query(ge=1, le=3600)]


class TrackPointAnswer(Answer, frozen=True):
    """Point of a track, in metres north, east and down from the site's anchor."""

    t_ms: int
    north_m: float
    east_m: float
    down_m: float
    std_north_m: float
    std_east_m: float
    std_down_m: float
    heading_rad: float
    floor: int | None
    quality: str


class Track(Answer, frozen=True):
    unit_id: str
    points: tuple[TrackPointAnswer, ...]


@router.get("/units/{unit_id}/track", response_model=Track)
def unit_track(
    unit_id: UnitId,
    station: CurrentStation,
    _: Viewer,
    when: Annotated[Window, Depends(window)],
    every_s: EverySeconds = 1,
) -> Response:
    return _json(_track(station, unit_id, when, every_s))


@router.get("/incidents/{incident_id}/tracks", response_model=list[Track])
async def incident_tracks(
    incident_id: Id, station: CurrentStation, _: Viewer, every_s: EverySeconds = 1
) -> Response:
    """Tracks of all units that moved while they were in the open incident."""
    async with station.export_lock:
        return await run_in_threadpool(_incident_tracks, incident_id, station, every_s)


def _incident_tracks(incident_id: str, station: Services, every_s: int) -> Response:
    tracks = station.records.tracks_of(incident_or_404(station, incident_id), every_s)
    return _json([Track(one, tuple(map(_point, points))) for one, points in tracks.items()])


def _track(station: Services, unit_id: str, when: Window, every_s: int) -> Track:
    points = station.records.track(unit_id, when, every_s)
    return Track(unit_id, tuple(map(_point, points)))


def _point(point: TrackSample) -> TrackPointAnswer:
    return TrackPointAnswer(
        t_ms=to_ms(point.t_ns),
        north_m=point.north_m,
        east_m=point.east_m,
        down_m=point.down_m,
        std_north_m=point.std_north_m,
        std_east_m=point.std_east_m,
        std_down_m=point.std_down_m,
        heading_rad=point.heading_rad,
        floor=point.floor,
        quality=point.quality,
    )


def _json(tracks: Track | list[Track]) -> Response:
    """Encode tracks directly to bytes: an hour of a hundred units has 360,000 points."""
    return Response(msgspec.json.encode(tracks), media_type="application/json")
