"""Metrics for Prometheus."""

from __future__ import annotations

from fastapi import APIRouter, Response

from base_station.api.authentication import Viewer
from base_station.api.services import Station

router = APIRouter(tags=["health"])

TEXT_FORMAT = "text/plain; version=0.0.4; charset=utf-8"


@router.get("/metrics", response_class=Response, responses={200: {"content": {"text/plain": {}}}})
def get_metrics(station: Station, _: Viewer) -> Response:
    """Metrics of the station in Prometheus' text format."""
    # A fifth of a second of a start, which a station without Prometheus does without.
    from base_station.api.metrics import exposition  # noqa: PLC0415

    hub = station.hub
    text = exposition(station.picture(), hub.position_ages, consoles=hub.watchers)
    return Response(text, media_type=TEXT_FORMAT)
