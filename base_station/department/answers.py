"""Answers of the department's API; times are the department's own, in ms since 1970."""

from __future__ import annotations

from typing import Annotated

from base_station.views.answer import Answer
from base_station.views.wire import AlarmParametersView, TextCodeView, one_of


class ReportingStationView(Answer, frozen=True):
    """A station of the department."""

    station: str
    state: Annotated[str, one_of("live", "away", "never")]
    last_ms: int | None  # of its last summary; None: it has never reported
    console_url: str  # empty: not configured there
    host: str
    people: int
    in_incident: int
    waiting: int  # events that it had not handed over when it reported last
    missing: int  # events that were lost on the way: more than none is to be looked into
    clock_ahead_ms: int  # of its clock, against the department's
    problems: tuple[str, ...]
    lat_deg: float | None  # of its site, where that has an anchor
    lon_deg: float | None
    problem_codes: tuple[TextCodeView, ...] = ()  # of ``problems``, in their order


class DepartmentIncidentView(Answer, frozen=True):
    station: str
    incident_id: str
    name: str
    opened_ms: int
    closed_ms: int | None
    people: int
    maydays: int
    alarms: int  # open ones
    overdue: int  # members whose PAR is overdue


class DepartmentIncidentsView(Answer, frozen=True):
    """A part of the incidents, open ones first, then the newest."""

    total: int  # that were asked for
    incidents: tuple[DepartmentIncidentView, ...]


class DepartmentAlarmView(Answer, frozen=True):
    """An alarm that is not resolved."""

    station: str
    alarm_id: str
    rule: str
    unit_id: str
    person: str
    priority: int
    state: str  # raised | acknowledged
    level: str
    text: str
    by: str
    raised_ms: int
    changed_ms: int
    code: str = ""  # of the sentence in ``text``; empty: the station is of an earlier version
    parameters: AlarmParametersView = AlarmParametersView()  # amounts and names in the sentence


class DepartmentView(Answer, frozen=True):
    """The department at a glance."""

    now_ms: int
    stations: tuple[ReportingStationView, ...]
    incidents: tuple[DepartmentIncidentView, ...]  # open ones first, then the newest
    alarms: tuple[DepartmentAlarmView, ...]  # the gravest and newest
    open_alarms: int  # all of them
    people: int
    problems: tuple[str, ...]  # sentences for a person
    has_archive: bool  # past incidents can be opened
    problem_codes: tuple[TextCodeView, ...] = ()  # of ``problems``, in their order


class DepartmentPersonView(Answer, frozen=True):
    station: str
    unit_id: str
    label: str
    person_id: str
    name: str
    crew: str
    role: str
    incident_id: str
    link: Annotated[str, one_of("live", "stale", "lost", "never", "station_away")]
    position_age_s: float | None  # None: no position has come
    north_m: float | None
    east_m: float | None
    floor: int | None
    lat_deg: float | None
    lon_deg: float | None
    radius_m: float | None
    quality: str
    activity: str
    mayday: bool
    alarms: int
    par: Annotated[str, one_of("self", "radio", "not_yet", "")]
    par_due_ms: int | None
    par_overdue: bool


class DepartmentPeopleView(Answer, frozen=True):
    """A part of the people, who need help first."""

    now_ms: int
    total: int  # that were asked for
    people: tuple[DepartmentPersonView, ...]


class DepartmentEventView(Answer, frozen=True):
    """An event in the order of arrival."""

    number: int
    station: str
    kind: str
    t_ms: int  # of the event, by the department's clock
    received_ms: int
    text: str


class StartedReplay(Answer, frozen=True):
    """A past incident in a console of its own, on this machine."""

    port: int
    username: str
    password: str
