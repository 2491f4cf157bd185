"""Alarms and what people do about them."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Depends
from pydantic import BaseModel

from base_station.api.forms import Form, Id, Note, to_ms, window
from base_station.api.problems import Problem
from base_station.api.security import Commander, Viewer
from base_station.api.services import Services, Station
from base_station.db import models
from base_station.db.records import Window
from shared.messages.station import AcknowledgeAlarm, ResolveAlarm

router = APIRouter(tags=["alarms"])


class Alarm(BaseModel):
    alarm_id: str
    rule: str
    unit_id: str
    priority: int
    state: str
    level: str
    text: str
    by: str
    raised_ms: int
    changed_ms: int


class AlarmChange(BaseModel):
    t_ms: int
    state: str
    level: str
    text: str
    by: str


class AlarmWithLife(Alarm):
    changes: list[AlarmChange]


class Resolution(Form):
    note: Note = ""


def alarm_of(alarm: models.Alarm) -> Alarm:
    return Alarm(
        alarm_id=alarm.alarm_id,
        rule=alarm.rule,
        unit_id=alarm.unit_id,
        priority=alarm.priority,
        state=alarm.state,
        level=alarm.level,
        text=alarm.text,
        by=alarm.by,
        raised_ms=to_ms(alarm.raised_ns),
        changed_ms=to_ms(alarm.changed_ns),
    )


@router.get("/alarms")
def list_alarms(
    station: Station, _: Viewer, when: Annotated[Window, Depends(window)]
) -> list[Alarm]:
    """Those raised in the window, oldest first."""
    return [alarm_of(alarm) for alarm in station.records.alarms(when)]


@router.get("/alarms/{alarm_id}")
def get_alarm(alarm_id: Id, station: Station, _: Viewer) -> AlarmWithLife:
    alarm = _alarm_or_404(station, alarm_id)
    changes = [
        AlarmChange(
            t_ms=to_ms(life.t_ns), state=life.state, level=life.level, text=life.text, by=life.by
        )
        for life in station.records.alarm_life(alarm_id)
    ]
    return AlarmWithLife(**alarm_of(alarm).model_dump(), changes=changes)


@router.post("/alarms/{alarm_id}/acknowledge", status_code=204)
def acknowledge(alarm_id: Id, station: Station, who: Commander) -> None:
    _alarm_or_404(station, alarm_id)
    station.act(who.username, AcknowledgeAlarm(alarm_id))


@router.post("/alarms/{alarm_id}/resolve", status_code=204)
def resolve(alarm_id: Id, resolution: Resolution, station: Station, who: Commander) -> None:
    _alarm_or_404(station, alarm_id)
    station.act(who.username, ResolveAlarm(alarm_id, resolution.note))


def _alarm_or_404(station: Services, alarm_id: str) -> models.Alarm:
    station.settle()  # an alarm on the screen may be newer than the store
    alarm = station.records.alarm(alarm_id)
    if alarm is None:
        raise Problem(404, "There is no such alarm.")
    return alarm
