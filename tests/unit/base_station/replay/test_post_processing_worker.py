"""Recently closed incidents are post-processed beside the station, which does not wait for it."""

from __future__ import annotations

import threading
from collections.abc import Iterable, Iterator
from typing import cast

import pytest

from base_station.replay import post_processing_worker
from base_station.replay.post_processing import PostProcessor
from base_station.replay.post_processing_worker import PostProcessingWorker
from base_station.replay.solved_tracks import Tracks
from base_station.storage.db.models import IncidentRow
from shared.errors import StoreError

WAIT_S = 20.0


@pytest.fixture(autouse=True)
def often(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(post_processing_worker, "EVERY_S", 0.001)
    monkeypatch.setattr(post_processing_worker, "GRACE_S", 0.001)


class LongWork:
    """Work of a long incident."""

    def __init__(self) -> None:
        self.begun = threading.Event()
        self.over = threading.Event()
        self.ended = threading.Event()

    def catch_up(self, incidents: Iterable[IncidentRow], _shown: object) -> None:
        assert [one.incident_id for one in incidents] == ["i1"]
        self.begun.set()
        assert self.over.wait(WAIT_S)
        self.ended.set()


@pytest.fixture
def work() -> Iterator[LongWork]:
    work = LongWork()
    yield work
    work.over.set()
    assert not work.begun.is_set() or work.ended.wait(WAIT_S)


def incidents() -> list[IncidentRow]:
    return [IncidentRow(incident_id="i1", name="Mill Lane", opened_ns=1, closed_ns=2)]


def shown(_incident: IncidentRow) -> Tracks:
    return {}


def test_stopping_station_does_not_wait_for_repeatable_work(
    work: LongWork,
) -> None:
    with PostProcessingWorker(cast("PostProcessor", work), incidents, shown):
        assert work.begun.wait(WAIT_S)
    assert not work.ended.is_set()


def test_unreadable_database_is_retried(work: LongWork, caplog: pytest.LogCaptureFixture) -> None:
    tries: list[int] = []

    def at_last() -> list[IncidentRow]:
        tries.append(1)
        if len(tries) < 3:
            raise StoreError("the disk does not answer")
        return incidents()

    with PostProcessingWorker(cast("PostProcessor", work), at_last, shown):
        assert work.begun.wait(WAIT_S)
    reported = [one.message for one in caplog.records]
    assert reported == ["what closed lately cannot be looked up: the disk does not answer"]
