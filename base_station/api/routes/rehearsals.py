"""Rehearsal of alarm thresholds over an incident that is closed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

from fastapi import APIRouter, Query
from starlette.concurrency import run_in_threadpool

from base_station.api.authentication import Viewer
from base_station.api.current_tables import CurrentStation
from base_station.api.forms import Id, ShortText
from base_station.api.problems import Problem
from base_station.api.routes.incidents import incident_or_404
from base_station.api.services import Services
from base_station.core.alarms import ALARMS
from base_station.core.alarms.thresholds import Thresholds, bounds_of, with_thresholds
from base_station.replay.assessment.wearers import wearers
from base_station.replay.rehearsal.changes import can_be_rehearsed, changes_of, points_of
from base_station.replay.rehearsal.report import RehearsedPoint
from base_station.report.thresholds_in_force import thresholds_in_force
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.window import FOREVER_NS
from base_station.views.answer import Answer
from base_station.views.wire import TextCodeView
from shared.coded_text import coded, text_of_error
from shared.errors import ConfigError, LogError, StoreError, UserError

router = APIRouter(tags=["incidents"])

Changes = Annotated[tuple[ShortText, ...], Query(max_length=40)]


class ThresholdAnswer(Answer, frozen=True):
    """One threshold of an alarm rule."""

    rule: str
    threshold: str
    value: float
    lowest: float
    highest: float


class RehearsalAnswer(Answer, frozen=True):
    """Outcome of a rehearsal over one incident."""

    incident_id: str
    worn_h: float
    live_alarms: dict[str, int]
    swept: str
    points: tuple[RehearsedPoint, ...]
    wearers: dict[str, tuple[str, ...]]
    flaws: tuple[str, ...]
    flaw_codes: tuple[TextCodeView, ...]


@router.get("/incidents/{incident_id}/thresholds")
def incident_thresholds(
    incident_id: Id, station: CurrentStation, _: Viewer
) -> list[ThresholdAnswer]:
    """Thresholds that can be rehearsed, with their values at the end of the incident."""
    incident = incident_or_404(station, incident_id)
    recorded = thresholds_in_force(station.records, incident.closed_ns or FOREVER_NS)
    return [
        ThresholdAnswer(rule.name, name, float(getattr(rule, name)), *bounds)
        for rule in with_thresholds(ALARMS, recorded)
        for name, bounds in bounds_of(rule).items()
        if can_be_rehearsed(name)
    ]


@router.get("/incidents/{incident_id}/rehearsal")
async def rehearse_incident(
    incident_id: Id,
    station: CurrentStation,
    _: Viewer,
    change: Changes = (),
    sweep: ShortText = "",
) -> RehearsalAnswer:
    """Compare the alarms that other thresholds would have raised in a closed incident with those of
    the thresholds of that time.  This takes some seconds for each hour of wear; one rehearsal runs
    at a time.
    """
    incident = await run_in_threadpool(_closed, station, incident_id)
    swept, points = _points(change, sweep)
    async with station.rehearsal_lock:
        return await run_in_threadpool(_rehearse, station, incident, points, swept)


def _closed(station: Services, incident_id: str) -> IncidentRow:
    incident = incident_or_404(station, incident_id)
    if incident.closed_ns is None:
        raise Problem(
            409,
            coded("rehearsal-open", "The incident is open; it can be rehearsed once it is closed."),
        )
    return incident


def _points(change: Sequence[str], sweep: str) -> tuple[str, Sequence[Thresholds]]:
    try:
        return points_of(changes_of(change), sweep)
    except (ConfigError, UserError) as error:
        raise Problem(
            422,
            coded("rehearsal-wrong", "Not rehearsed: {reason}.", reason=text_of_error(error)),
        ) from error


def _rehearse(
    station: Services, incident: IncidentRow, points: Sequence[Thresholds], swept: str
) -> RehearsalAnswer:
    if station.rehearse is None:
        raise Problem(
            503,
            coded(
                "rehearsal-by-terminal",
                "Rehearse it with the terminal: muster base rehearse --incident {incident}.",
                incident=incident.incident_id,
            ),
        )
    try:
        report = station.rehearse(incident, points, swept)
    except (LogError, StoreError) as error:
        raise Problem(
            503,
            coded(
                "rehearsal-none", "There is no rehearsal: {reason}.", reason=text_of_error(error)
            ),
        ) from error
    (rehearsed,) = report.incidents
    worn = wearers(station.roster, incident, station.records.members_of(incident))
    return RehearsalAnswer(
        incident_id=incident.incident_id,
        worn_h=rehearsed.worn_h,
        live_alarms=rehearsed.live_alarms,
        swept=report.swept,
        points=report.points,
        wearers={unit_id: tuple(names) for unit_id, names in worn.items()},
        flaws=report.flaws,
        flaw_codes=report.flaw_codes,
    )
