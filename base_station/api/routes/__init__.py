"""The API's routes: one file a resource, all in ``ROUTERS``."""

from __future__ import annotations

from fastapi import APIRouter

from base_station.api.routes import (
    accountability,
    alarms,
    assessment,
    assignments,
    audit,
    base_map,
    commands,
    exports,
    forgetting,
    health,
    incidents,
    live,
    login,
    people,
    pins,
    recordings,
    replays,
    site,
    standby,
    tokens,
    tracks,
    trails,
    units,
    users,
)

ROUTERS: tuple[APIRouter, ...] = (
    login.router,
    users.router,
    tokens.router,
    people.router,
    units.router,
    assignments.router,
    incidents.router,
    tracks.router,
    trails.router,
    assessment.router,
    alarms.router,
    commands.router,
    accountability.router,
    site.router,
    base_map.router,
    pins.router,
    replays.router,
    recordings.router,
    exports.router,
    forgetting.router,
    health.router,
    audit.router,
    standby.router,
    live.router,
)
