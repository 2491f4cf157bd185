"""Answers of the department's API, made from the live picture and the tables."""

from __future__ import annotations

import heapq
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import islice
from typing import NamedTuple

from base_station.department.answers import (
    DepartmentAlarmView,
    DepartmentEventView,
    DepartmentIncidentsView,
    DepartmentIncidentView,
    DepartmentPeopleView,
    DepartmentPersonView,
    DepartmentView,
    ReportingStationView,
)
from base_station.department.event_texts import event_text
from base_station.department.intake import ReportIntake
from base_station.department.live_picture import (
    AWAY_AFTER_NS,
    CLOCK_LIMIT_MS,
    IncidentCounts,
    LivePicture,
    StationPicture,
    is_overdue,
    rank_of,
)
from base_station.department.standing import StandingReports
from base_station.department_wire import PersonSummary
from base_station.storage.db.department_models import ReportedAlarm, ReportedIncident
from base_station.storage.db.department_tables import DepartmentTables
from base_station.storage.db.known_people import shown_text
from base_station.views.alarm_parameters import stored_parameters_view
from base_station.views.answer import to_ms
from base_station.views.text_code import coded_views, text_code_view
from base_station.views.wire import AlarmParametersView
from shared.clock import NS_PER_MS, Clock
from shared.coded_text import Measure, Term, coded

_MS_PER_S = 1000.0
_S_PER_MINUTE, _MINUTES_PER_H = 60, 60
_NO_COUNTS = IncidentCounts()


class PeopleQuery(NamedTuple):
    station: str  # empty: of all
    incident_id: str  # empty: in any, or in none
    search: str  # part of a name, label, crew or unit; empty: everybody
    skip: int
    limit: int


class DepartmentViews:
    """Maker of the answers.  Thread-safe.  What changes by itself comes from memory, also while the
    database cannot be reached.
    """

    def __init__(
        self,
        picture: LivePicture,
        tables: DepartmentTables,
        standing: StandingReports,
        intake: ReportIntake,
        clock: Clock,
        enrolled: Callable[[], Collection[str]],
        problems: Callable[[], Iterable[str]],
        *,
        has_archive: bool,
    ) -> None:
        """``enrolled``: stations with a certificate; ``problems``: problems of the department
        itself.
        """
        self.has_archive = has_archive
        self._picture, self._tables, self._intake = picture, tables, intake
        self._standing = standing
        self._clock, self._enrolled, self._problems = clock, enrolled, problems

    def overview(self) -> DepartmentView:
        pictures, standing = self._picture.all(), self._standing.current
        stations = tuple(self._stations(pictures, standing.missing))
        problems = (*self._problems(), *self._problems_of(pictures, standing.missing))
        return DepartmentView(
            now_ms=to_ms(self._clock.utc_ns()),
            stations=stations,
            incidents=tuple(
                _incident_view(one, pictures.get(one.station, ()))
                for one in (*_not_stored(standing.incidents, pictures), *standing.incidents)
            ),
            alarms=tuple(self._alarm_view(one, pictures) for one in standing.alarms),
            open_alarms=standing.open_alarms,
            people=sum(one.people for one in stations),
            problems=tuple(map(str, problems)),
            has_archive=self.has_archive,
            problem_codes=coded_views(problems),
        )

    def people(self, wanted: PeopleQuery) -> DepartmentPeopleView:
        """People, those who need help first."""
        found = [(picture, self._found(picture, wanted)) for picture in self._of(wanted.station)]
        ranked = heapq.merge(
            *(_ranked(picture, people) for picture, people in found), key=lambda one: one[0]
        )
        part = islice(ranked, wanted.skip, wanted.skip + wanted.limit)
        return DepartmentPeopleView(
            now_ms=to_ms(self._clock.utc_ns()),
            total=sum(len(people) for _, people in found),
            people=tuple(self._person_view(picture, person) for _, picture, person in part),
        )

    def incidents(self, search: str, skip: int, limit: int) -> DepartmentIncidentsView:
        """Incidents with all words of ``search``, open ones first.  Raises StoreError."""
        found, total = self._tables.find_incidents(search, skip, limit)
        pictures = self._picture.all()
        return DepartmentIncidentsView(
            total=total,
            incidents=tuple(_incident_view(one, pictures.get(one.station, ())) for one in found),
        )

    def events(self, before: int | None, limit: int) -> tuple[DepartmentEventView, ...]:
        """Events in the order of arrival, newest first.  Raises StoreError."""
        return tuple(
            DepartmentEventView(
                number=row.number,
                station=row.station,
                kind=row.kind,
                t_ms=row.t_ms - row.offset_ms,
                received_ms=to_ms(row.received_ns),
                text=event_text(row, partial(self._intake.person, row.station)),
            )
            for row in self._tables.events(before, limit)
        )

    def is_past(self, station: str, incident_id: str) -> bool:
        """True if the station has reported that the incident is closed.  Raises StoreError."""
        incident = self._tables.incident(station, incident_id)
        return incident is not None and incident.closed_ms is not None

    # ---- stations

    def _of(self, station: str) -> Iterator[StationPicture]:
        for name, pictures in self._picture.all().items():
            if station in ("", name):
                yield from pictures

    def _stations(
        self, pictures: Mapping[str, Sequence[StationPicture]], missing: Mapping[str, int]
    ) -> Iterator[ReportingStationView]:
        for name in sorted({*self._enrolled(), *pictures}):
            shown = pictures.get(name, ())
            newest = max(shown, key=lambda one: one.received_ns, default=None)
            yield ReportingStationView(
                station=name,
                state=self._state(newest),
                last_ms=None if newest is None else to_ms(newest.received_ns),
                console_url="" if newest is None else newest.summary.console_url,
                host="" if newest is None else newest.summary.host,
                people=sum(len(one.summary.people) for one in shown),
                in_incident=sum(
                    count.people for one in shown for key, count in one.counts.items() if key
                ),
                waiting=sum(one.summary.waiting for one in shown),
                missing=missing.get(name, 0),
                clock_ahead_ms=0 if newest is None else newest.offset_ms,
                problems=() if newest is None else newest.summary.problems,
                lat_deg=None if newest is None else newest.summary.lat_deg,
                lon_deg=None if newest is None else newest.summary.lon_deg,
                problem_codes=()
                if newest is None
                else tuple(map(text_code_view, newest.summary.problem_codes)),
            )

    def _state(self, picture: StationPicture | None) -> str:
        if picture is None:
            return "never"
        return "away" if self._silent_ns(picture) >= AWAY_AFTER_NS else "live"

    def _silent_ns(self, picture: StationPicture) -> int:
        return picture.silent_ns(self._clock.utc_ns(), self._clock.monotonic_ns())

    def _problems_of(
        self, pictures: Mapping[str, Sequence[StationPicture]], missing: Mapping[str, int]
    ) -> Iterator[str]:
        if problem := self._intake.problem:
            yield problem
        for name, ones in sorted(pictures.items()):
            if len(ones) > 1:
                hosts = ", ".join(f"{one.summary.host} {one.summary.console_url}" for one in ones)
                yield coded(
                    "department-same-station",
                    "Several machines report as {station}: {hosts}. The people of all are shown; "
                    "give each station an enrolment of its own, and revoke this one",
                    station=name,
                    hosts=hosts,
                )
            newest = max(ones, key=lambda one: one.received_ns)
            if abs(newest.offset_ms) > CLOCK_LIMIT_MS:
                yield _clock_problem(name, newest.offset_ms)
        for name, count in sorted(missing.items()):
            yield coded(
                "department-events-missing",
                "{count} events of {station} are not here: this department's database is older "
                "than what it has acknowledged. The station's own log has them",
                count=count,
                station=name,
            )

    # ---- people and alarms

    def _found(self, picture: StationPicture, wanted: PeopleQuery) -> Sequence[PersonSummary]:
        """People of one station by need."""
        people, search = picture.people, wanted.search.casefold()
        if wanted.incident_id:
            people = [one for one in people if one.incident_id == wanted.incident_id]
        if search:
            people = [one for one in people if self._matches(picture.station, one, search)]
        return people

    def _matches(self, station: str, person: PersonSummary, search: str) -> bool:
        known = self._intake.person(station, person.person_id)
        texts = (known.name, known.crew, person.label, person.unit_id)
        return any(search in text.casefold() for text in texts)

    def _person_view(self, picture: StationPicture, person: PersonSummary) -> DepartmentPersonView:
        known = self._intake.person(picture.station, person.person_id)
        place, summary = person.place, picture.summary
        silent_ns = self._silent_ns(picture)
        age_s = None
        if place is not None:  # by the station's clock until it was sent, then by the department's
            age_s = (summary.t_ms - place.t_ms + silent_ns / NS_PER_MS) / _MS_PER_S
        due_ms = person.par_due_ms
        return DepartmentPersonView(
            station=picture.station,
            unit_id=person.unit_id,
            label=person.label,
            person_id=person.person_id,
            name=known.name,
            crew=known.crew,
            role=known.role,
            incident_id=person.incident_id,
            link="station_away" if silent_ns >= AWAY_AFTER_NS else person.link,
            position_age_s=age_s,
            north_m=None if place is None else place.north_m,
            east_m=None if place is None else place.east_m,
            floor=None if place is None else place.floor,
            lat_deg=None if place is None else place.lat_deg,
            lon_deg=None if place is None else place.lon_deg,
            radius_m=None if place is None else place.radius_m,
            quality="" if place is None else place.quality,
            activity=person.activity,
            mayday=person.mayday,
            alarms=len(person.alarms),
            par=person.par,
            par_due_ms=None if due_ms is None else due_ms - picture.offset_ms,
            par_overdue=is_overdue(person, summary.t_ms + silent_ns // NS_PER_MS),
        )

    def _alarm_view(
        self, alarm: ReportedAlarm, pictures: Mapping[str, Sequence[StationPicture]]
    ) -> DepartmentAlarmView:
        people = partial(self._intake.person, alarm.station)
        wearers = (
            person.person_id
            for picture in pictures.get(alarm.station, ())
            for person in picture.summary.people
            if person.unit_id == alarm.unit_id
        )
        return DepartmentAlarmView(
            station=alarm.station,
            alarm_id=alarm.alarm_id,
            rule=alarm.rule,
            unit_id=alarm.unit_id,
            person=people(next(wearers, "")).name,
            priority=alarm.priority,
            state=alarm.state,
            level=alarm.level,
            text=shown_text(alarm.text, people),
            by=shown_text(alarm.by, people),
            raised_ms=alarm.raised_ms - alarm.offset_ms,
            changed_ms=alarm.changed_ms - alarm.offset_ms,
            code="" if alarm.coded is None else alarm.coded.code,
            parameters=AlarmParametersView()
            if alarm.coded is None
            else stored_parameters_view(alarm.coded.parameters, people),
        )


def _ranked(
    picture: StationPicture, people: Iterable[PersonSummary]
) -> Iterator[tuple[tuple[object, ...], StationPicture, PersonSummary]]:
    """People with the keys by which they are sorted."""
    for person in people:
        rank = rank_of(person, picture.summary.t_ms)
        yield (*rank[:-1], picture.station, rank[-1]), picture, person


def _not_stored(
    stored: Iterable[ReportedIncident], pictures: Mapping[str, Sequence[StationPicture]]
) -> Iterator[ReportedIncident]:
    """Open incidents from summaries whose events are not in the database yet."""
    known = {(one.station, one.incident_id) for one in stored}
    for station, ones in pictures.items():
        for picture in ones:
            for incident in picture.summary.incidents:
                key = (station, incident.incident_id)
                if key not in known:
                    known.add(key)
                    yield ReportedIncident(
                        station=station,
                        incident_id=incident.incident_id,
                        name=incident.name,
                        opened_ms=incident.opened_ms,
                        closed_ms=None,
                        offset_ms=picture.offset_ms,
                    )


def _incident_view(
    incident: ReportedIncident, pictures: Sequence[StationPicture]
) -> DepartmentIncidentView:
    counts = [one.counts.get(incident.incident_id, _NO_COUNTS) for one in pictures]
    closed_ms = incident.closed_ms
    return DepartmentIncidentView(
        station=incident.station,
        incident_id=incident.incident_id,
        name=incident.name,
        opened_ms=incident.opened_ms - incident.offset_ms,
        closed_ms=None if closed_ms is None else closed_ms - incident.offset_ms,
        people=sum(one.people for one in counts),
        maydays=sum(one.maydays for one in counts),
        alarms=sum(one.alarms for one in counts),
        overdue=sum(one.overdue for one in counts),
    )


def _clock_problem(station: str, ahead_ms: int) -> str:
    minutes, seconds = divmod(round(abs(ahead_ms) / _MS_PER_S), _S_PER_MINUTE)
    apart = f"{minutes} min {seconds} s"
    if minutes >= _MINUTES_PER_H:
        hours, minutes = divmod(round(abs(ahead_ms) / _MS_PER_S / _S_PER_MINUTE), _MINUTES_PER_H)
        apart = f"{hours} h {minutes} min"
    side = Term("ahead", "ahead of") if ahead_ms > 0 else Term("behind", "behind")
    return coded(
        "department-station-clock",
        "The clock of {station} is {off_s} {side} the department's: times are shown by the "
        "department's clock; set the one that is wrong",
        station=station,
        off_s=Measure(abs(ahead_ms) / _MS_PER_S, apart),
        side=side,
    )
