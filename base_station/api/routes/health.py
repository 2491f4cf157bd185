"""Health of the station itself."""

from __future__ import annotations

import msgspec
from fastapi import APIRouter

from base_station.api.authentication import Viewer
from base_station.api.problems import Problem
from base_station.api.services import Station
from base_station.views.answer import Answer, to_ms
from base_station.views.wire import HealthView
from shared.coded_text import coded

router = APIRouter(tags=["health"])


class LogSegmentAnswer(Answer, frozen=True):
    """A file of the log."""

    name: str
    first_ms: int
    last_ms: int
    messages: int
    size_bytes: int
    note: str  # of its recovery


class Health(HealthView, frozen=True, kw_only=True):
    """Health as the consoles show it, with the number of consoles and the segments of the log."""

    consoles: int
    segments: tuple[LogSegmentAnswer, ...]


@router.get("/health")
def get_health(station: Station, _: Viewer) -> Health:
    view = station.hub.health
    if view is None:
        raise Problem(
            503,
            coded("station-just-started", "The station has just started; ask again in a second."),
        )
    return Health(
        **msgspec.structs.asdict(view),
        consoles=station.hub.watchers,
        segments=tuple(
            LogSegmentAnswer(
                segment.name,
                to_ms(segment.first_ns),
                to_ms(segment.last_ns),
                segment.messages,
                segment.size_bytes,
                segment.note,
            )
            for segment in station.records.segments()
        ),
    )
