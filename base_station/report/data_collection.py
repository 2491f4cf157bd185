"""Collects the contents of a report from the database and the log."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from importlib.metadata import version
from typing import Any, cast

import msgspec

from base_station.core.alarms import ALARMS
from base_station.core.alarms.interface import AlarmRule
from base_station.core.alarms.thresholds import limits_of, with_thresholds
from base_station.core.work_limits import PAR_INTERVAL_S, WORK_LIMIT_S
from base_station.dispatch.description import description
from base_station.engine.log_feed import LogFeed
from base_station.replay.assessment.report import with_people
from base_station.replay.assessment.wearers import wearers
from base_station.replay.post_processing import read_report
from base_station.report import texts
from base_station.report.contents import (
    AlarmTrace,
    ImportEntry,
    Interval,
    OrderEntry,
    Photographs,
    ReportContents,
    TimelineEntry,
    UnitEntry,
)
from base_station.report.incident_entries import entries_of_incident
from base_station.report.log_facts import LogFacts, read_facts, series_within, wanted_keys
from base_station.report.orders import details_of, kind_name, orders_of
from base_station.report.people import IncidentPeople
from base_station.report.photographs import photographs_of
from base_station.report.thresholds_in_force import thresholds_in_force
from base_station.site.plan import salvage_plan
from base_station.storage.db.models import AlarmRow, AlarmTransition, AuditEntry, IncidentRow
from base_station.storage.db.records import Records
from base_station.storage.db.roster import Roster
from base_station.storage.db.smoothed import SmoothedTracks
from base_station.storage.db.window import Window
from base_station.storage.imports import ImportFolder
from base_station.storage.log_defects import LogDefects
from shared.clock import NS_PER_S
from shared.messages.station import (
    Action,
    OpenIncident,
    SetAccountability,
)

ABOUT_NS = 60 * NS_PER_S  # before and after an alarm
MOST_TRACES = 200
_EMERGENCY = 1  # priority
_ACTIONS = frozenset(kind.__name__ for kind in cast("Any", Action).__args__)
Progress = Callable[[float], None]


@dataclass(frozen=True)
class ReportSources:
    """Sources of a report; nothing is written to them."""

    records: Records
    roster: Roster
    kept: SmoothedTracks
    log: LogFeed
    imports: ImportFolder  # files that were brought in
    defects: LogDefects
    recorded_until_ns: Callable[[], int]  # where an open incident ends


def collect_report_data(
    sources: ReportSources, incident: IncidentRow, on_progress: Progress = lambda _: None
) -> ReportContents:
    return _Collector(sources, incident).contents(on_progress)


class _Collector:
    def __init__(self, sources: ReportSources, incident: IncidentRow) -> None:
        self._sources = sources
        self._incident = incident
        records = sources.records
        until_ns = incident.closed_ns or max(sources.recorded_until_ns(), incident.opened_ns)
        self._during = Interval(incident.opened_ns, until_ns)
        self._window = Window(incident.opened_ns, until_ns + 1)  # the closing is of it
        self._alarms = sorted(
            records.alarms(self._window, None, incident),
            key=lambda one: (one.raised_ns, one.alarm_id),
        )
        self._members = records.members_of(incident)
        self._assignments = sources.roster.assignments(incident.opened_ns, until_ns)
        done = [one for one in records.audit_entries(self._window) if one.action in _ACTIONS]
        entries = entries_of_incident(done, incident.incident_id, self._members, self._assignments)
        self._people = IncidentPeople(
            records, sources.roster, self._members, self._assignments, self._during, self._window
        )
        self._entries = sorted(entries, key=lambda one: (one.t_ns, one.number))

    def contents(self, on_progress: Progress) -> ReportContents:
        sources, incident = self._sources, self._incident
        geojson = sources.records.plan(self._window.until_ns, incident.site_id)
        plan = None if geojson is None else salvage_plan(geojson)
        facts = self._facts(lambda done: on_progress(0.8 * done))
        people = self._people.entries(plan, facts, lambda done: on_progress(0.8 + 0.2 * done))
        kept = sources.kept.report(incident.incident_id)
        report = None if kept is None else read_report(kept)
        traces = tuple(self._traces(facts))
        times = self._times()
        anchor = sources.records.anchor(self._window.until_ns, incident.site_id)
        worn = wearers(sources.roster, incident, self._members)
        return ReportContents(
            incident_id=incident.incident_id,
            name=sources.roster.shown(incident.name),
            during=self._during,
            is_open=incident.closed_ns is None,
            opened_by=incident.opened_by,
            closed_by=incident.closed_by,
            dispatch=self._dispatch(),
            timeline=tuple(self._timeline()),
            orders=self._named_orders(facts),
            people=people,
            alarms=len(self._alarms),
            traces=traces,
            traces_left_out=len(self._explained_alarms()) - len(traces),
            plan=plan,
            has_anchor=anchor is not None,
            assessment=report and with_people(report, worn),
            imports=tuple(self._imports()),
            photographs=self._photographs(),
            defects=tuple(sources.defects()),
            thresholds=tuple(self._thresholds()),
            par_interval_s=times[0],
            work_limit_s=times[1],
            units=tuple(self._units()),
            version=version("muster"),
        )

    def _imports(self) -> Iterable[ImportEntry]:
        for row in self._sources.records.imports_of(self._incident.incident_id):
            yield ImportEntry(
                file_name=self._shown(row.file_name),
                format=row.format,
                during=Interval(row.first_ns, row.last_ns),
                shift_s=row.shift_s,
                t_ns=row.t_ns,
                by=row.by,
                sha256=row.sha256,
            )

    def _photographs(self) -> Photographs:
        rows = self._sources.records.imports_of(self._incident.incident_id)
        found = photographs_of(rows, self._sources.imports)
        entries = tuple(
            msgspec.structs.replace(one, file_name=self._shown(one.file_name))
            for one in found.entries
        )
        return msgspec.structs.replace(found, entries=entries)

    def _dispatch(self) -> str:
        number = self._incident.dispatch_number
        report = self._sources.records.dispatch(number) if number else None
        return "" if report is None else self._shown(description(report))

    # ---- facts of the log

    def _facts(self, on_progress: Progress) -> LogFacts:
        sources = self._sources
        wearings = {
            unit_id: [one.during for one in worn] for unit_id, worn in self._people.wearings.items()
        }
        about: dict[str, list[Interval]] = {}
        for alarm in self._explained_alarms()[:MOST_TRACES]:
            about.setdefault(alarm.unit_id, []).append(_about(alarm))
        while sources.defects.check_next_chunk():
            pass  # into all of it: unreadable parts must be in the report
        records = sources.log.records(
            self._window.from_ns, self._window.until_ns, wanted_keys(self._people.wearings)
        )
        return read_facts(records, self._during, wearings, about, on_progress)

    def _explained_alarms(self) -> Sequence[AlarmRow]:
        """Alarms of units that are in the report, most urgent first."""
        of_units = [one for one in self._alarms if one.unit_id in self._people.wearings]
        return sorted(of_units, key=lambda one: (one.priority, one.raised_ns, one.alarm_id))

    def _traces(self, facts: LogFacts) -> Iterable[AlarmTrace]:
        rules = {rule.name: rule for rule in self._rules_in_force()}
        chosen = self._explained_alarms()[:MOST_TRACES]
        lives = self._sources.records.alarm_lives([one.alarm_id for one in chosen])
        for alarm in sorted(chosen, key=lambda one: (one.raised_ns, one.alarm_id)):
            about, unit = _about(alarm), facts.units[alarm.unit_id]
            window = Window(about.from_ns, about.until_ns)
            points = self._sources.records.track(alarm.unit_id, window)
            rule = rules.get(alarm.rule)
            life = lives[alarm.alarm_id]
            text = life[0].text if life else alarm.text
            yield AlarmTrace(
                alarm_id=alarm.alarm_id,
                raised_ns=alarm.raised_ns,
                rule=alarm.rule,
                text=self._sources.roster.shown(text),
                motionless_s=series_within(unit.motionless_s, about),
                temperature_degc=series_within(unit.temperature_degc, about),
                height_m=tuple((one.t_ns, -one.down_m) for one in points),
                received_ns=tuple(
                    t_ns for t_ns in unit.received_ns if about.from_ns <= t_ns <= about.until_ns
                ),
                thresholds=()
                if rule is None
                else tuple((name, float(getattr(rule, name))) for name in limits_of(rule)),
            )

    # ---- actions of people

    def _timeline(self) -> Iterable[TimelineEntry]:
        entries = [*self._done(), *self._alarm_entries()]
        return sorted(entries, key=lambda one: one.t_ns)

    def _done(self) -> Iterable[TimelineEntry]:
        for entry in self._entries:
            details = self._order_details(entry)
            name_of = partial(self._people.name_at, t_ns=entry.t_ns)
            described = (
                texts.action_text(entry.action, details, name_of) if details else texts.ERASED
            )
            if described is not None:
                kind, text = described
                is_urgent = details.get("order") in texts.URGENT_ORDERS
                yield TimelineEntry(entry.t_ns, kind, self._shown(text), entry.by, is_urgent)

    def _order_details(self, entry: AuditEntry) -> Mapping[str, Any]:
        details = dict(details_of(entry))
        if "kind" in details:
            details["order"] = texts.order_name(kind_name(details["kind"]))
        if details.get("person_ids"):
            roster = self._sources.roster
            details["people"] = [
                roster.known(person_id).name for person_id in details["person_ids"]
            ]
        return details

    def _alarm_entries(self) -> Iterable[TimelineEntry]:
        lives = self._sources.records.alarm_lives([one.alarm_id for one in self._alarms])
        for alarm in self._alarms:
            for change in lives[alarm.alarm_id]:
                if change.t_ns < self._window.until_ns:
                    yield self._alarm_entry(alarm, change)

    def _alarm_entry(self, alarm: AlarmRow, change: AlarmTransition) -> TimelineEntry:
        if change.state == "raised":
            text = texts.alarm_raised(change.text, change.level)
            is_urgent = alarm.priority == _EMERGENCY
        else:
            peak = "" if change.peak is None else texts.alarm_peak(alarm.rule, change.peak)
            text = texts.alarm_ended(change.state, change.text, change.reason, change.note, peak)
            is_urgent = False
        return TimelineEntry(
            change.t_ns, texts.ALARM, self._shown(text), self._shown(change.by), is_urgent
        )

    def _named_orders(self, facts: LogFacts) -> tuple[OrderEntry, ...]:
        name_at = self._people.name_at
        return tuple(
            msgspec.structs.replace(
                order,
                text=self._shown(order.text),
                receipts=tuple(
                    msgspec.structs.replace(one, unit_id=name_at(one.unit_id, order.t_ns))
                    for one in order.receipts
                ),
            )
            for order in orders_of(self._entries, facts)
        )

    def _shown(self, text: str) -> str:
        return self._sources.roster.shown(text)

    # ---- settings

    def _times(self) -> tuple[float, float]:
        """PAR interval and work limit in seconds, as they were at the end."""
        par_s, work_s = PAR_INTERVAL_S, WORK_LIMIT_S
        for entry in self._entries:
            if entry.action in {OpenIncident.__name__, SetAccountability.__name__}:
                details = details_of(entry)
                par_s = details.get("par_interval_s") or par_s
                work_s = details.get("work_limit_s") or work_s
        return par_s, work_s

    def _rules_in_force(self) -> Sequence[AlarmRule]:
        recorded = thresholds_in_force(self._sources.records, self._window.until_ns)
        return with_thresholds(ALARMS, recorded)

    def _thresholds(self) -> Iterable[tuple[str, float, float]]:
        for rule, default in zip(self._rules_in_force(), ALARMS, strict=True):
            for name in limits_of(rule):
                now, usual = float(getattr(rule, name)), float(getattr(default, name))
                yield f"{rule.name}.{name}", now, usual

    def _units(self) -> Iterable[UnitEntry]:
        for unit_id in self._people.wearings:
            unit = self._sources.roster.unit(unit_id)
            if unit is not None:
                yield UnitEntry(unit_id, unit.software_version, unit.tracker, unit.calibration)


def _about(alarm: AlarmRow) -> Interval:
    return Interval(alarm.raised_ns - ABOUT_NS, alarm.raised_ns + ABOUT_NS)
