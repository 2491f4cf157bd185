"""Alarms and people's actions on them."""

from __future__ import annotations

from contextlib import AbstractContextManager
from typing import Annotated

from fastapi import APIRouter, Depends
from pydantic import Field

from base_station.api.alarm_lives import AlarmWithLife, with_life
from base_station.api.authentication import Viewer
from base_station.api.current_tables import CurrentStation
from base_station.api.forms import MAX_TIME_MS, AlarmId, Form, Limit, Note, window
from base_station.api.idempotent_request import Perform
from base_station.api.problems import Problem
from base_station.api.refusals import not_found_if_unknown
from base_station.api.services import Services, Station
from base_station.core.alarms.resolution_reasons import ResolutionReason
from base_station.report.alarm_explanation import Crossing
from base_station.report.contents import Series
from base_station.storage.db.window import Window
from base_station.views.answer import Answer, to_ms
from shared.coded_text import coded, text_of_error
from shared.errors import LogError
from shared.messages.station import AcknowledgeAlarm, ResolveAlarm

router = APIRouter(tags=["alarms"])

_NO_ALARM = coded("alarm-unknown", "There is no such alarm.")
_SERIES = {"battery": "battery_level"}  # under another name in the answer


class TracePoint(Answer, frozen=True):
    t_ms: int
    value: float


class ThresholdCrossing(Answer, frozen=True):
    """First value beyond a threshold before the alarm was raised."""

    series: str
    threshold: str
    limit: float
    t_ms: int
    value: float


class AlarmExplanationAnswer(Answer, frozen=True):
    """Values of the alarm's unit from a minute before until a minute after it was raised."""

    alarm_id: str
    rule: str
    raised_ms: int
    motionless_s: tuple[TracePoint, ...]
    temperature_degc: tuple[TracePoint, ...]
    battery_level: tuple[TracePoint, ...]
    height_m: tuple[TracePoint, ...]
    stated_error_m: tuple[TracePoint, ...]
    live_ms: tuple[int, ...]
    buttons_ms: tuple[int, ...]
    thresholds: dict[str, float]
    crossing: ThresholdCrossing | None


class Acknowledgement(Form):
    """Acknowledgement of an alarm as it was shown; an alarm that was raised again since stays
    open.
    """

    last_raised_ms: Annotated[int, Field(gt=0, le=MAX_TIME_MS)]


class Resolution(Acknowledgement):
    reason: ResolutionReason | None = None
    note: Note = ""


@router.get("/alarms")
def list_alarms(
    station: CurrentStation, _: Viewer, when: Annotated[Window, Depends(window)], limit: Limit = 100
) -> list[AlarmWithLife]:
    """Alarms that were raised in the window, newest first."""
    alarms = station.records.alarms(when, limit)
    lives = station.records.alarm_lives([alarm.alarm_id for alarm in alarms])
    return [with_life(alarm, lives[alarm.alarm_id], station.roster) for alarm in alarms]


@router.get("/alarms/{alarm_id}")
def get_alarm(alarm_id: AlarmId, station: CurrentStation, _: Viewer) -> AlarmWithLife:
    alarm = station.records.alarm(alarm_id)
    if alarm is None:
        raise Problem(404, _NO_ALARM)
    return with_life(alarm, station.records.alarm_life(alarm_id), station.roster)


@router.get("/alarms/{alarm_id}/explanation")
def explain_alarm(alarm_id: AlarmId, station: CurrentStation, _: Viewer) -> AlarmExplanationAnswer:
    """Motion, temperature, height, stated error, radio contact and button about the time of the
    alarm, the thresholds of its rule at that time, and which of them was crossed.
    """
    alarm = station.records.alarm(alarm_id)
    if alarm is None:
        raise Problem(404, _NO_ALARM)
    if not alarm.unit_id:
        raise Problem(
            404,
            coded(
                "alarm-of-station",
                "This alarm is about the station itself; it has no values of a unit.",
            ),
        )
    if station.alarm_explainer is None:
        raise Problem(503, coded("alarm-no-log", "This station has no log to read."))
    try:
        found = station.alarm_explainer.explain(alarm)
    except LogError as error:
        raise Problem(
            503,
            coded(
                "alarm-log-unreadable",
                "The log cannot be read: {reason}.",
                reason=text_of_error(error),
            ),
        ) from error
    return AlarmExplanationAnswer(
        alarm_id=alarm_id,
        rule=alarm.rule,
        raised_ms=to_ms(alarm.raised_ns),
        motionless_s=_trace(found.motionless_s),
        temperature_degc=_trace(found.temperature_degc),
        battery_level=_trace(found.battery),
        height_m=_trace(found.height_m),
        stated_error_m=_trace(found.stated_error_m),
        live_ms=tuple(map(to_ms, found.received_ns)),
        buttons_ms=tuple(map(to_ms, found.buttons_ns)),
        thresholds=dict(found.thresholds),
        crossing=_crossing(found.crossing),
    )


@router.post("/alarms/{alarm_id}/acknowledge", status_code=204)
def acknowledge(
    alarm_id: AlarmId, seen: Acknowledgement, station: Station, perform: Perform
) -> None:
    """Acknowledge an alarm as it was shown.  409 if it was raised again since."""
    with _not_found_if_unknown(station, alarm_id):
        perform(AcknowledgeAlarm(alarm_id, seen.last_raised_ms))


@router.post("/alarms/{alarm_id}/resolve", status_code=204)
def resolve(alarm_id: AlarmId, resolution: Resolution, station: Station, perform: Perform) -> None:
    with _not_found_if_unknown(station, alarm_id):
        perform(
            ResolveAlarm(
                alarm_id, resolution.note, resolution.last_raised_ms, resolution.reason or ""
            )
        )


def _crossing(found: Crossing | None) -> ThresholdCrossing | None:
    if found is None:
        return None
    series = _SERIES.get(found.series, found.series)
    return ThresholdCrossing(series, found.threshold, found.limit, to_ms(found.t_ns), found.value)


def _trace(series: Series) -> tuple[TracePoint, ...]:
    return tuple(TracePoint(to_ms(t_ns), value) for t_ns, value in series)


def _not_found_if_unknown(station: Services, alarm_id: str) -> AbstractContextManager[None]:
    return not_found_if_unknown(
        station,
        _NO_ALARM,
        shown=lambda picture: any(one.alarm_id == alarm_id for one in picture.alarms),
        stored=lambda: station.records.alarm(alarm_id) is not None,
    )
