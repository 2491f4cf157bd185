"""Incidents: named windows of time, opened and closed by the commander."""

from __future__ import annotations

import secrets
from collections.abc import Sequence
from datetime import UTC, datetime
from itertools import pairwise
from typing import Annotated

import msgspec
from fastapi import APIRouter, Depends
from pydantic import BaseModel, Field

from base_station.api.alarm_lives import AlarmWithLife, with_life
from base_station.api.authentication import Viewer
from base_station.api.current_tables import CurrentStation, StationWithActions
from base_station.api.forms import (
    AlarmIdText,
    DispatchNumberOrNone,
    Form,
    Id,
    Limit,
    Name,
    SearchText,
    UnitIdText,
    window,
)
from base_station.api.idempotent_request import Perform
from base_station.api.incident_closing import closing_obstacles
from base_station.api.problems import Problem
from base_station.api.refusals import not_found_if_unknown
from base_station.api.request_incident import open_incident as open_incident_of
from base_station.api.routes.accountability import Seconds
from base_station.api.services import Services, Station
from base_station.core.alarms import ALARMS
from base_station.storage.db import models
from base_station.storage.db.incident_search import IncidentQuery
from base_station.storage.db.roster import Roster
from base_station.storage.db.window import FOREVER_NS, Window
from base_station.views.alarm_parameters import stored_parameters_view
from base_station.views.answer import Answer, to_ms, to_ms_or_none
from base_station.views.station import dispatch_view
from base_station.views.wire import AlarmParametersView, DispatchView
from shared.clock import NS_PER_S
from shared.coded_text import coded
from shared.messages.station import CloseIncident, OpenIncident

router = APIRouter(tags=["incidents"])

MOST_NAMED = 2000

_LEVELS = {rule.name: rule.levels for rule in ALARMS}


class IncidentAnswer(BaseModel):
    incident_id: str
    name: str
    opened_ms: int
    opened_by: str
    closed_ms: int | None
    closed_by: str
    dispatch_number: str  # empty: opened from none
    archived_ms: int | None  # when it was copied to an archive and read there; null: it is in none
    erased_at_ms: int | None  # when retention erases its people; null: never, or it is open


class Raising(Answer, frozen=True):
    """Text of an alarm when it was raised."""

    t_ms: int
    text: str
    code: str  # empty: of an earlier version, there is only the text
    parameters: AlarmParametersView


class PastAlarm(AlarmWithLife, frozen=True, kw_only=True):
    raisings: tuple[Raising, ...]  # in the incident, at first and anew, oldest first


class NewIncident(Form):
    name: Name
    par_interval_s: Seconds | None = None  # None: as the station is configured
    work_limit_s: Seconds | None = None
    dispatch_number: DispatchNumberOrNone = ""  # of the dispatch from which it is opened
    beside_others: bool = False  # although others are open; it has no members then at first


class ClosingForm(Form):
    """Open alarms, and units inside, despite which the incident is to be closed; the user has seen
    these, and no newer ones.
    """

    despite_alarm_ids: Annotated[tuple[AlarmIdText, ...], Field(max_length=MOST_NAMED)] = ()
    despite_unit_ids: Annotated[tuple[UnitIdText, ...], Field(max_length=MOST_NAMED)] = ()


def incident_or_404(station: Services, incident_id: str) -> models.IncidentRow:
    incident = station.records.incident(incident_id)
    if incident is None:
        raise Problem(404, _no_incident(incident_id))
    return incident


def new_incident_id(station: Services) -> str:
    opened = datetime.fromtimestamp(station.clock.utc_ns() / NS_PER_S, UTC)
    return f"{opened:%Y%m%d-%H%M%S}-{secrets.token_hex(2)}"


def _no_incident(incident_id: str) -> str:
    return coded("incident-unknown", "There is no incident {incident}.", incident=incident_id)


def window_of(incident: models.IncidentRow) -> Window:
    return Window(incident.opened_ns, incident.closed_ns or FOREVER_NS)


@router.get("/incidents")
def list_incidents(
    station: CurrentStation,
    _: Viewer,
    when: Annotated[Window, Depends(window)],
    limit: Limit = 100,
    text: SearchText = "",
    person: SearchText = "",
    alarm: SearchText = "",
) -> list[IncidentAnswer]:
    """Incidents that were opened in the window, newest first.

    ``text``, ``person`` and ``alarm`` restrict the list to incidents that match all of them; case
    and accents are ignored.
    """
    query = IncidentQuery(text, person, alarm, when)
    if query.is_plain:
        found = station.records.incidents(when, limit)
    else:
        found = station.records.find_incidents(query, limit)
    archived_ns = station.archived.times_ns([one.incident_id for one in found])
    return [_incident(one, station, archived_ns.get(one.incident_id)) for one in found]


@router.post("/incidents", status_code=201)
def open_incident(new: NewIncident, station: Station, perform: Perform) -> IncidentAnswer:
    incident_id = new_incident_id(station)
    usual = station.accountability
    opening = OpenIncident(
        incident_id,
        new.name,
        new.par_interval_s or usual.par_interval_s,
        new.work_limit_s or usual.work_limit_s,
        new.dispatch_number,
        beside_others=new.beside_others,
    )
    opened_id = perform(opening).created_id
    running = open_incident_of(station, opened_id)
    if running is None:
        return _closed_since(station, opened_id)
    return IncidentAnswer(
        incident_id=running.incident_id,
        name=running.name,
        opened_ms=running.opened_ms,
        opened_by=perform.by,
        closed_ms=None,
        closed_by="",
        dispatch_number=new.dispatch_number,
        archived_ms=None,
        erased_at_ms=None,
    )


@router.get("/incidents/{incident_id}")
def get_incident(incident_id: Id, station: StationWithActions, _: Viewer) -> IncidentAnswer:
    incident = incident_or_404(station, incident_id)
    archived_ns = station.archived.times_ns([incident_id]).get(incident_id)
    return _incident(incident, station, archived_ns)


@router.get("/incidents/{incident_id}/dispatch")
def incident_dispatch(incident_id: Id, station: CurrentStation, _: Viewer) -> DispatchView | None:
    """Newest report of the dispatch from which the incident was opened; null if it was opened
    without one.
    """
    number = incident_or_404(station, incident_id).dispatch_number
    report = station.records.dispatch(number) if number else None
    return None if report is None else dispatch_view(report, station.roster.known)


@router.post("/incidents/{incident_id}/close", status_code=204)
def close_incident(
    incident_id: Id, station: Station, perform: Perform, closing: ClosingForm | None = None
) -> None:
    """Close an incident.  409 if alarms of its units are open or people are inside that ``closing``
    does not name; the problem has all their ids, in members of the same names.  Orders of the
    incident without an answer are withdrawn.
    """
    despite = closing or ClosingForm()
    alarm_ids, unit_ids = despite.despite_alarm_ids, despite.despite_unit_ids
    if open_incident_of(station, incident_id) is not None:
        obstacles = closing_obstacles(station.picture(), incident_id)
        obstacles.require_known(alarm_ids, unit_ids)
    with not_found_if_unknown(
        station,
        _no_incident(incident_id),
        shown=lambda picture: (
            picture.incident is not None and picture.incident.incident_id == incident_id
        ),
        stored=lambda: station.records.incident(incident_id) is not None,
    ):
        perform(CloseIncident(incident_id, alarm_ids, unit_ids))


@router.get("/incidents/{incident_id}/alarms")
def incident_alarms(
    incident_id: Id,
    station: CurrentStation,
    _: Viewer,
    when: Annotated[Window, Depends(window)],
    limit: Limit = 100,
) -> list[PastAlarm]:
    """Alarms that were raised in the window while the incident was open, newest first."""
    incident = incident_or_404(station, incident_id)
    was_open = window_of(incident)
    alarms = station.records.alarms(when.within(was_open), limit, incident)
    lives = station.records.alarm_lives([alarm.alarm_id for alarm in alarms])
    return [_past_alarm(alarm, lives[alarm.alarm_id], was_open, station.roster) for alarm in alarms]


def _closed_since(station: Services, incident_id: str) -> IncidentAnswer:
    """The incident of a request that is repeated after its end: only the tables have it."""
    station.projection.flush()
    incident = station.records.incident(incident_id)
    if incident is None:
        raise Problem(
            503,
            coded(
                "incident-not-stored-yet",
                "The incident was opened, but the database has not taken it yet.",
            ),
        )
    return _incident(incident, station, None)


def _past_alarm(
    alarm: models.AlarmRow,
    life: Sequence[models.AlarmTransition],
    was_open: Window,
    roster: Roster,
) -> PastAlarm:
    levels = _LEVELS.get(alarm.rule, ())
    anew = (now for before, now in pairwise(life) if _is_raised_anew(before, now, levels))
    raisings = tuple(
        Raising(
            to_ms(one.t_ns),
            roster.shown(one.text),
            one.code,
            stored_parameters_view(one.parameters, roster.known),
        )
        for one in (*life[:1], *anew)
        if one.t_ns < was_open.until_ns
    )
    view = with_life(alarm, life, roster)
    return PastAlarm(**msgspec.structs.asdict(view), raisings=raisings)


def _is_raised_anew(
    before: models.AlarmTransition, now: models.AlarmTransition, levels: Sequence[str]
) -> bool:
    """True if the condition occurred again or became worse.  A transition to *raised* may also
    report that an unacknowledged alarm became less severe.
    """
    known = before.level in levels and now.level in levels
    eased = known and levels.index(now.level) < levels.index(before.level)
    return now.state == "raised" and not eased


def _incident(
    incident: models.IncidentRow, station: Services, archived_ns: int | None
) -> IncidentAnswer:
    retention, erased_at_ns = station.retention, None
    if retention is not None and incident.closed_ns is not None:
        erased_at_ns = incident.closed_ns + retention.incident_ns
    return IncidentAnswer(
        incident_id=incident.incident_id,
        name=station.roster.shown(incident.name),
        opened_ms=to_ms(incident.opened_ns),
        opened_by=incident.opened_by,
        closed_ms=to_ms_or_none(incident.closed_ns),
        closed_by=incident.closed_by,
        dispatch_number=incident.dispatch_number,
        archived_ms=to_ms_or_none(archived_ns),
        erased_at_ms=to_ms_or_none(erased_at_ns),
    )
