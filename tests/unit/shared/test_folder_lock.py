"""One program at a time for a folder."""

from __future__ import annotations

import fcntl
import os
import subprocess
import sys
from pathlib import Path

import pytest

from shared.errors import DataFolderInUseError, LogError
from shared.folder_lock import FolderLock

HOLD = """
import sys
from pathlib import Path
from shared.folder_lock import FolderLock
lock = FolderLock(Path(sys.argv[1]))
print("held", flush=True)
sys.stdin.read()
"""


def test_second_holder_gets_the_identity_of_the_first(tmp_path: Path) -> None:
    lock = FolderLock(tmp_path)
    with pytest.raises(
        DataFolderInUseError, match=rf"another station .*\(process {os.getpid()}\): stop it"
    ):
        FolderLock(tmp_path)
    assert FolderLock.is_held(tmp_path)
    lock.close()
    assert not FolderLock.is_held(tmp_path)
    FolderLock(tmp_path).close()


def test_folder_without_a_lock_is_free_and_unchanged(tmp_path: Path) -> None:
    assert not FolderLock.is_held(tmp_path)
    assert not FolderLock.is_held(tmp_path / "nowhere")
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_the_folder_is_free_when_its_holder_was_killed(tmp_path: Path) -> None:
    with subprocess.Popen(
        [sys.executable, "-c", HOLD, tmp_path],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        cwd=Path(__file__).parents[3],
    ) as holder:
        assert holder.stdout is not None
        assert holder.stdout.readline() == "held\n"
        with pytest.raises(DataFolderInUseError, match=f"process {holder.pid}"):
            FolderLock(tmp_path)
        holder.kill()
    FolderLock(tmp_path).close()


def test_a_folder_that_cannot_be_made_is_stated_in_words(tmp_path: Path) -> None:
    (tmp_path / "data").write_text("a file")
    with pytest.raises(LogError, match="cannot be used"):
        FolderLock(tmp_path / "data")


def test_a_folder_on_a_full_disk_is_held_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> int:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "pwrite", full)
    lock = FolderLock(tmp_path)
    with pytest.raises(DataFolderInUseError, match="process unknown"):
        FolderLock(tmp_path)
    lock.close()
    assert not FolderLock.is_held(tmp_path)


def test_a_lock_that_is_deleted_admits_no_second_holder(tmp_path: Path) -> None:
    """Nor does one that somebody puts in its place, to be rid of the first one's."""
    lock = FolderLock(tmp_path)
    for again in (False, True):
        (tmp_path / "lock").unlink()
        if again:
            (tmp_path / "lock").write_text("7\n")
        with pytest.raises(DataFolderInUseError, match="another station"):
            FolderLock(tmp_path)
        assert FolderLock.is_held(tmp_path)
        (tmp_path / "lock").touch()
    lock.close()
    assert not FolderLock.is_held(tmp_path)
    FolderLock(tmp_path).close()


def test_an_earlier_version_that_goes_by_the_file_alone_is_kept_out_and_heeded(
    tmp_path: Path,
) -> None:
    lock = FolderLock(tmp_path)
    with (tmp_path / "lock").open("rb") as theirs:
        with pytest.raises(BlockingIOError):
            fcntl.flock(theirs, fcntl.LOCK_EX | fcntl.LOCK_NB)
        lock.close()
        fcntl.flock(theirs, fcntl.LOCK_EX | fcntl.LOCK_NB)
        assert FolderLock.is_held(tmp_path)
        with pytest.raises(DataFolderInUseError):
            FolderLock(tmp_path)
