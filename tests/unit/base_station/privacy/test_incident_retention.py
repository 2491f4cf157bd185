"""Retention of incidents: the oldest that is over its time is erased, one after the other."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import cast

import pytest

from base_station.privacy.erasure_queue import ErasureJob, ErasureQueue, ErasureState
from base_station.privacy.incident_retention import (
    BY_RETENTION,
    POLL_INTERVAL_S,
    IncidentRetention,
)
from base_station.storage.db.erasure import FORGOT_INCIDENT
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.records import Records
from base_station.storage.db.store import Store
from shared.clock import NS_PER_DAY, NS_PER_S, ManualClock
from shared.errors import UserError

KEPT_DAYS = 30


@dataclass
class StubQueue:
    jobs: list[ErasureJob] = field(default_factory=list)

    def all(self) -> tuple[ErasureJob, ...]:
        return tuple(self.jobs)


class Retention:
    """A retention of 30 days over a database, with erasures that a test ends."""

    def __init__(self, store: Store, clock: ManualClock) -> None:
        self.store, self.clock = store, clock
        self.records = Records(store, clock)
        self.queue = StubQueue()
        self.refusal = ""
        self._retention = IncidentRetention(
            KEPT_DAYS * NS_PER_DAY,
            self.records,
            cast("ErasureQueue", self.queue),
            self._accept,
            clock,
        )

    def add(self, incident_id: str, days_ago: float | None) -> None:
        """An incident that was closed so long ago; None: it is open."""
        now_ns = self.clock.utc_ns()
        closed_ns = None if days_ago is None else now_ns - round(days_ago * NS_PER_DAY)
        with self.store.write() as session:
            session.add(
                IncidentRow(
                    incident_id=incident_id, name="", opened_ns=1, opened_by="", closed_by="",
                    closed_ns=closed_ns,
                )
            )  # fmt: skip

    def request_next(self) -> list[str]:
        """Ids of all erasures after the next check."""
        self.clock.advance(POLL_INTERVAL_S)
        self._retention.request_next()
        return [job.subject_id for job in self.queue.jobs]

    def finish(self) -> None:
        """The erasure under way is done."""
        job = self.queue.jobs[-1]
        job.state = ErasureState.DONE
        self.records.audit(BY_RETENTION, FORGOT_INCIDENT, f"incident {job.subject_id}: 7 records")

    def bring_late_data(self, incident_id: str) -> None:
        self.clock.advance(1.0)
        with self.store.write() as session:
            row = session.get(IncidentRow, incident_id)
            assert row is not None
            row.late_data_ns = self.clock.utc_ns()

    def _accept(self, incident_id: str) -> ErasureJob:
        if self.refusal:
            raise UserError(self.refusal)
        job = ErasureJob("f1", BY_RETENTION, "incident", incident_id, ErasureState.WORKING)
        self.queue.jobs.append(job)
        return job


@pytest.fixture
def retention(tmp_path: Path) -> Iterator[Retention]:
    with Store(tmp_path / "station.sqlite") as store:
        yield Retention(store, ManualClock())


def test_incidents_over_their_time_are_erased_oldest_first_and_once(retention: Retention) -> None:
    retention.add("young", 29.9)
    retention.add("old", 31.0)
    retention.add("oldest", 400.0)
    retention.add("open", None)
    assert retention.request_next() == ["oldest"]
    assert retention.request_next() == ["oldest"], "one at a time"
    retention.finish()
    assert retention.request_next() == ["oldest", "old"]
    retention.finish()
    assert retention.request_next() == ["oldest", "old"]
    retention.clock.advance(0.2 * NS_PER_DAY / NS_PER_S)
    assert retention.request_next() == ["oldest", "old", "young"]


def test_erased_incident_is_erased_again_for_late_data(retention: Retention) -> None:
    retention.add("old", 31.0)
    retention.request_next()
    retention.finish()
    retention.bring_late_data("old")
    assert retention.request_next() == ["old", "old"]
    retention.finish()
    assert retention.request_next() == ["old", "old"]


def test_refusal_is_tried_again(retention: Retention) -> None:
    """While an incident is open nothing is erased."""
    retention.add("old", 31.0)
    retention.refusal = "The incident Mill Lane is open; close it first."
    assert retention.request_next() == []
    retention.refusal = ""
    assert retention.request_next() == ["old"]


def test_failed_erasure_is_not_tried_forever(retention: Retention) -> None:
    retention.add("old", 31.0)
    retention.request_next()
    retention.queue.jobs[-1].state = ErasureState.FAILED
    assert retention.request_next() == ["old"]
