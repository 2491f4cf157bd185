"""The database: migrations, damaged and newer files, the projection's writer."""

from __future__ import annotations

import hashlib
import shutil
import sqlite3
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest
from alembic import command
from alembic.script import ScriptDirectory
from sqlalchemy import text

from base_station.accounts.principals import Principal, Role
from base_station.storage.db.accounts import Accounts
from base_station.storage.db.alembic_migration import alembic_config, upgrade
from base_station.storage.db.copying import copy_database, known_segments
from base_station.storage.db.engines import file_engine
from base_station.storage.db.migrate import newest_revision
from base_station.storage.db.models import Base, PersonRow
from base_station.storage.db.projection import SqlProjection
from base_station.storage.db.records import Records
from base_station.storage.db.roster import Roster
from base_station.storage.db.store import Store
from base_station.storage.db.window import FOREVER_NS, Window
from shared.clock import NS_PER_S, ManualClock
from shared.errors import StoreError
from shared.messages.station import (
    RegisterUnit,
)
from tests.rig.projected_story import STORY, acted
from tests.rig.waiting import until

ALL = Window(0, FOREVER_NS)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "station.sqlite"


@pytest.fixture
def store(path: Path) -> Iterator[Store]:
    with Store(path) as store:
        yield store


def test_new_file_has_the_schema_of_the_migrations(path: Path, store: Store) -> None:
    """And both are what the models say."""
    migrated = file_engine(path.with_name("migrated.sqlite"))
    with migrated.begin() as connection:
        upgrade(connection)
    with migrated.connect() as connection:
        config = alembic_config(connection)
        command.check(config)  # raises where models and migrations differ
    assert newest_revision() == ScriptDirectory.from_config(config).get_current_head()
    created = schema_of(path)
    assert created.keys() == {*Base.metadata.tables, "alembic_version", "sqlite_sequence"}
    assert created == schema_of(path.with_name("migrated.sqlite"))
    with store.read() as session:
        revision = session.connection().exec_driver_sql("SELECT version_num FROM alembic_version")
        assert revision.scalar() == newest_revision()


def schema_of(path: Path) -> dict[str, tuple[object, ...]]:
    """Columns without their order, indices and foreign keys, by table."""
    with closing(sqlite3.connect(path)) as database:

        def rows(pragma: str, of: str) -> list[tuple[object, ...]]:
            return database.execute(f"PRAGMA {pragma}({of})").fetchall()

        names = database.execute("SELECT name FROM sqlite_master WHERE type = 'table'").fetchall()
        return {
            name: (
                sorted(column[1:] for column in rows("table_info", name)),
                sorted(
                    (*index[1:], *(column[2] for column in rows("index_info", str(index[1]))))
                    for index in rows("index_list", name)
                ),
                sorted(key[2:] for key in rows("foreign_key_list", name)),
            )
            for (name,) in names
        }


def test_database_of_the_current_schema_is_opened_without_alembic(path: Path, store: Store) -> None:
    store.close()
    opened = (
        "import sys; from pathlib import Path; from base_station.storage.db.store import Store; "
        f"Store(Path({str(path)!r})).close(); sys.exit('alembic' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", opened], check=False).returncode == 0


@pytest.fixture
def first_schema(path: Path, store: Store) -> Path:
    """As the first version left it: somebody was logged in, and did things."""
    with store.engine.connect() as connection:
        command.downgrade(alembic_config(connection), "0001")
        connection.commit()
    store.close()
    with closing(sqlite3.connect(path)) as database, database:
        database.execute("INSERT INTO users VALUES ('mia', 'hash', 'commander', 1)")
        cookie = hashlib.sha256(b"cookie").hexdigest()
        database.execute("INSERT INTO sessions VALUES (?, 'mia', 1, 5000000000)", [cookie])
        for entry_id, t_ns in (("a", 3), ("c", 1), ("b", 2)):
            row = (entry_id, t_ns, "mia", "OpenIncident", f"at {t_ns}")
            database.execute("INSERT INTO audit VALUES (?, ?, ?, ?, ?)", row)
    return path


def test_older_database_is_migrated_without_loss(
    first_schema: Path,
) -> None:
    clock = ManualClock(utc_ns=NS_PER_S)
    for _ in range(2):  # the second time nothing is left to do
        with Store(first_schema) as store:
            audit = Records(store, clock).audit_entries(ALL)
            assert [(one.number, one.detail) for one in audit] == [
                (3, "at 3"), (2, "at 2"), (1, "at 1"),
            ]  # fmt: skip
            assert Accounts(store, clock).of_session("cookie") == Principal("mia", Role.COMMANDER)
            with store.engine.connect() as connection:
                command.check(alembic_config(connection))


def test_interrupted_migration_changes_nothing(
    first_schema: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def killed(*_: object) -> None:
        raise KeyboardInterrupt

    with closing(sqlite3.connect(first_schema)) as database:
        before = list(database.iterdump())
    with monkeypatch.context() as cut:
        cut.setattr("alembic.op.drop_table", killed)  # of the audit, in the last step
        with pytest.raises(KeyboardInterrupt):
            Store(first_schema)
    with closing(sqlite3.connect(first_schema)) as database:
        assert list(database.iterdump()) == before
    with Store(first_schema) as store:
        assert len(Records(store, ManualClock()).audit_entries(ALL)) == 3


def test_committed_rows_survive_a_power_cut(store: Store) -> None:
    with store.engine.connect() as connection:
        settings = [
            connection.exec_driver_sql(f"PRAGMA {name}").scalar()
            for name in ("journal_mode", "synchronous", "foreign_keys")
        ]
    assert settings == ["wal", 2, 1]


def test_a_database_of_a_newer_program_is_refused(path: Path) -> None:
    Store(path).close()
    with closing(sqlite3.connect(path)) as connection:
        connection.execute("UPDATE alembic_version SET version_num = '9999'")
        connection.commit()
    with pytest.raises(StoreError, match="a newer Muster wrote it"):
        Store(path)


def test_file_that_is_no_database_is_refused_and_kept(path: Path) -> None:
    path.write_bytes(b"this is a shopping list, not a database" * 100)
    with pytest.raises(StoreError, match="muster base rebuild"):
        Store(path)
    assert path.read_bytes().startswith(b"this is a shopping list")


def test_damaged_database_is_reported_with_the_remedy(path: Path, clock: ManualClock) -> None:
    with Store(path) as store:
        Records(store, clock).audit("chief", "Looked", "")
        with store.read() as session:
            wanted = text("SELECT rootpage FROM sqlite_master WHERE name = 'audit'")
            page = session.execute(wanted).scalar_one()
            page_bytes = session.execute(text("PRAGMA page_size")).scalar_one()
    content = bytearray(path.read_bytes())
    begin = (page - 1) * page_bytes
    content[begin : begin + 300] = b"\xee" * 300
    path.write_bytes(content)
    with Store(path) as store:
        records = Records(store, clock)
        with pytest.raises(StoreError, match=r"malformed.*muster base rebuild"):
            records.audit_entries(ALL)
        with pytest.raises(StoreError, match=r"malformed.*muster base rebuild"):
            records.audit("chief", "Looked", "again")


def test_unopenable_database_is_reported_with_a_reason(path: Path) -> None:
    path.mkdir()
    with pytest.raises(StoreError, match=r"unable to open.*can be written"):
        Store(path)


def test_database_is_copied_during_writes(
    store: Store, path: Path, tmp_path: Path, clock: ManualClock
) -> None:
    roster = Roster(store, clock)
    roster.add_person("Ada", "A", "")
    with store.write() as session:
        session.add(
            PersonRow(person_id="x", name="half", crew="", role="", created_ns=0, photo_hash=None)
        )
        session.flush()
        copy_database(path, tmp_path / "copy.sqlite")
    with Store(tmp_path / "copy.sqlite") as copy:
        assert [person.name for person in Roster(copy, clock).people()] == ["Ada"]


def content(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.mark.parametrize("left", [(), ("-wal",), ("-wal", "-shm")])
def test_closed_database_is_read_without_changing_its_folder(
    left: tuple[str, ...], store: Store, path: Path, tmp_path: Path, clock: ManualClock
) -> None:
    """Also with what a kill left beside it, which has the changes in it."""
    killed = tmp_path / "killed"
    killed.mkdir()
    Roster(store, clock).add_person("Ada", "A", "")
    if not left:
        store.close()
    for suffix in ("", *left):
        shutil.copy(f"{path}{suffix}", killed)
    before, stamp_ns = content(killed), killed.stat().st_mtime_ns
    known_segments(killed / "station.sqlite")
    copy_database(killed / "station.sqlite", tmp_path / "copy.sqlite")
    assert (content(killed), killed.stat().st_mtime_ns) == (before, stamp_ns)
    with Store(tmp_path / "copy.sqlite") as copy:
        assert [person.name for person in Roster(copy, clock).people()] == ["Ada"]


def test_copy_of_a_constantly_written_database_is_refused(
    store: Store, path: Path, tmp_path: Path, clock: ManualClock, monkeypatch: pytest.MonkeyPatch
) -> None:
    def change_meanwhile(source: Path, target: Path) -> None:
        target.write_bytes(source.read_bytes())
        Roster(store, clock).add_person("Ada", "A", "")

    Roster(store, clock).add_person("Ada", "A", "")
    monkeypatch.setattr("base_station.storage.db.reading._copy_file", change_meanwhile)
    with pytest.raises(StoreError, match="see who writes to it"):
        copy_database(path, tmp_path / "no.sqlite")


@pytest.mark.parametrize("name", ["site#1", "what?", "100%41", "?mode=memory"])
def test_folder_may_have_any_name(tmp_path: Path, clock: ManualClock, name: str) -> None:
    """Characters with a meaning in an address are parts of the name."""
    folder = tmp_path / name
    folder.mkdir()
    with Store(folder / "station.sqlite") as store:
        Roster(store, clock).add_person("Ada", "A", "")
    copy_database(folder / "station.sqlite", folder / "copy.sqlite")
    with Store(folder / "copy.sqlite") as copy:
        assert [person.name for person in Roster(copy, clock).people()] == ["Ada"]
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_full_disk_is_reported_and_leaves_no_partial_row(store: Store, clock: ManualClock) -> None:
    roster = Roster(store, clock)
    _limit_pages(store)
    with pytest.raises(StoreError, match="full"):
        roster.add_person("Ada" * 10_000, "A", "")
    assert roster.people() == []


def _limit_pages(store: Store, pages: int = 0) -> None:
    """As if the disk were full: SQLite refuses in the same words.  0: not a page more."""
    with store.engine.connect() as connection:
        now = connection.exec_driver_sql("PRAGMA page_count").scalar_one()
        connection.exec_driver_sql(f"PRAGMA max_page_count = {pages or now}")


# ---- the projection


def test_failing_store_is_reported_and_catches_up(store: Store, clock: ManualClock) -> None:
    projection = SqlProjection(store)
    projection.project(STORY[0])
    assert projection.flush()
    assert projection.problem() == ""
    _limit_pages(store)
    long_names = acted(20, *(RegisterUnit(f"U-{n}", "x" * 4000) for n in range(50)))
    projection.project(long_names)
    assert not projection.flush()
    assert "full" in projection.problem()
    _limit_pages(store, 1_000_000)
    assert projection.flush()
    assert projection.problem() == ""
    assert len(Roster(store, clock).units()) == 52
    projection.close()


def test_failing_store_does_not_block_the_projection(store: Store) -> None:
    projection = SqlProjection(store)
    _limit_pages(store)
    projection.project(acted(20, *(RegisterUnit(f"U-{n}", "x" * 4000) for n in range(50))))
    is_over = projection.flush_soon()
    until(is_over, "it is given up")
    assert "full" in projection.problem()
    projection.close()
