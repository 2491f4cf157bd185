"""One program at a time for a folder."""

from __future__ import annotations

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


def test_a_second_holder_is_told_who_holds_the_folder(tmp_path: Path) -> None:
    lock = FolderLock(tmp_path)
    with pytest.raises(
        DataFolderInUseError, match=rf"another station .*\(process {os.getpid()}\): stop it"
    ):
        FolderLock(tmp_path)
    assert FolderLock.is_held(tmp_path)
    lock.close()
    assert not FolderLock.is_held(tmp_path)
    FolderLock(tmp_path).close()


def test_a_folder_that_nobody_ever_held_is_not_held_and_stays_as_it_is(tmp_path: Path) -> None:
    assert not FolderLock.is_held(tmp_path)
    assert not FolderLock.is_held(tmp_path / "nowhere")
    assert not list(tmp_path.iterdir())


def test_the_folder_is_free_when_its_holder_was_killed(tmp_path: Path) -> None:
    with subprocess.Popen(
        [sys.executable, "-c", HOLD, tmp_path],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        cwd=Path(__file__).parents[2],
    ) as holder:
        assert holder.stdout is not None
        assert holder.stdout.readline() == "held\n"
        with pytest.raises(DataFolderInUseError, match=f"process {holder.pid}"):
            FolderLock(tmp_path)
        holder.kill()
    FolderLock(tmp_path).close()


def test_a_folder_that_cannot_be_made_is_said_in_words(tmp_path: Path) -> None:
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
