"""Replays of past incidents, and their controls.

A replay belongs to the user who began it: no other user can move it.  The one that a station was
started for belongs to all.
"""

from __future__ import annotations

import asyncio
from typing import Annotated

import msgspec
from fastapi import APIRouter, Request
from pydantic import Field

from base_station.accounts.principals import Principal, Role
from base_station.api.authentication import Viewer
from base_station.api.current_tables import CurrentStation
from base_station.api.forms import MAX_TIME_MS, Form, Id, PersonIdText
from base_station.api.problems import Problem
from base_station.api.replays import OpenReplay
from base_station.api.routes.incidents import incident_or_404
from base_station.api.services import Services, Station
from base_station.replay.session import FASTEST, SLOWEST
from base_station.views.wire import ReplayView
from shared.clock import NS_PER_MS
from shared.coded_text import coded

router = APIRouter(tags=["replays"])

_NO_REPLAY = coded("replay-gone", "There is no such replay; it may have ended.")
Speed = Annotated[float, Field(ge=SLOWEST, le=FASTEST)]


class NewReplay(Form):
    incident_id: PersonIdText
    speed: Speed = 1.0


class ReplayChange(Form):
    """Changes of a replay, applied in this order: position in time, speed, whether it plays."""

    at_ms: Annotated[int, Field(ge=0, le=MAX_TIME_MS)] | None = None
    speed: Speed | None = None
    playing: bool | None = None


class Replay(ReplayView, frozen=True, kw_only=True):
    replay_id: str
    begun_by: str  # a user; empty: the station, for all


@router.get("/replays")
def list_replays(station: Station, _: Viewer) -> list[Replay]:
    return [_replay(replay) for replay in station.replays.all()]


@router.post("/replays", status_code=201)
def start_replay(new: NewReplay, station: CurrentStation, who: Viewer, request: Request) -> Replay:
    """Start a replay of an incident, which plays from its beginning.  It ends by itself when no
    console shows it any more.
    """
    loop: asyncio.AbstractEventLoop = request.app.state.loop
    incident = incident_or_404(station, new.incident_id)
    opened = station.replays.open(incident, new.speed, loop, who.username)
    station.records.audit(who.username, "StartedReplay", new.incident_id)
    return _replay(opened)


@router.get("/replays/{replay_id}")
def get_replay(replay_id: Id, station: Station, _: Viewer) -> Replay:
    return _replay(_replay_or_404(station, replay_id))


@router.post("/replays/{replay_id}", status_code=204)
def change_replay(replay_id: Id, change: ReplayChange, station: Station, who: Viewer) -> None:
    replay = _replay_or_404(station, replay_id)
    if replay.begun_by and not _is_own(replay, who):
        raise Problem(
            403,
            coded(
                "replay-of-another",
                "This replay is {by}'s; begin one of your own.",
                by=replay.begun_by,
            ),
        )
    player = replay.player
    if change.at_ms is not None:
        player.seek(change.at_ms * NS_PER_MS)
    if change.speed is not None:
        player.set_speed(change.speed)
    if change.playing is not None:
        (player.play if change.playing else player.pause)()


@router.delete("/replays/{replay_id}", status_code=204)
def end_replay(replay_id: Id, station: Station, who: Viewer) -> None:
    """End a replay of one's own.  A commander may end the replays of others, but not the one for
    which a station was started.
    """
    replay = _replay_or_404(station, replay_id)
    if replay.persistent:
        raise Problem(
            403,
            coded(
                "replay-for-all", "This replay is for all; it ends with the command that shows it."
            ),
        )
    if not _is_own(replay, who):
        if who.role < Role.COMMANDER:
            raise Problem(
                403,
                coded(
                    "replay-ended-by-commander",
                    "This replay is {by}'s; a commander may end it.",
                    by=replay.begun_by,
                ),
            )
        details = f"{replay.player.view().incident_id} of {replay.begun_by}"
        station.records.audit(who.username, "EndedReplay", details)
    if not station.replays.close(replay_id):
        raise Problem(404, _NO_REPLAY)


def _is_own(replay: OpenReplay, who: Principal) -> bool:
    return replay.begun_by == who.username


def _replay_or_404(station: Services, replay_id: str) -> OpenReplay:
    replay = station.replays.get(replay_id)
    if replay is None:
        raise Problem(404, _NO_REPLAY)
    return replay


def _replay(replay: OpenReplay) -> Replay:
    view = msgspec.structs.asdict(replay.player.view())
    return Replay(**view, replay_id=replay.replay_id, begun_by=replay.begun_by)
