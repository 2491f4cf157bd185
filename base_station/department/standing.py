"""Alarms and incidents of the department's tables as they stand, kept in memory.

They are read again by a thread of its own after events came.  So no request waits for the
database, and while that is away what was read last is shown.
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
    """Reports of stations, as of one reading."""

    alarms: Sequence[ReportedAlarm]  # that are not resolved, the gravest and newest
    open_alarms: int  # all of them
    incidents: Sequence[ReportedIncident]  # open ones first, then the newest
    missing: Mapping[str, int]  # events that never came, by station


class StandingReports:
    """``wake`` it when events were stored; ``start`` once."""

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
        """From any thread."""
        self._reading.wake()

    def close(self) -> None:
        self._reading.close(_CLOSE_S)

    def read(self) -> None:
        """Raises StoreError, and then what was read before stays."""
        alarms, open_alarms = self._tables.open_alarms(_ALARMS_SHOWN)
        incidents, missing = self._tables.incidents(_INCIDENTS_SHOWN), self._tables.missing()
        self._current = Standing(alarms, open_alarms, incidents, missing)

    def _step(self) -> float:
        self._reading.stopping.wait(_APART_S)
        self.read()
        return UNTIL_WOKEN
