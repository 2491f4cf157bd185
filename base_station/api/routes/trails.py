"""Trails of units: raw, as they were shown, and post-processed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, cast

import msgspec
from fastapi import APIRouter, Query, Response

from base_station.api.authentication import Viewer
from base_station.api.current_tables import CurrentStation
from base_station.api.forms import Id
from base_station.api.problems import Problem
from base_station.api.routes.incidents import incident_or_404
from base_station.api.services import Services
from base_station.replay.post_processing import PostProcessor
from base_station.replay.solved_tracks import Tracks
from base_station.replay.trail_kind import TrailKind
from base_station.storage.db import models
from base_station.storage.db.records import TrackSample
from base_station.views.answer import Answer, to_ms
from shared.clock import NS_PER_S
from shared.coded_text import coded

router = APIRouter(tags=["tracks"])

EverySeconds = Annotated[int, Query(ge=1, le=3600)]


Point = tuple[int, float, float, int | None]  # t_ms, north_m, east_m, floor


class TrailAnswer(Answer, frozen=True):
    unit_id: str
    points: tuple[Point, ...]


class Trails(Answer, frozen=True):
    incident_id: str
    kind: TrailKind
    made_ms: int  # when it was worked out
    is_newest: bool  # False: a journal is being read, and the trail is solved again soon
    trails: tuple[TrailAnswer, ...]


@router.get("/incidents/{incident_id}/trails", response_model=Trails)
def incident_trails(
    incident_id: Id,
    station: CurrentStation,
    _: Viewer,
    kind: TrailKind = TrailKind.FUSED,
    every_s: EverySeconds = 1,
) -> Response:
    """Trails of all units that moved.  Smoothed trails of an open incident are those known now."""
    incident = incident_or_404(station, incident_id)
    made_ns, tracks = trails_of(station, incident, kind)
    body = Trails(
        incident_id,
        kind,
        to_ms(made_ns),
        kind is TrailKind.FUSED or hindsight_of(station).is_newest(incident),
        tuple(
            _encoded(TrailAnswer(unit_id, _points(tracks[unit_id], every_s))) for unit_id in tracks
        ),
    )
    return Response(msgspec.json.encode(body), media_type="application/json")


def _encoded(trail: TrailAnswer) -> TrailAnswer:
    """Encode trails as they are read, as the points of all units together are large."""
    return cast("TrailAnswer", msgspec.Raw(msgspec.json.encode(trail)))


def hindsight_of(station: Services) -> PostProcessor:
    if station.post_processor is None:
        raise Problem(503, coded("trails-no-log", "This station has no log to work it out from."))
    return station.post_processor


def trails_of(
    station: Services, incident: models.IncidentRow, kind: TrailKind
) -> tuple[int, Tracks]:
    """Time at which the trails were computed, and the trails by unit."""
    if kind is TrailKind.SMOOTHED:
        smoothed = hindsight_of(station).smoothed(incident)
        return smoothed.made_ns, smoothed.tracks
    if kind is TrailKind.RAW:
        return station.clock.utc_ns(), hindsight_of(station).raw(incident)
    return station.clock.utc_ns(), station.records.tracks_of(incident)


def _points(track: Sequence[TrackSample], every_s: int) -> tuple[Point, ...]:
    """Keep the first point of every ``every_s`` seconds."""
    points: list[Point] = []
    last_s = -1
    for sample in track:
        bucket = sample.t_ns // (every_s * NS_PER_S)
        if bucket != last_s:
            last_s = bucket
            place = round(sample.north_m, 2), round(sample.east_m, 2)
            points.append((to_ms(sample.t_ns), *place, sample.floor))
    return tuple(points)
