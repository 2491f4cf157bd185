"""A station whose database server is killed or frozen continues, reports it, and lacks nothing
after.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import httpx
import pytest
from sqlalchemy import select, text

from base_station.app.factories import project_whole_log
from base_station.storage.db.database import Database
from base_station.storage.db.models import (
    AlarmTransition,
    Assignment,
    AuditEntry,
    Base,
    IncidentRow,
    PersonRow,
    TrackPoint,
)
from base_station.storage.db.projection import Missing, SqlProjection
from base_station.storage.db.server_address import ServerAddress
from base_station.storage.db.server_store import ServerStore
from base_station.storage.db.store import Store
from base_station.storage.projection_mark import ProjectionMark
from shared.errors import DatabaseAwayError, StoreError
from tests.rig.database_server import DatabaseServer, database_server
from tests.rig.projected_story import STORY
from tests.rig.served_station import MakePosition, Served, served_station
from tests.rig.station_command import Command
from tests.rig.waiting import PATIENCE_S, until
from tests.rig.watched_walk import Walk, logged, login, post

AWAY = "database server does not answer"
DECIDED = (TrackPoint, AlarmTransition, Assignment, IncidentRow)


@pytest.fixture(scope="module")
def server() -> Iterator[DatabaseServer]:
    with database_server() as server:
        yield server


@pytest.fixture
def address(server: DatabaseServer, tmp_path: Path) -> ServerAddress:
    return server.new_database(tmp_path)


@pytest.fixture
def served(address: ServerAddress, tmp_path: Path, make_position: MakePosition) -> Iterator[Served]:
    settings = tmp_path / "station.toml"
    lines = (f'database = "{address.url}"', f'database_password_file = "{address.password_file}"')
    settings.write_text("\n".join(lines))
    data, output = tmp_path / "station", tmp_path / "output.txt"
    with served_station(data, output, make_position, "--config", str(settings)) as served:
        yield served


def rows(store: Database, table: type[Base]) -> list[str]:
    with store.read() as session:
        return sorted(map(repr, session.execute(select(table.__table__))))


def test_station_continues_without_its_database_and_updates_it_afterwards(
    served: Served, server: DatabaseServer, address: ServerAddress, tmp_path: Path
) -> None:
    station, browser, unit, data, _ = served
    assert not (data / "station.sqlite").exists()
    with ExitStack() as walking:
        walk = Walk(browser, unit, walking)
        until(lambda: walk.shown > 5)
        server.kill()
        try:
            until(lambda: any(AWAY in one for one in walk.problems), "it is told")
            refused = login(browser, data)
            assert (refused.status_code, AWAY in refused.json()["detail"]) == (503, True)
            assert httpx.get(browser.address, timeout=PATIENCE_S).is_success
            walk.press_mayday()
            until(lambda: walk.alarms.get("mayday") == "raised", "mayday is raised")
            everybody_out = {"kind": "evacuate", "target": {"everyone": True}}
            assert post(browser, "/commands", everybody_out, browser.cookie()).is_success
            mayday = walk.seen["mayday"]
            as_seen = {"last_raised_ms": mayday["last_raised_ms"]}
            acknowledge = f"/alarms/{mayday['alarm_id']}/acknowledge"
            assert post(browser, acknowledge, as_seen, browser.cookie()).is_success
            until(lambda: walk.alarms.get("mayday") == "acknowledged")
            shown = walk.shown
            until(lambda: walk.shown > shown + 20, "the picture goes on")
        finally:
            server.start()
        until(lambda: not any(AWAY in one for one in walk.problems), "it is over")
        assert login(browser, data).is_success
        with server.frozen():
            until(lambda: any(AWAY in one for one in walk.problems), "it is told")
            shown = walk.shown
            until(lambda: walk.shown > shown + 20, "the picture goes on")
        until(lambda: not any(AWAY in one for one in walk.problems), "it is over")
        assert login(browser, data).is_success
    assert station.stop() == 0
    assert server.password not in station.output()
    there = logged(data / "log")
    assert len(there) == len(set(there))
    assert walk.stated <= set(there)
    require_all(address, data, tmp_path)
    with ServerStore(address) as store, store.read() as session:
        assert session.scalars(select(PersonRow.name)).all() == ["Ada"]


def require_all(address: ServerAddress, data: Path, scratch: Path) -> None:
    """The server has what the log knows, once."""
    with ServerStore(address) as store, Store(scratch / "log.sqlite") as of_log:
        project_whole_log(of_log, data / "log", lambda _: None)
        for table in DECIDED:
            assert rows(store, table) == rows(of_log, table)
        with store.read() as session, of_log.read() as reading:
            by_log = set(reading.scalars(select(AuditEntry.entry_id)))
            assert by_log <= set(session.scalars(select(AuditEntry.entry_id)))


def test_rows_missing_after_a_kill_are_projected_from_the_log(
    served: Served, server: DatabaseServer, address: ServerAddress, tmp_path: Path
) -> None:
    station, browser, unit, data, flags = served
    with ExitStack() as walking:
        walk = Walk(browser, unit, walking)
        until(lambda: walk.shown > 5)
        server.kill()
        try:
            walk.press_mayday()
            until(lambda: walk.alarms.get("mayday") == "raised", "mayday is raised")
            until((data / "tables-behind").exists, "it is noted")
            station.kill()
        finally:
            server.start()
    with Command(tmp_path / "again.txt", *flags) as again:
        again.wait_ready()
        until(lambda: not (data / "tables-behind").exists(), "the tables have all")
        assert again.stop() == 0
    require_all(address, data, tmp_path)
    with ServerStore(address) as store:
        assert rows(store, AlarmTransition)


def test_rows_beyond_the_queue_are_missing_until_projected_again(
    server: DatabaseServer,
    address: ServerAddress,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("base_station.storage.db.projection.MAX_PENDING", len(STORY) - 2)
    mark = ProjectionMark(tmp_path / "tables-behind")
    with ServerStore(address, is_station=True) as store:
        projection = SqlProjection(store, mark)
        server.stop()
        try:
            projection.project(STORY[0])
            assert not projection.flush()
            until(lambda: mark.since_ns() == STORY[0].t_ns)
            until(lambda: projection.is_behind)
            for part in STORY[1:]:
                projection.project(part)
            assert projection.missing() is None  # the database is away still
        finally:
            server.start()
        until(lambda: projection.flush(1.0), "the others are written")
        until(lambda: projection.missing() is not None)
        assert "is being brought into it from the log" in projection.problem()
        missing = projection.missing()
        assert missing == Missing(STORY[0].t_ns, 2)
        projection.note_caught_up(missing)
        assert projection.problem() == ""
        assert mark.since_ns() is None
        until(lambda: not projection.is_behind)
        projection.close()


@pytest.fixture(scope="module")
def others(server: DatabaseServer) -> str:
    """A user who may do nothing in others' tables."""
    server.execute(f"CREATE ROLE guest LOGIN PASSWORD '{server.password}'")
    return "guest"


@pytest.mark.parametrize(
    ("setting", "reason"),
    [
        ("wrong password", "password authentication failed"),
        ("no such database", "does not exist"),
        ("a newer program's", "a newer Muster wrote it"),
        ("read-only", "can only be read"),
        ("another user's", "permission denied"),
        ("another text", "ENCODING 'UTF8'"),
    ],
)
def test_unusable_server_is_refused_without_naming_the_password(
    server: DatabaseServer, tmp_path: Path, others: str, setting: str, reason: str
) -> None:
    address = server.new_database(tmp_path)
    name = address.url.split("/")[3].split("?")[0]
    user = "fire"
    match setting:
        case "wrong password":
            Path(address.password_file).write_text("guessed\n")
        case "no such database":
            name = "none"
        case "a newer program's":
            ServerStore(address).close()
            server.execute("UPDATE alembic_version SET version_num = '9999'", name)
        case "read-only":
            server.execute(f"ALTER DATABASE {name} SET default_transaction_read_only = on")
        case "another user's":
            user = others
        case _:
            name = "latin"
            server.execute("CREATE DATABASE latin TEMPLATE template0 ENCODING 'LATIN1' LOCALE 'C'")
    wanted = ServerAddress(server.url(name, user), address.password_file)
    with pytest.raises(StoreError, match=reason) as refused:
        ServerStore(wanted, is_station=True)
    assert server.password not in str(refused.value)
    assert "guessed" not in str(refused.value)


def test_missing_server_is_reported_at_the_start(tmp_path: Path) -> None:
    address = ServerAddress(f"postgresql+psycopg://fire@/muster?host={tmp_path}")
    with pytest.raises(DatabaseAwayError, match=r"does not answer.*see address, user"):
        ServerStore(address)


def test_two_stations_do_not_share_a_database(
    address: ServerAddress, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("base_station.storage.db.server_store.STATION_WAIT_S", 1)
    with (
        ServerStore(address, is_station=True),
        ServerStore(address),  # a command beside it
        pytest.raises(StoreError, match="another station works with"),
    ):
        ServerStore(address, is_station=True)
    ServerStore(address, is_station=True).close()


def test_full_disk_of_the_server_is_reported_and_loses_nothing(
    address: ServerAddress, server: DatabaseServer
) -> None:
    """A trigger refuses with the code and the words of a server whose disk is full."""
    name = address.url.split("/")[3].split("?")[0]
    with ServerStore(address, is_station=True) as store:
        server.execute(
            "CREATE FUNCTION full_disk() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN RAISE "
            "EXCEPTION 'could not extend file' USING ERRCODE = 'disk_full'; END $$",
            name,
        )
        server.execute(
            "CREATE TRIGGER full_disk BEFORE INSERT ON units EXECUTE FUNCTION full_disk()", name
        )
        projection = SqlProjection(store)
        try:
            for part in STORY:
                projection.project(part)
            assert not projection.flush()
            assert "could not extend file" in projection.problem()
            assert "free the disk of the database server" in projection.problem()
            server.execute("DROP TRIGGER full_disk ON units", name)
            until(lambda: projection.flush(1.0), "it is written")
            assert projection.problem() == ""
        finally:
            projection.close()
        with store.read() as session:
            assert session.scalar(text("SELECT count(*) FROM units")) == 3
