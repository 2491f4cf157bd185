"""A database on a full disk opens, takes changes in memory, and writes them when there is room."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path

import pytest
from sqlalchemy import select

from base_station.accounts.principals import Role
from base_station.storage.db import memory_copy
from base_station.storage.db.accounts import Accounts
from base_station.storage.db.models import User
from base_station.storage.db.projecting import project_into
from base_station.storage.db.projection import SqlProjection
from base_station.storage.db.records import Records
from base_station.storage.db.roster import Roster
from base_station.storage.db.store import Store
from base_station.storage.db.window import FOREVER_NS, Window
from base_station.storage.projection import Projection
from shared.clock import NS_PER_S, ManualClock
from shared.errors import DiskFullError, StoreError, UserError
from shared.messages import Header, OperatorAction
from shared.messages.station import OpenIncident
from tests.rig import message_factory
from tests.rig.full_disk import files_of_at_most
from tests.rig.quick_hash import QUICK_HASH
from tests.rig.waiting import until

PASSWORD = "something long enough"


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "station.sqlite"


@pytest.fixture(autouse=True)
def _tried_at_every_change(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("base_station.storage.db.store._RETRY_S", 0.0)


def accounts_of(store: Store, clock: ManualClock) -> Accounts:
    return Accounts(store, clock, QUICK_HASH)


@contextmanager
def a_user(path: Path, clock: ManualClock) -> Iterator[None]:
    """Mia may log in; the disk takes nothing within the block."""
    with Store(path) as store:
        accounts_of(store, clock).add_user("mia", PASSWORD, Role.ADMINISTRATOR)
    with files_of_at_most(0):
        yield


def on_disk(path: Path, query: str) -> list[tuple[object, ...]]:
    with closing(sqlite3.connect(path)) as reading:
        return reading.execute(query).fetchall()


def test_session_made_on_a_full_disk_is_valid_once_there_is_room(
    path: Path, clock: ManualClock
) -> None:
    with a_user(path, clock):
        with pytest.raises(DiskFullError, match="cannot be opened"):  # of a command, say
            Store(path)
        store = Store(path, memory_fallback=True)
        accounts = accounts_of(store, clock)
        secret = accounts.log_in("mia", PASSWORD)
        assert secret is not None
        Roster(store, clock).add_person("Ada", "A", "")
        assert "kept in memory" in store.problem
        assert "lost if the station stops" in store.problem
        with pytest.raises(DiskFullError):  # no byte is to be left of what is forgotten
            store.compact()
    store.check_disk()
    assert (store.in_memory, store.problem) == (False, "")
    assert accounts.of_session(secret)
    store.close()
    with Store(path) as again:
        assert accounts_of(again, clock).of_session(secret)
        assert [one.name for one in Roster(again, clock).people()] == ["Ada"]


def test_change_that_finds_the_disk_full_is_applied(path: Path, clock: ManualClock) -> None:
    with Store(path, memory_fallback=True) as store:
        accounts = accounts_of(store, clock)
        accounts.add_user("mia", PASSWORD, Role.ADMINISTRATOR)
        with files_of_at_most(0):
            secret = accounts.log_in("mia", PASSWORD)
            assert store.problem
            assert secret is not None
            assert accounts.of_session(secret)
        store.check_disk()
        assert not store.problem
        assert accounts.of_session(secret)
        assert on_disk(path, "SELECT username FROM sessions") == [("mia",)]


def test_concurrent_changes_of_the_file_are_kept_and_conflicts_reported(
    path: Path, clock: ManualClock
) -> None:
    with a_user(path, clock):
        store = Store(path, memory_fallback=True)
        accounts_of(store, clock).add_user("bob", PASSWORD, Role.VIEWER)
        accounts_of(store, clock).add_user("eve", PASSWORD, Role.VIEWER)
    with Store(path) as other:  # ``muster base users`` finds room a moment earlier
        accounts_of(other, clock).add_user("bob", PASSWORD, Role.COMMANDER)
    store.check_disk()
    with store:
        users = {one.username: one.role for one in accounts_of(store, clock).users()}
        assert users == {"mia": "administrator", "bob": "commander", "eve": "viewer"}
        assert "1 changes" in store.problem
        with pytest.raises(UserError):  # what is wrong of itself is refused as ever
            accounts_of(store, clock).add_user("bob", PASSWORD, Role.VIEWER)


def test_decisions_during_a_full_disk_are_shown_and_written_later(
    path: Path, clock: ManualClock
) -> None:
    def opened(t_s: int) -> Projection:
        header = Header("station", 1, t_s, 1, t_utc_ns=t_s * NS_PER_S)
        action = OperatorAction(header, f"a{t_s}", "mia", OpenIncident(f"i-{t_s}", "Kitchen"))
        walked = message_factory.fused(header, "FF-01", north_m=float(t_s))
        return Projection(t_s * NS_PER_S, actions=(action,), tracks=(walked,))

    window = Window(0, FOREVER_NS)
    with a_user(path, clock):
        store = Store(path, memory_fallback=True)
        projection, records = SqlProjection(store), Records(store, clock)
        for t_s in (1, 2):
            projection.project(opened(t_s))
            assert projection.flush()
            assert len(records.incidents()) == t_s
        assert "kept in memory" in projection.problem()
        assert [point.north_m for point in records.track("FF-01", window)] == [1.0, 2.0]
    until(lambda: not store.in_memory, "it is written again without a restart")
    projection.project(opened(3))
    until(lambda: projection.flush() and len(records.incidents()) == 3)
    assert projection.problem() == ""
    projection.close()
    store.close()
    assert on_disk(path, "SELECT count(*) FROM incidents") == [(3,)]
    assert on_disk(path, "SELECT north_m FROM tracks ORDER BY t_s") == [(1.0,), (2.0,), (3.0,)]


def test_open_query_in_memory_continues_when_the_disk_has_room(
    path: Path, clock: ManualClock
) -> None:
    with a_user(path, clock):
        store = Store(path, memory_fallback=True)
    with store.read() as session:  # which asks nothing until then
        store.check_disk()
        assert not store.in_memory
        assert session.scalars(select(User.username)).all() == ["mia"]
    assert [user.username for user in accounts_of(store, clock).users()] == ["mia"]
    store.close()


def test_missing_database_is_created_once_there_is_room(path: Path, clock: ManualClock) -> None:
    with files_of_at_most(0):
        store = Store(path, memory_fallback=True)
        accounts_of(store, clock).add_user("mia", PASSWORD, Role.ADMINISTRATOR)
    store.check_disk()
    assert not store.in_memory
    store.close()
    assert on_disk(path, "SELECT username FROM users") == [("mia",)]
    assert on_disk(path, "PRAGMA integrity_check") == [("ok",)]
    assert [one.name for one in path.parent.iterdir()] == [path.name]


def test_tracks_of_a_large_database_are_not_copied_to_memory(
    path: Path, clock: ManualClock, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(memory_copy, "WHOLE_BYTES_MAX", 10_000)
    with Store(path) as store, store.write() as session:
        walk = Projection(
            NS_PER_S, tracks=(message_factory.fused(Header("s", 1, 1, 1, t_utc_ns=1), "FF-01"),)
        )
        assert project_into(session, (walk,)) == 0
    with a_user(path, clock):
        store = Store(path, memory_fallback=True)
        assert accounts_of(store, clock).log_in("mia", PASSWORD)
        assert Records(store, clock).track("FF-01", Window(0, FOREVER_NS)) == []
        assert "trails of past incidents cannot be shown" in store.problem
    store.check_disk()
    with store:
        assert len(Records(store, clock).track("FF-01", Window(0, FOREVER_NS))) == 1


def test_hanging_disk_does_not_block_the_database_in_memory(path: Path, clock: ManualClock) -> None:
    hangs = False
    with a_user(path, clock):
        store = Store(path, lambda: hangs, memory_fallback=True)
    hangs = True
    assert accounts_of(store, clock).log_in("mia", PASSWORD)
    assert store.in_memory, "it is not asked anything either"
    hangs = False
    store.close()
    assert on_disk(path, "SELECT count(*) FROM sessions") == [(1,)], "it was looked at to the end"


def test_database_unwritable_for_another_reason_is_refused(path: Path) -> None:
    path.mkdir()
    with pytest.raises(StoreError, match=r"unable to open.*can be written"):
        Store(path, memory_fallback=True)
