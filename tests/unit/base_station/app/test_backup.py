"""Backups hold the data that a station needs, and leave foreign folders alone."""

from __future__ import annotations

import errno
import os
import sqlite3
from pathlib import Path

import pytest

from base_station.app import backup
from base_station.app.backup import Backup, back_up
from base_station.storage.db.models import LogSegment
from base_station.storage.db.records import Records
from base_station.storage.db.store import Store
from shared.clock import ManualClock
from shared.errors import LogError, StoreError, UserError
from tests.rig.full_disk import files_of_at_most

FIRST, SECOND = "000001-20261121T100000Z.mcap", "000002-20261121T101500Z.mcap"
LONG_AGO_S = 1_700_000_000


@pytest.fixture
def data(tmp_path: Path) -> Path:
    """A station's folder; a backup copies its files without reading them."""
    data = tmp_path / "station"
    for name, text in {
        f"log/{FIRST}": "closed",
        f"log/{SECOND}": "gro",
        "log/000001-20261121T100000Z.mcap.torn": "what a crash left",
        "pki/station.key": "secret",
        "apart/000002-20261121T101500Z.mcap": "cut off",
        "checkpoints/1.checkpoint": "can be made again",
        "recordings/FF-01/raw.mcap": "can be fetched again",
        "forgetting.json": "[]",
        "forgetting-begun.json": "who was there",
        "lock": "4711",
    }.items():
        (data / name).parent.mkdir(parents=True, exist_ok=True)
        (data / name).write_text(text)
        os.utime(data / name, (LONG_AGO_S, LONG_AGO_S))
    with Store(data / "station.sqlite"):
        pass
    return data


def run(data: Path, target: Path) -> Backup:
    return back_up(data, target, lambda _part: None)


def files(folder: Path) -> set[str]:
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


def test_backup_holds_all_irreplaceable_files(data: Path, tmp_path: Path) -> None:
    target = tmp_path / "backup"
    done = run(data, target)
    assert files(target) == {
        f"log/{FIRST}",
        f"log/{SECOND}",
        "pki/station.key",
        f"apart/{SECOND}",
        "forgetting.json",
        "forgetting-begun.json",
        "station.sqlite",
    }
    assert (target / "pki" / "station.key").read_text() == "secret"
    assert target.stat().st_mode & 0o077 == 0
    assert (done.copied, done.unchanged, done.removed) == (6, 0, 0)


def test_data_erased_during_the_backup_is_erased_in_it(
    data: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A station that starts on the backup completes the erasures of the copied log."""
    copy, target = backup._copy_file, tmp_path / "backup"

    def forget_meanwhile(source: Path, part: Path) -> bool:
        if source.suffix == ".mcap":
            (data / "forgetting.json").write_text("[] done")
        return copy(source, part)

    monkeypatch.setattr(backup, "_copy_file", forget_meanwhile)
    run(data, target)
    assert (target / "forgetting.json").read_text() == "[]"
    (data / "forgetting-begun.json").unlink()
    run(data, target)
    assert (target / "forgetting.json").read_text() == "[] done"
    assert not (target / "forgetting-begun.json").exists(), "it has names in it"


def test_second_run_copies_new_files_only(data: Path, tmp_path: Path) -> None:
    target = tmp_path / "backup"
    run(data, target)
    (data / "log" / SECOND).write_text("grown")
    done = run(data, target)
    assert (done.copied, done.copied_bytes, done.unchanged) == (1, len("grown"), 5)
    assert (target / "log" / SECOND).read_text() == "grown"


def test_segment_rewritten_at_the_same_length_is_copied(data: Path, tmp_path: Path) -> None:
    target = tmp_path / "backup"
    run(data, target)
    first = data / "log" / FIRST
    first.write_text("forgot")
    then_ns = first.stat().st_mtime_ns + 60 * 10**9
    os.utime(first, ns=(then_ns, then_ns))
    run(data, target)
    assert (target / "log" / FIRST).read_text() == "forgot"


def test_files_lost_at_the_station_stay_in_the_backup(data: Path, tmp_path: Path) -> None:
    target = tmp_path / "backup"
    run(data, target)
    (data / "log" / FIRST).unlink()
    assert run(data, target).removed == 1
    assert (target / "log" / FIRST).read_text() == "closed"


def test_database_is_copied_with_its_journal(data: Path, tmp_path: Path) -> None:
    with Store(data / "station.sqlite") as store, store.write() as session:
        session.connection().exec_driver_sql("CREATE TABLE noted (what TEXT)")
        session.connection().exec_driver_sql("INSERT INTO noted VALUES ('a word')")
        session.commit()
        run(data, tmp_path / "backup")
    with sqlite3.connect(tmp_path / "backup" / "station.sqlite") as copied:
        assert copied.execute("SELECT what FROM noted").fetchall() == [("a word",)]
    copied.close()


def test_backup_of_another_station_is_left_alone(data: Path, tmp_path: Path) -> None:
    target = tmp_path / "backup"
    (target / "log").mkdir(parents=True)
    (target / "log" / "000001-20250101T000000Z.mcap").write_text("another's")
    before = files(target)
    with pytest.raises(UserError, match="something else than a backup of this station"):
        run(data, target)
    assert files(target) == before


@pytest.mark.parametrize("where", [".", "log", ".."])
def test_backup_inside_the_station_folder_is_refused(data: Path, where: str) -> None:
    with pytest.raises(UserError, match="not apart"):
        run(data, data / where)


def test_unwritable_target_is_reported(data: Path, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(LogError, match="not complete"):
        run(data, tmp_path / "file" / "backup")


def test_failing_disk_is_copied_as_far_as_it_reads(
    data: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every run reports what is missing until it can be read."""
    target, pread = tmp_path / "backup", os.pread
    (data / "log" / FIRST).write_bytes(b"a" * 4096 + b"b" * 4096 + b"c" * 10)
    (data / "log" / SECOND).unlink()
    (data / "log" / SECOND).symlink_to(SECOND)  # no process can open it

    def failing(file: int, count: int, offset: int) -> bytes:
        if offset == 4096:
            raise OSError(errno.EIO, "Input/output error")
        return pread(file, count, offset)

    (data / "station.sqlite").write_bytes(b"no database")
    for _ in range(2):
        with monkeypatch.context() as patched:
            patched.setattr(os, "pread", failing)
            with pytest.raises(StoreError, match="cannot be read"):
                run(data, target)
        copied = (target / "log" / FIRST).read_bytes()
        assert copied == b"a" * 4096 + bytes(4096) + b"c" * 10
        assert files(target) >= {"pki/station.key", f"apart/{SECOND}", "forgetting.json"}
    (data / "station.sqlite").unlink()
    done = run(data, target)
    assert (target / "log" / FIRST).read_bytes() == (data / "log" / FIRST).read_bytes()
    with pytest.raises(LogError, match=f"does not give of {SECOND}: check that disk"):
        done.require_whole()


def full(*_: object) -> None:
    raise OSError(errno.ENOSPC, "No space left on device")


@pytest.mark.parametrize("copied", [0, 1, 3])
def test_full_disk_leaves_no_partial_copy_and_the_next_run_continues(
    data: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, copied: int
) -> None:
    target, copy, left = tmp_path / "backup", backup._copy_file, copied

    def copy_while_there_is_room(source: Path, part: Path) -> bool:
        nonlocal left
        left -= 1
        if left < 0:
            part.write_bytes(source.read_bytes()[:1])
            full()
        return copy(source, part)

    with Store(data / "station.sqlite") as store:
        Records(store, ManualClock()).put_segments(
            [LogSegment(name=FIRST, first_ns=1, last_ns=2, messages=1, size_bytes=6, note="")]
        )
    with monkeypatch.context() as patched:
        patched.setattr(backup, "_copy_file", copy_while_there_is_room)
        with pytest.raises(LogError, match=r"No space left on device\): make room"):
            run(data, target)
    assert not [name for name in files(target) if name.endswith(".part")]
    assert len(files(target)) == copied + 1  # with the database
    assert run(data, target).copied == 6 - copied


def test_database_without_room_prevents_no_other_copy(data: Path, tmp_path: Path) -> None:
    target = tmp_path / "backup"
    with files_of_at_most(8000), pytest.raises(StoreError, match="see that there is room beside"):
        run(data, target)
    assert not [name for name in files(target) if name.startswith("station.sqlite")]
    assert run(data, target).unchanged == 6
    assert "station.sqlite" in files(target)


def test_first_run_that_was_killed_is_continued(data: Path, tmp_path: Path) -> None:
    target = tmp_path / "backup"
    (target / "log").mkdir(parents=True)
    for name in ("station.sqlite.part", f"log/{FIRST}.part"):
        (target / name).write_text("half")
    assert run(data, target).copied == 6
    assert not [name for name in files(target) if name.endswith(".part")]


def test_folder_without_a_station_is_refused(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="no station's log"):
        run(tmp_path / "nothing", tmp_path / "backup")


def test_set_aside_messages_reported_since_are_not_kept_twice(data: Path, tmp_path: Path) -> None:
    """Put back, they would be reported twice; and erased data would stay in them."""
    target = tmp_path / "backup"
    part, reported = data / "apart" / "1-1-1", data / "apart" / "1-1-1.told"
    part.mkdir()
    (part / SECOND).write_text("of Ada")
    run(data, target)
    part.rename(reported)
    run(data, target)
    (target / "apart" / part.name).mkdir()  # as an earlier run kept it
    (target / "apart" / part.name / SECOND).write_text("of Ada")
    (reported / SECOND).write_text("(forgotten)")
    run(data, target)
    assert files(target / "apart") == {SECOND, f"1-1-1.told/{SECOND}"}
    assert (target / "apart" / "1-1-1.told" / SECOND).read_text() == "(forgotten)"
