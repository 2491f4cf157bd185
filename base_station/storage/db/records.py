"""Queries of the projections: incidents, tracks, alarms, the site, log segments, audit."""

from __future__ import annotations

import secrets
from collections.abc import Collection, Iterable, Mapping, Sequence

import msgspec
from sqlalchemy import ColumnElement, delete, exists, func, insert, or_, select, text
from sqlalchemy.orm import InstrumentedAttribute

from base_station.fusion.lazy_mapping import LastValueMapping
from base_station.storage.db import models
from base_station.storage.db.database import Database
from base_station.storage.db.erasure import incidents_to_erase
from base_station.storage.db.incident_search import IncidentQuery, IncidentSearch
from base_station.storage.db.known_people import load_people, person_lookup, shown_text
from base_station.storage.db.members import Members, members_of, was_member
from base_station.storage.db.models import (
    PROJECTIONS,
    AlarmRow,
    AlarmTransition,
    AuditEntry,
    DispatchRow,
    ImportRow,
    IncidentRow,
    LogSegment,
    PlanRow,
    TrackPoint,
    Unit,
)
from base_station.storage.db.pages import newest
from base_station.storage.db.upserts import insert_into, is_on_server
from base_station.storage.db.window import EVER, FOREVER_NS, Window
from shared.clock import NS_PER_S, Clock
from shared.errors import UserError
from shared.geo import Anchor
from shared.messages.station import NoteDispatch

_REPORTS = msgspec.json.Decoder(NoteDispatch)


class TrackSample(msgspec.Struct, frozen=True):
    """One point of a track, NED metres about the site anchor; a long track has many."""

    t_ns: int
    north_m: float
    east_m: float
    down_m: float
    std_north_m: float
    std_east_m: float
    std_down_m: float
    heading_rad: float
    floor: int | None
    quality: str


_TRACK_COLUMNS = tuple(getattr(TrackPoint, name) for name in TrackSample.__struct_fields__)


def _points_of(
    unit_id: str | InstrumentedAttribute[str], window: Window
) -> tuple[ColumnElement[bool], ...]:
    """Points of one unit in the window; the whole seconds are the table's key, and come first."""
    return (
        TrackPoint.unit_id == unit_id,
        TrackPoint.t_s >= window.from_ns // NS_PER_S,
        TrackPoint.t_s <= window.until_ns // NS_PER_S,
        TrackPoint.t_ns >= window.from_ns,
        TrackPoint.t_ns < window.until_ns,
    )


def _is_in_window(
    window: Window, t_ns: InstrumentedAttribute[int]
) -> tuple[ColumnElement[bool], ColumnElement[bool]]:
    return t_ns >= window.from_ns, t_ns < window.until_ns


def _is_on(incident_id: InstrumentedAttribute[str], site_id: str) -> ColumnElement[bool]:
    """Set for this site: by the name of an incident there, or of none for the station's own."""
    there = select(IncidentRow.incident_id).where(IncidentRow.site_id == site_id)
    is_there = incident_id.in_(there)
    return is_there if site_id else or_(incident_id == "", is_there)


class Records:
    """Thread-safe; every method is one transaction."""

    def __init__(self, store: Database, clock: Clock) -> None:
        self._store = store
        self._clock = clock

    # ---- incidents

    def incidents(self, opened: Window = EVER, limit: int | None = None) -> Sequence[IncidentRow]:
        """Return the incidents opened in the window, newest first (``pages.newest``)."""
        wanted = select(IncidentRow).where(*_is_in_window(opened, IncidentRow.opened_ns))
        with self._store.read() as session:
            return newest(session, wanted, IncidentRow.opened_ns, IncidentRow.incident_id, limit)

    def find_incidents(
        self, query: IncidentQuery, limit: int | None = None
    ) -> Sequence[IncidentRow]:
        """Return the incidents that match the query, newest first (``pages.newest``)."""
        return IncidentSearch(self._store).find(query, limit)

    def incident(self, incident_id: str) -> IncidentRow | None:
        with self._store.read() as session:
            return session.get(IncidentRow, incident_id)

    def incidents_to_erase(self, closed_before_ns: int) -> Sequence[tuple[str, int]]:
        """Incidents that were closed before then and are not erased (``erasure``)."""
        with self._store.read() as session:
            return incidents_to_erase(session, closed_before_ns)

    def require_incident(self, incident_id: str) -> IncidentRow:
        """Return the incident; UserError, with the known ones, where there is none."""
        incident = self.incident(incident_id)
        if incident is None:
            with self._store.read() as session:
                people = person_lookup(load_people(session))
            known = ", ".join(
                f"{one.incident_id} ({shown_text(one.name, people)})" for one in self.incidents()
            )
            raise UserError(f"there is no incident {incident_id}; known are: {known or 'none'}")
        return incident

    def dispatch(self, number: str) -> NoteDispatch | None:
        """Newest report of a dispatch."""
        with self._store.read() as session:
            row = session.get(DispatchRow, number)
            return None if row is None else _REPORTS.decode(row.report)

    def imports_of(self, incident_id: str) -> Sequence[ImportRow]:
        """Files that were brought into an incident, oldest first."""
        wanted = select(ImportRow).where(ImportRow.incident_id == incident_id)
        in_order = wanted.order_by(ImportRow.t_ns, ImportRow.import_id)
        with self._store.read() as session:
            return session.scalars(in_order).all()

    # ---- tracks and alarms

    def track_units(self, window: Window) -> Sequence[str]:
        """Units that have a track in the window."""
        with self._store.read() as session:
            # Unit by unit, by the key: the table holds every second of every incident.
            moved = exists().where(*_points_of(Unit.unit_id, window))
            return session.scalars(select(Unit.unit_id).where(moved).order_by(Unit.unit_id)).all()

    def track(self, unit_id: str, window: Window, every_s: int = 1) -> list[TrackSample]:
        """Return the points of a unit by time; of every ``every_s`` seconds the first one."""
        inside = _points_of(unit_id, window)
        wanted = select(*_TRACK_COLUMNS).where(*inside).order_by(TrackPoint.t_s)
        if every_s > 1:
            first = select(func.min(TrackPoint.t_s)).where(*inside)
            wanted = wanted.where(TrackPoint.t_s.in_(first.group_by(TrackPoint.t_s // every_s)))
        with self._store.read() as session:
            return [TrackSample(*row) for row in session.execute(wanted)]

    def members_of(self, incident: IncidentRow) -> Members:
        """Return the units that were in the incident, with their times."""
        with self._store.read() as session:
            return members_of(session, incident)

    def tracks_of(
        self, incident: IncidentRow, every_s: int = 1
    ) -> Mapping[str, Sequence[TrackSample]]:
        """Track that was shown of every unit while it was in the open incident; each is read when
        it is asked for.
        """
        members = self.members_of(incident)
        units = [
            unit_id
            for unit_id in self.track_units(members.window)
            if members.windows is None or unit_id in members.windows
        ]

        def track(unit_id: str) -> list[TrackSample]:
            windows = members.of(unit_id)
            return [point for one in windows for point in self.track(unit_id, one, every_s)]

        return LastValueMapping(units, track)

    def alarms(
        self, raised: Window, limit: int | None = None, incident: IncidentRow | None = None
    ) -> Sequence[AlarmRow]:
        """Return the alarms raised in the window, newest first (``pages.newest``); with an
        incident, those of its members and of the station itself.
        """
        wanted = select(AlarmRow).where(*_is_in_window(raised, AlarmRow.raised_ns))
        if incident is not None and incident.has_members:
            wanted = wanted.where(was_member(incident, AlarmRow.unit_id, AlarmRow.raised_ns))
        with self._store.read() as session:
            return newest(session, wanted, AlarmRow.raised_ns, AlarmRow.alarm_id, limit)

    def alarm(self, alarm_id: str) -> AlarmRow | None:
        with self._store.read() as session:
            return session.get(AlarmRow, alarm_id)

    def alarm_life(self, alarm_id: str) -> Sequence[AlarmTransition]:
        return self.alarm_lives([alarm_id])[alarm_id]

    def alarm_lives(self, alarm_ids: Collection[str]) -> dict[str, list[AlarmTransition]]:
        """Changes in the life of each alarm, by time."""
        lives: dict[str, list[AlarmTransition]] = {alarm_id: [] for alarm_id in alarm_ids}
        wanted = (
            select(AlarmTransition)
            .where(AlarmTransition.alarm_id.in_(lives))
            .order_by(AlarmTransition.t_ns)
        )
        with self._store.read() as session:
            for change in session.scalars(wanted):
                lives[change.alarm_id].append(change)
        return lives

    # ---- site

    def anchor(self, until_ns: int = FOREVER_NS, site_id: str = "") -> Anchor | None:
        """Return the last anchor of a site set before ``until_ns``; without one, the first set
        later.
        """
        with self._store.read() as session:
            t_ns, is_there = models.AnchorRow.t_ns, _is_on(models.AnchorRow.incident_id, site_id)
            of_site = select(models.AnchorRow).where(is_there)
            before = of_site.where(t_ns < until_ns).order_by(t_ns.desc()).limit(1)
            first = of_site.order_by(t_ns).limit(1)
            row = session.scalars(before).first() or session.scalars(first).first()
        if row is None:
            return None
        return Anchor(row.lat_deg, row.lon_deg, row.height_m, row.plan_rotation_rad)

    def plan(self, until_ns: int = FOREVER_NS, site_id: str = "") -> bytes | None:
        """Return the last plan of a site set before ``until_ns``, as site GeoJSON."""
        with self._store.read() as session:
            return session.scalars(
                select(PlanRow.geojson)
                .where(PlanRow.t_ns < until_ns, _is_on(PlanRow.incident_id, site_id))
                .order_by(PlanRow.t_ns.desc())
                .limit(1)
            ).first()

    # ---- log segments

    def segments(self) -> Sequence[LogSegment]:
        with self._store.read() as session:
            return session.scalars(select(LogSegment).order_by(LogSegment.first_ns)).all()

    def put_segments(self, segments: Iterable[LogSegment]) -> None:
        with self._store.write() as session:
            for segment in segments:
                session.merge(segment)

    def forget_projections(self) -> None:
        """Empty every table that the log can make again."""
        with self._store.write() as session:
            if is_on_server(session):  # there DELETE would visit every row
                names = ", ".join(table.__tablename__ for table in PROJECTIONS)
                session.execute(text(f"TRUNCATE {names}"))
                return
            for table in PROJECTIONS:
                session.execute(delete(table))

    # ---- audit

    def audit(self, by: str, action: str, detail: str) -> None:
        with self._store.write() as session:
            session.execute(
                insert(AuditEntry).values(
                    entry_id=secrets.token_hex(16),
                    t_ns=self._clock.utc_ns(),
                    by=by,
                    action=action,
                    detail=detail,
                )
            )

    def audit_once(self, by: str, done: Mapping[str, tuple[str, str]]) -> None:
        """Add audit entries of actions and details by their ids; existing entries stay."""
        t_ns = self._clock.utc_ns()
        rows = [
            {"entry_id": entry_id, "t_ns": t_ns, "by": by, "action": action, "detail": detail}
            for entry_id, (action, detail) in done.items()
        ]
        with self._store.write() as session:
            session.execute(insert_into(session, AuditEntry).on_conflict_do_nothing(), rows)

    def audited(self, beginnings: Iterable[str]) -> AuditEntry | None:
        """Return the first entry whose id has one of these prefixes."""
        begins = or_(*(AuditEntry.entry_id.startswith(one, autoescape=True) for one in beginnings))
        wanted = select(AuditEntry).where(begins).order_by(AuditEntry.number).limit(1)
        with self._store.read() as session:
            return session.scalars(wanted).first()

    def last_audited(self, action: str, before_ns: int) -> AuditEntry | None:
        """The newest entry of this action that was made before."""
        wanted = select(AuditEntry).where(AuditEntry.action == action, AuditEntry.t_ns < before_ns)
        newest_first = wanted.order_by(AuditEntry.t_ns.desc(), AuditEntry.number.desc()).limit(1)
        with self._store.read() as session:
            return session.scalars(newest_first).first()

    def audit_entries(self, done: Window, limit: int | None = None) -> Sequence[AuditEntry]:
        """Actions in the window, newest first (``pages.newest``)."""
        wanted = select(AuditEntry).where(*_is_in_window(done, AuditEntry.t_ns))
        with self._store.read() as session:
            return newest(session, wanted, AuditEntry.t_ns, AuditEntry.number, limit)
