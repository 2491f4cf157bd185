"""A database on a hanging disk blocks nobody, and reports the reason."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager
from pathlib import Path
from threading import Event, Thread

import pytest
from sqlalchemy.orm import Session

from base_station.storage.db.projection import SqlProjection
from base_station.storage.db.store import Store
from base_station.storage.projection import Projection
from shared.errors import StoreError
from tests.rig.waiting import PATIENCE_S


@pytest.fixture
def hangs() -> Event:
    return Event()


@pytest.fixture
def store(tmp_path: Path, hangs: Event) -> Iterator[Store]:
    with Store(tmp_path / "station.sqlite", hangs.is_set) as store:
        yield store


def test_hanging_disk_gets_no_further_queries(store: Store, hangs: Event) -> None:
    hangs.set()

    def refused(asking: AbstractContextManager[Session]) -> None:
        with pytest.raises(StoreError, match="does not answer"), asking:
            pytest.fail("it was asked")

    refused(store.read())
    refused(store.write())
    with pytest.raises(StoreError, match="does not answer"):
        store.compact()
    hangs.clear()
    with store.read(), store.write():
        pass


def test_wait_for_a_query_on_a_hanging_disk_is_reported(store: Store, hangs: Event) -> None:
    reported: list[str] = []

    def change() -> None:
        try:
            with store.write():
                reported.append("done")
        except StoreError as error:
            reported.append(str(error))

    with store.write():
        waiting = Thread(target=change, daemon=True)
        waiting.start()
        hangs.set()
        waiting.join(PATIENCE_S)
        assert len(reported) == 1
        assert "does not answer" in reported[0]
    hangs.clear()
    change()
    assert reported[1:] == ["done"]


def test_write_to_a_hanging_disk_is_not_waited_for(store: Store, hangs: Event) -> None:
    projection = SqlProjection(store)
    try:
        hangs.set()
        projection.project(Projection(t_ns=1))
        assert not projection.flush(timeout_s=3600.0)
        hangs.clear()
        assert projection.flush(PATIENCE_S)
    finally:
        projection.close()
