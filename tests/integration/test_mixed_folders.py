"""A station's folder with parts of different stations: reported in a sentence, nothing mixed."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pytest

from base_station.accounts.principals import Role
from base_station.app import folder_commands as station_folder
from base_station.app.factories import announce_first_login
from base_station.app.offline_log import open_offline_log
from base_station.app.station_storage import StationStorage, open_storage
from base_station.core.log_position import LogPosition
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.records import Records
from base_station.storage.db.store import Store
from base_station.storage.db.window import EVER
from base_station.storage.recorder import Recorder
from shared.clock import ManualClock
from shared.errors import LogError, StoreError
from shared.messages.station import OpenIncident
from tests.rig.damaged_database import spoil_table
from tests.rig.station_script import START_NS, Script


def record(data: Path, incident: str) -> None:
    """A station has run here, and its log is all that is left."""
    script = Script()
    script.now_s = float(len(incident))  # each at a time of its own
    script.register("anna")
    script.act(OpenIncident(incident, incident))
    recorder = Recorder(data, ManualClock(START_NS))
    for one in script.records:
        recorder.write(*one)
    recorder.close()


@contextmanager
def opened(data: Path, stated: list[str] | None = None) -> Iterator[StationStorage]:
    clock = ManualClock(START_NS)
    with ExitStack() as closing:
        recorder = Recorder(data, clock)
        closing.callback(recorder.close)
        tell = (stated if stated is not None else []).append
        yield open_storage(DataFolder(data), recorder, clock, tell, closing)


def incidents(data: Path) -> list[str]:
    with opened(data) as disk:
        return [one.name for one in disk.records.incidents()]


@pytest.mark.parametrize("left", [None, b""])
def test_missing_or_empty_database_is_rebuilt(tmp_path: Path, left: bytes | None) -> None:
    record(tmp_path, "Mill Lane")
    if left is not None:
        (tmp_path / "station.sqlite").write_bytes(left)
    stated: list[str] = []
    for _ in range(2):
        before = len(stated)
        with opened(tmp_path, stated) as disk:
            assert [one.name for one in disk.records.incidents()] == ["Mill Lane"]
            assert bool(disk.store.problem) == (len(stated) > before), "in the run that made it"
            if not disk.accounts.users():
                disk.accounts.add_user("mia", "something long enough", Role.ADMINISTRATOR)
    assert len(stated) == 2, "once"
    assert "made again from the log" in stated[0]
    for what in ("users and their passwords", "the roster: people's names", "first-login.txt"):
        assert what in stated[1]
    with opened(tmp_path) as disk:  # whoever comes later finds it
        assert "MadeDatabaseAgain" in [one.action for one in disk.records.audit_entries(EVER)]


def test_interrupted_rebuild_is_repeated(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    record(tmp_path, "Mill Lane")

    def killed(*_: object) -> int:
        raise KeyboardInterrupt

    with monkeypatch.context() as cut:
        cut.setattr("base_station.app.factories.project_log", killed)
        for begin in (lambda: incidents(tmp_path), lambda: rebuild(tmp_path)):
            with pytest.raises(KeyboardInterrupt):
                begin()
    assert incidents(tmp_path) == ["Mill Lane"]


def rebuild(data: Path) -> None:
    station_folder.rebuild(data, lambda _: None)


def test_failed_truncation_of_the_log_keeps_the_database_complete(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    record(tmp_path, "Mill Lane")
    assert incidents(tmp_path) == ["Mill Lane"]

    def full(*_: object) -> None:
        raise LogError("the disk is full")

    monkeypatch.setattr("base_station.app.folder_commands.set_aside", full)
    with pytest.raises(LogError):
        station_folder.cut_log(tmp_path, LogPosition(START_NS, 1), lambda _: None)
    assert incidents(tmp_path) == ["Mill Lane"]


def test_database_of_another_log_is_refused_and_kept(tmp_path: Path) -> None:
    one, other = tmp_path / "one", tmp_path / "other"
    for data, name in ((one, "Mill Lane"), (other, "Dock Road West")):
        record(data, name)
        assert incidents(data) == [name]
    shutil.copy(one / "station.sqlite", other / "station.sqlite")
    with pytest.raises(StoreError, match=r"is of another log.*move it away"):
        incidents(other)
    (other / "station.sqlite").replace(one / "station.sqlite")
    assert incidents(one) == ["Mill Lane"], "nothing of the other one came into it"
    assert incidents(other) == ["Dock Road West"]


def test_log_without_old_segments_keeps_its_database(tmp_path: Path) -> None:
    record(tmp_path, "Mill Lane")
    record(tmp_path, "Dock Road West")
    before = incidents(tmp_path)
    first, _ = sorted((tmp_path / "log").glob("*.mcap"))
    first.unlink()
    assert incidents(tmp_path) == before


# ---- a damaged database


@pytest.fixture
def served(tmp_path: Path) -> Path:
    """A station has run here: Mia may log in, Ada is on the roster, and something was audited."""
    record(tmp_path, "Mill Lane")
    with opened(tmp_path) as disk:
        disk.accounts.add_user("mia", "something long enough", Role.ADMINISTRATOR)
        disk.roster.add_person("Ada", "A", "")
        disk.records.audit("mia", "AddedPerson", "Ada")
    return tmp_path


def spoil(data: Path, table: str) -> None:
    spoil_table(data / "station.sqlite", table)


def shorten(data: Path) -> None:
    os.truncate(data / "station.sqlite", 10_000)


def zero(data: Path) -> None:
    database = data / "station.sqlite"
    database.write_bytes(bytes(database.stat().st_size))


def set_aside(data: Path) -> list[Path]:
    return list(data.glob("station.sqlite.damaged-*Z"))


@pytest.mark.parametrize("table", ["incidents", "audit"])
def test_readable_rows_of_a_damaged_database_are_kept(served: Path, table: str) -> None:
    spoil(served, table)
    damaged = (served / "station.sqlite").read_bytes()
    stated: list[str] = []
    with opened(served, stated) as disk:
        assert [one.name for one in disk.records.incidents()] == ["Mill Lane"]
        assert [one.username for one in disk.accounts.users()] == ["mia"]
        assert [one.name for one in disk.roster.people()] == ["Ada"]
        assert f"The database was damaged ({table}: " in disk.store.problem
        assert disk.store.problem in stated
        assert ("are lost" in disk.store.problem) == (table == "audit")
    (aside,) = set_aside(served)
    assert aside.read_bytes() == damaged
    assert aside.name in stated[-1]
    assert incidents(served) == ["Mill Lane"], "once: now it is whole"
    assert len(set_aside(served)) == 1


def test_loss_of_the_table_of_users_is_reported_with_the_way_to_log_in(served: Path) -> None:
    with opened(served) as disk:
        disk.accounts.add_token("mia", "wall", Role.VIEWER, None)
        assert disk.accounts.log_in("mia", "something long enough")
    spoil(served, "users")
    with opened(served) as disk:
        assert disk.accounts.users() == []
        for what in ("users and their passwords", "API tokens", "logins", "first-login.txt"):
            assert what in disk.store.problem
        assert "the roster" not in disk.store.problem
        assert [one.name for one in disk.roster.people()] == ["Ada"]
        note = disk.folder.first_login
        announce_first_login(disk.accounts, note, lambda _: None)
        name, password = (line.split(": ")[1] for line in note.read_text().splitlines())
        assert disk.accounts.log_in(name, password)


@pytest.mark.parametrize("damage", [shorten, zero])
def test_unreadable_database_is_rebuilt(served: Path, damage: Callable[[Path], None]) -> None:
    damage(served)
    with opened(served) as disk:
        assert [one.name for one in disk.records.incidents()] == ["Mill Lane"]
        assert "The database was damaged" in disk.store.problem
    assert len(set_aside(served)) == 1


def test_interrupted_salvage_is_continued(served: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    spoil(served, "incidents")

    def killed(*_: object) -> Path:
        raise KeyboardInterrupt

    with monkeypatch.context() as cut:  # between its two renamings
        cut.setattr("base_station.storage.db.salvage.Path.replace", killed)
        with pytest.raises(KeyboardInterrupt):
            incidents(served)
    with opened(served) as disk:
        assert [one.name for one in disk.records.incidents()] == ["Mill Lane"]
        assert [one.username for one in disk.accounts.users()] == ["mia"]
    assert {path.name for path in served.glob("station.sqlite*")} == {
        "station.sqlite",
        *(path.name for path in set_aside(served)),
    }


def test_damage_found_while_running_is_reported_and_repaired_by_a_rebuild(served: Path) -> None:
    with opened(served) as disk:
        spoil(served, "units")
        assert isinstance(disk.store, Store)
        disk.store.engine.dispose()  # what it has read of it is in memory still
        with pytest.raises(StoreError, match="malformed"):
            disk.roster.units()
        assert "The database is damaged" in disk.projection.problem()
        assert "muster base rebuild" in disk.projection.problem()
    stated: list[str] = []
    station_folder.rebuild(served, lambda _: None, stated.append)
    assert "users and people were kept" in stated[0]
    with opened(served) as disk:
        assert [unit.unit_id for unit, _ in disk.roster.units()] == ["anna"]
        assert disk.store.problem == ""


def test_past_incident_beside_a_damaged_database_is_read_from_the_log(served: Path) -> None:
    spoil(served, "incidents")
    stated: list[str] = []
    with ExitStack() as closing_:
        given = open_offline_log(
            served, "Mill Lane", closing_, stated.append, lambda _: None, in_place=True
        )
        assert Records(given.store, ManualClock()).incident("Mill Lane")
    assert any("the database is damaged" in one for one in stated)
    assert not set_aside(served), "a station may be running here"
