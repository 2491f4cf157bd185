"""How the station itself is."""

from __future__ import annotations

from fastapi import APIRouter
from pydantic import BaseModel

from base_station.api.forms import to_ms
from base_station.api.problems import Problem
from base_station.api.security import Viewer
from base_station.api.services import Station

router = APIRouter(tags=["health"])


class Segment(BaseModel):
    name: str
    first_ms: int
    last_ms: int
    messages: int
    size_bytes: int
    note: str  # what recovery had to say


class Health(BaseModel):
    problems: list[str]
    messages: int
    undecodable: int
    unknown_units: int
    log_bytes: int
    disk_free_bytes: int
    messages_per_s: float
    repeated: int
    insecure: bool
    consoles: int
    segments: list[Segment]


@router.get("/health")
def get_health(station: Station, _: Viewer) -> Health:
    view = station.hub.health
    if view is None:
        raise Problem(503, "The station has just started; ask again in a second.")
    return Health(
        problems=list(view.problems),
        messages=view.messages,
        undecodable=view.undecodable,
        unknown_units=view.unknown_units,
        log_bytes=view.log_bytes,
        disk_free_bytes=view.disk_free_bytes,
        messages_per_s=view.messages_per_s,
        repeated=view.repeated,
        insecure=view.insecure,
        consoles=station.hub.watchers,
        segments=[
            Segment(
                name=segment.name,
                first_ms=to_ms(segment.first_ns),
                last_ms=to_ms(segment.last_ns),
                messages=segment.messages,
                size_bytes=segment.size_bytes,
                note=segment.note,
            )
            for segment in station.records.segments()
        ],
    )
