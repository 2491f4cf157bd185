"""Guidance of rescuers: the next legs of their ways, sent to their units as they advance.

Pieces are messages as any other: each waits for the link, asks for an acknowledgement, is in the
log, and expires soon, as the next one takes its place.  Guidance is kept in memory only: after a
restart, or at the station that takes over, it is begun again from the console.
"""

from __future__ import annotations

import logging
import uuid
from collections.abc import Callable
from threading import Lock
from typing import Annotated

import msgspec
from fastapi import Depends
from starlette.requests import HTTPConnection

from base_station.api.problems import Problem
from base_station.api.route_answers import RouteAnswer, find_routes
from base_station.api.services import Services
from base_station.views.wire import Snapshot
from shared.coded_text import coded
from shared.errors import MusterError
from shared.messages import CommandKind
from shared.messages.station import SendCommand

STEP_S = 2.0  # a rescuer walks two metres in it
PIECE_LASTS_S = 120.0
MOST_GUIDES = 50

Send = Callable[[SendCommand], object]

log = logging.getLogger(__name__)


class Guide(msgspec.Struct):
    """One rescuer on the way to one member."""

    rescuer_id: str
    unit_id: str
    by: str
    incident_id: str
    has_alarm: bool  # of the member: with its end the guidance is over
    text: str = ""
    sent_ns: int = 0
    manoeuvre: object = None  # in the piece of text
    pending: object = None  # another one, as of the last look


class Guidance:
    """Rescuers who are guided now.  Thread-safe."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._guides: dict[str, Guide] = {}  # by rescuer

    def guides(self) -> list[Guide]:
        with self._lock:
            return list(self._guides.values())

    def begin(self, station: Services, by: str, unit_id: str, rescuer_id: str, send: Send) -> Guide:
        """Begin a guidance and send its first piece.  Problem if a unit is not known or has no
        position.
        """
        route = find_routes(station, unit_id, rescuer_id)[0]
        snapshot = station.picture()
        has_alarm = bool(_open_alarms(snapshot, unit_id))
        guide = Guide(rescuer_id, unit_id, by, _incident_id(snapshot), has_alarm)
        with self._lock:
            if len(self._guides) >= MOST_GUIDES and rescuer_id not in self._guides:
                raise Problem(
                    409,
                    coded(
                        "guides-too-many",
                        "{most} rescuers are guided; end some first.",
                        most=MOST_GUIDES,
                    ),
                )
        _send_piece(station, snapshot, guide, route, send)
        with self._lock:
            self._guides[rescuer_id] = guide
        return guide

    def end(self, station: Services, rescuer_id: str, send: Send) -> bool:
        """Notify the rescuer's unit that the guidance has ended.  False if there was none."""
        with self._lock:
            guide = self._guides.pop(rescuer_id, None)
        if guide is None:
            return False
        name = _name(station.picture(), guide.unit_id)
        send(_message(rescuer_id, f"Way to {name}: ended"))
        return True

    def step(self, station: Services) -> None:
        """Review all guidances once: send a new manoeuvre that two reviews in a row have found, and
        remove those that are no longer needed.
        """
        guides = self.guides()
        if not guides:
            return
        snapshot = station.picture()
        for guide in guides:
            if not _is_still_needed(station, snapshot, guide):
                with self._lock:
                    if self._guides.get(guide.rescuer_id) is guide:
                        del self._guides[guide.rescuer_id]
                continue
            try:
                _advance(station, snapshot, guide)
            except (Problem, MusterError) as error:
                log.warning("guidance of %s: %s", guide.rescuer_id, error)


def guidance_of(connection: HTTPConnection) -> Guidance:
    guidance: Guidance = connection.app.state.guidance
    return guidance


Guiding = Annotated[Guidance, Depends(guidance_of)]


def _advance(station: Services, snapshot: Snapshot, guide: Guide) -> None:
    """The guide after a review.  As positions fluctuate, a new manoeuvre is sent only once two
    reviews in a row have found it.
    """
    route = find_routes(station, guide.unit_id, guide.rescuer_id)[0]
    manoeuvre = _manoeuvre(route)
    if manoeuvre == guide.manoeuvre:
        guide.pending = None
    elif manoeuvre != guide.pending:
        guide.pending = manoeuvre
    else:
        by = guide.by
        _send_piece(station, snapshot, guide, route, lambda action: station.perform(by, action))


def _send_piece(
    station: Services, snapshot: Snapshot, guide: Guide, route: RouteAnswer, send: Send
) -> None:
    text = f"Way to {_name(snapshot, guide.unit_id)}: {route.next_text}"
    if route.known and len(route.legs) > 1:
        text += f"; {round(route.distance_m)} m in all"
    send(_message(guide.rescuer_id, text))
    guide.text, guide.sent_ns = text, station.clock.utc_ns()
    guide.manoeuvre, guide.pending = _manoeuvre(route), None


def _message(unit_id: str, text: str) -> SendCommand:
    return SendCommand(
        command_id=uuid.uuid4().hex,
        kind=CommandKind.TEXT,
        unit_id=unit_id,
        crew="",
        everyone=False,
        text=text,
        position_rate_hz=0.0,
        lasts_s=PIECE_LASTS_S,
    )


def _manoeuvre(route: RouteAnswer) -> object:
    """Manoeuvre at the end of the present leg, and the number of legs left."""
    following = [(leg.turn, leg.floors) for leg in route.legs[1:2]]
    climbed = [leg.floors for leg in route.legs[:1]]
    return route.known, len(route.legs), climbed, following


def _is_still_needed(station: Services, snapshot: Snapshot, guide: Guide) -> bool:
    """False once the alarms are resolved, the incident is closed or another station leads."""
    if station.ha_status is not None and station.ha_status.refusal() is not None:
        return False
    if _incident_id(snapshot) != guide.incident_id:
        return False
    is_down = bool(_open_alarms(snapshot, guide.unit_id))
    return is_down or not guide.has_alarm


def _open_alarms(snapshot: Snapshot, unit_id: str) -> tuple[str, ...]:
    return next((unit.alarms for unit in snapshot.units if unit.unit_id == unit_id), ())


def _incident_id(snapshot: Snapshot) -> str:
    incident = snapshot.incident
    return "" if incident is None or incident.closed_ms is not None else incident.incident_id


def _name(snapshot: Snapshot, unit_id: str) -> str:
    unit = next((one for one in snapshot.units if one.unit_id == unit_id), None)
    if unit is None:
        return unit_id
    return unit.person.name if unit.person else unit.label or unit_id
