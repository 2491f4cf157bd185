"""A folder whose tables are on a PostgreSQL server: moved there, used, and brought back."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from sqlalchemy import delete, select, update

from base_station.accounts.principals import Role
from base_station.app import folder_commands
from base_station.app.backup import back_up
from base_station.app.factories import project_since
from base_station.app.pipeline_factory import past_pipeline
from base_station.app.station_storage import open_storage
from base_station.config import StationConfig
from base_station.engine.log_feed import FolderFeed
from base_station.privacy.erasure_queue import ErasureJob
from base_station.replay.playback import Archive
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.accounts import Accounts
from base_station.storage.db.database import Database
from base_station.storage.db.models import (
    PROJECTIONS,
    AlarmRow,
    AlarmTransition,
    Assignment,
    Base,
    LogSegment,
    TrackPoint,
)
from base_station.storage.db.opening import open_database
from base_station.storage.db.records import Records
from base_station.storage.db.server_address import NOTE, ServerAddress
from base_station.storage.db.server_store import ServerStore
from base_station.storage.db.store import Store
from base_station.storage.projection_mark import ProjectionMark
from base_station.storage.recorder import Recorder
from base_station.unit_sync.recordings.transfer_queue import TransferQueue
from shared.clock import SystemClock
from shared.config import load_config
from shared.errors import ConfigError, StoreError
from tests.rig.database_server import DatabaseServer, database_server
from tests.rig.erasure_scenario import ErasureScenario
from tests.rig.quick_hash import QUICK_HASH

LOGGED = [table for table in PROJECTIONS if table is not LogSegment]


@pytest.fixture(scope="module")
def server() -> Iterator[DatabaseServer]:
    with database_server() as server:
        yield server


@pytest.fixture(scope="module")
def stated(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A station's folder with people in it, whose tables are in a file."""
    folder = ErasureScenario(tmp_path_factory.mktemp("told") / "station", older=False).folder
    with Store(folder / "station.sqlite") as store:
        accounts = Accounts(store, SystemClock(), QUICK_HASH)
        accounts.add_user("ada", "a long password", Role.ADMINISTRATOR)
    return folder


@pytest.fixture
def address(server: DatabaseServer, tmp_path: Path) -> ServerAddress:
    return server.new_database(tmp_path)


@pytest.fixture
def moved(stated: Path, address: ServerAddress, tmp_path: Path) -> Path:
    """The folder, once a station has run on it with the server in its settings."""
    folder = tmp_path / "station"
    shutil.copytree(stated, folder)
    announced = start(folder, address)
    assert any("were copied from" in line for line in announced)
    assert start(folder, address) == []
    return folder


def start(folder: Path, server: ServerAddress | None) -> list[str]:
    """Open a station's storage and close it; what was announced."""
    announced: list[str] = []
    clock = SystemClock()
    with ExitStack() as closing:
        recorder = Recorder(folder, clock)
        closing.callback(recorder.close)
        data = DataFolder(folder)
        open_storage(data, recorder, clock, announced.append, closing, server)
    return announced


def rows(store: Database, tables: list[type[Base]]) -> dict[str, list[str]]:
    with store.read() as session:
        return {
            table.__tablename__: sorted(map(repr, session.execute(select(table.__table__))))
            for table in tables
        }


def test_tables_are_moved_to_the_server_and_restored_from_a_backup(
    moved: Path, stated: Path, address: ServerAddress, tmp_path: Path
) -> None:
    kept = [one.class_ for one in Base.registry.mappers if one.class_ not in PROJECTIONS]
    with Store(stated / "station.sqlite") as file, ServerStore(address) as store:
        assert rows(store, LOGGED) == rows(file, LOGGED)
        assert rows(store, kept) == rows(file, kept)
    back_up(moved, tmp_path / "backup", lambda _: None)
    assert not (tmp_path / "backup" / NOTE).exists()
    with Store(tmp_path / "backup" / "station.sqlite") as copy, ServerStore(address) as store:
        everything = [*PROJECTIONS, *kept]
        assert rows(copy, everything) == rows(store, everything)
    back_up(moved, tmp_path / "backup", lambda _: None)


def test_commands_on_the_folder_find_the_server_by_its_stored_address(
    moved: Path, address: ServerAddress
) -> None:
    (moved / "station.sqlite").unlink()  # which nothing needs any more
    with ExitStack() as closing:
        _, records = folder_commands.open_accounts(moved, closing)
        (incident,) = records.incidents()
        context = folder_commands.open_post_processing(
            moved, incident.incident_id, closing, pytest.fail, lambda _: None
        )
        assert context.people
        assert context.keeps_result
    with ServerStore(address) as store:
        before = rows(store, LOGGED)
        assert folder_commands.rebuild(moved, lambda _: None, pytest.fail) > 0
        assert rows(store, LOGGED) == before


def test_missing_rows_of_a_time_are_projected_again(moved: Path, address: ServerAddress) -> None:
    archive = Archive(
        FolderFeed(moved / "log").records, Checkpoints(moved / "checkpoints"), past_pipeline
    )
    with ServerStore(address) as store:
        before = rows(store, LOGGED)
        (incident,) = Records(store, SystemClock()).incidents()
        with store.write() as session:
            for table in (TrackPoint, AlarmTransition, Assignment):
                session.execute(delete(table))
            session.execute(update(AlarmRow).values(state="raised", changed_ns=0))
        project_since(store, archive, incident.opened_ns)
        assert rows(store, LOGGED) == before


def test_erasure_waits_for_the_projection_of_the_log(moved: Path, address: ServerAddress) -> None:
    """Rows read from the log before would be written after the erasure."""
    ProjectionMark(moved / "tables-behind").note(1)
    clock = SystemClock()
    with ExitStack() as closing:
        recorder = Recorder(moved, clock)
        closing.callback(recorder.close)
        data = DataFolder(moved)
        disk = open_storage(data, recorder, clock, pytest.fail, closing, address)
        recordings = TransferQueue(lambda *_: None, data.recordings, clock)
        queue = disk.erasure_queue(
            recordings, lambda *_: None, lambda: None, lambda: True, lambda: False, lambda *_: 0
        )
        job = ErasureJob("1", "chief", "person", "p-77")
        assert "brought up to date from the log" in queue._obstacle(job)
        missing = disk.projection.missing()
        assert missing is not None
        disk.projection.note_caught_up(missing)
        assert queue._obstacle(job) == ""


def test_a_past_incident_is_read_from_the_log_while_the_server_is_away(
    moved: Path, server: DatabaseServer
) -> None:
    with open_database(moved / "station.sqlite") as store:
        (incident,) = Records(store, SystemClock()).incidents()
    reported: list[str] = []
    server.stop()
    try:
        with ExitStack() as closing:
            context = folder_commands.open_post_processing(
                moved, incident.incident_id, closing, reported.append, lambda _: None
            )
            assert context.incident.incident_id == incident.incident_id
            assert not context.keeps_result
        with pytest.raises(StoreError, match="does not answer"), ExitStack() as closing:
            folder_commands.open_accounts(moved, closing)
    finally:
        server.start()
    assert "the log is read instead" in reported[0]


def test_settings_that_name_another_database_than_the_folder_has_are_refused(
    moved: Path, server: DatabaseServer, tmp_path: Path
) -> None:
    with pytest.raises(StoreError, match=r"the settings name no database.*muster base backup"):
        start(moved, None)
    with pytest.raises(StoreError, match=r"is empty, and the tables.*pg_dump"):
        start(moved, server.new_database(tmp_path))
    (moved / NOTE).write_text("{")
    with pytest.raises(StoreError, match="it has the database's address"):
        open_database(moved / "station.sqlite")


@pytest.mark.parametrize(
    ("url", "reason"),
    [
        ("postgresql+psycopg://muster:secret@db/muster", "database_password_file"),
        ("postgresql+psycopg://db/muster?password=secret", "database_password_file"),
        ("mysql://db/muster", "write it as postgresql"),
        ("postgresql+psycopg://db", "write it as postgresql"),
    ],
)
def test_an_address_that_cannot_be_used_is_refused_without_its_password(
    tmp_path: Path, url: str, reason: str
) -> None:
    settings = tmp_path / "station.toml"
    settings.write_text(f'database = "{url}"')
    with pytest.raises(ConfigError, match=reason) as refused:
        load_config(settings, StationConfig)
    assert "secret" not in str(refused.value)


def test_a_password_file_belongs_to_a_database(tmp_path: Path) -> None:
    settings = tmp_path / "station.toml"
    settings.write_text('database_password_file = "password"')
    with pytest.raises(ConfigError, match="give its address, too"):
        load_config(settings, StationConfig)
    address = ServerAddress("postgresql+psycopg://db/muster", str(tmp_path / "none"))
    with pytest.raises(StoreError, match="password cannot be read"):
        ServerStore(address)


def test_a_missing_library_is_stated_with_how_to_install_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("base_station.storage.db.server_engine.find_spec", lambda _: None)
    with pytest.raises(StoreError, match=r"requirements-postgresql\.lock"):
        ServerStore(ServerAddress("postgresql+psycopg://db/muster"))
