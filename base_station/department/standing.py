"""Present alarms and incidents from the department's tables, kept in memory.

A thread of its own reads them again after events came.  So no request waits for the database; while
that cannot be reached, the last reading is shown.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from base_station.storage.db.department_models import ReportedAlarm, ReportedIncident
from base_station.storage.db.department_tables import DepartmentTables
from shared.worker import UNTIL_WOKEN, Worker

_INCIDENTS_SHOWN = 200
_ALARMS_SHOWN = 200
_APART_S = 0.1  # between two readings: many events come at once
_CLOSE_S = 20.0  # a server that does not answer is given up before


class Standing(NamedTuple):
    """Reports of stations according to one reading."""

    alarms: Sequence[ReportedAlarm]  # that are not resolved, the gravest and newest
    open_alarms: int  # all of them
    incidents: Sequence[ReportedIncident]  # open ones first, then the newest
    missing: Mapping[str, int]  # events that never came, by station


class StandingReports:
    """Reader of the reports; ``start`` once, and ``wake`` when events were stored."""

    def __init__(self, tables: DepartmentTables) -> None:
        """Raises StoreError."""
        self._tables = tables
        self._reading = Worker(
            "department-standing", self._step, "alarms and incidents are shown as last read"
        )
        self.read()

    @property
    def current(self) -> Standing:
        return self._current

    def start(self) -> None:
        self._reading.start()

    def wake(self) -> None:
        """Ask for a new reading.  Thread-safe."""
        self._reading.wake()

    def close(self) -> None:
        self._reading.close(_CLOSE_S)

    def read(self) -> None:
        """Read the tables.  Raises StoreError; then the last reading stays."""
        alarms, open_alarms = self._tables.open_alarms(_ALARMS_SHOWN)
        incidents, missing = self._tables.incidents(_INCIDENTS_SHOWN), self._tables.missing()
        self._current = Standing(alarms, open_alarms, incidents, missing)

    def _step(self) -> float:
        self._reading.stopping.wait(_APART_S)
        self.read()
        return UNTIL_WOKEN
