"""Intake of the stations' reports: summaries go into the picture, events into the tables."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack
from threading import Lock

from base_station.department.live_picture import LivePicture, StationPicture
from base_station.department_wire import (
    EventBatch,
    EventReceipt,
    PersonEvent,
    Summary,
    pack,
    unpack,
)
from base_station.storage.db.department_models import LastSummary, ReportedPerson
from base_station.storage.db.department_tables import DepartmentTables
from base_station.storage.db.known_people import FORGOTTEN, KnownPerson
from shared.bus import Bus
from shared.channels import department_events_key, department_summary_key, reporting_station
from shared.clock import NS_PER_MS, Clock
from shared.coded_text import coded, join_texts
from shared.errors import MusterError, StoreError, WireError
from shared.log_on_change import LogOnChange

logger = logging.getLogger(__name__)


class ReportIntake:
    """Intake; ``open`` it with the bus, and call ``keep_summaries`` regularly, from any thread."""

    def __init__(
        self,
        tables: DepartmentTables,
        picture: LivePicture,
        clock: Clock,
        on_stored: Callable[[], None],
    ) -> None:
        """``on_stored`` is called when events are in the tables, from any thread."""
        self._tables, self._picture, self._clock = tables, picture, clock
        self._on_stored = on_stored
        self._fault_log = LogOnChange(logger, "what stations report is not stored")
        self._lock = Lock()  # guards the fields below
        self._people: dict[tuple[str, str], KnownPerson] = {}
        self._kept_ns: dict[str, int] = {}  # receipt of the summary that is in the tables
        self._unreadable = 0
        for (station, _), person in tables.people().items():
            self._name(station, person)
        for row in tables.last_summaries():
            self._kept_ns[row.station] = row.received_ns
            summary = unpack(row.summary, Summary)
            picture.take(StationPicture.of(row.station, summary, row.received_ns, None))

    def open(self, bus: Bus, closing: ExitStack) -> None:
        closing.callback(bus.subscribe(department_summary_key("*"), self.take_summary).close)
        closing.callback(bus.serve(department_events_key("*"), self.take_events).close)

    @property
    def problem(self) -> str:
        """Sentence for a person; empty if everything is stored."""
        unreadable = ""
        if self._unreadable:
            unreadable = coded(
                "department-reports-unreadable",
                "{count} reports of stations could not be read: is this Muster older?",
                count=self._unreadable,
            )
        return join_texts((self._fault_log.fault, unreadable))

    def person(self, station: str, person_id: str) -> KnownPerson:
        """Name of a station's person; the id if no name was ever reported."""
        with self._lock:
            known = self._people.get((station, person_id))
        return known or KnownPerson(f"person {person_id[:8]}" if person_id else "")

    def take_summary(self, key: str, payload: bytes) -> None:
        now_ns, monotonic_ns = self._clock.utc_ns(), self._clock.monotonic_ns()
        try:
            station, summary = reporting_station(key), unpack(payload, Summary)
        except MusterError as error:
            self._note_unreadable(key, error)
            return
        self._picture.take(StationPicture.of(station, summary, now_ns, monotonic_ns))

    def take_events(self, key: str, _: str, payload: bytes) -> Iterable[bytes]:
        """Answer a batch with a receipt, once the batch is on disk."""
        return self._receipts(key, payload)

    def _receipts(self, key: str, payload: bytes) -> Iterator[bytes]:
        now_ns = self._clock.utc_ns()
        try:
            station, batch = reporting_station(key), unpack(payload, EventBatch)
        except MusterError as error:
            self._note_unreadable(key, error)
            return
        offset_ms = batch.t_ms - now_ns // NS_PER_MS
        try:
            reported = self._tables.take(station, batch, offset_ms, now_ns)
            for person in reported.people:
                self._name(station, person)
        except WireError as error:
            self._note_unreadable(key, error)
            yield pack(EventReceipt(batch.epoch, 0, f"the department cannot read it: {error}"))
        except StoreError as error:
            self._fault_log.note_failure(error)
            yield pack(EventReceipt(batch.epoch, 0, f"the department does not store it: {error}"))
        else:
            self._fault_log.note_success()
            self._on_stored()
            yield pack(EventReceipt(batch.epoch, reported.last_seq))

    def keep_summaries(self) -> None:
        """Write the summaries that are newer than those in the tables.  Raises StoreError."""
        rows = []
        for station, pictures in self._picture.all().items():
            newest = max(pictures, key=lambda one: one.received_ns)
            if newest.received_ns > self._kept_ns.get(station, 0):
                rows.append(
                    LastSummary(
                        station=station,
                        received_ns=newest.received_ns,
                        summary=pack(newest.summary),
                    )
                )
        if rows:
            self._tables.keep_summaries(rows)
        self._kept_ns |= {row.station: row.received_ns for row in rows}

    def _name(self, station: str, person: ReportedPerson | PersonEvent) -> None:
        known = KnownPerson(person.name, person.crew, person.role) if person.name else FORGOTTEN
        with self._lock:
            self._people[station, person.person_id] = known

    def _note_unreadable(self, key: str, error: MusterError) -> None:
        self._unreadable += 1
        logger.warning("%s: %s", key, error)
