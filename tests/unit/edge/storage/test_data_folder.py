"""The folder of one unit: one agent at a time, and of no other unit."""

from __future__ import annotations

import errno
import shutil
from pathlib import Path

import pytest

from edge.app.composition import compose_agent
from edge.config import EdgeConfig
from edge.sources.registry import open_source
from edge.storage.data_folder import UnitDataFolder
from edge.storage.journal.journal import Journal, JournalRow
from shared.bus import Bus
from shared.bus_memory import MemoryRouter
from shared.channels import EVENT, POSITION
from shared.codec import decode
from shared.errors import DataFolderInUseError, LogError
from shared.messages import EventKind, UnitEvent


class NoStation:
    def open_bus(self) -> Bus:
        return MemoryRouter().attach_unit()

    def is_reachable(self, timeout_s: float) -> bool:
        return False

    def link_failure_reason(self) -> str:
        return "nobody is there"


def keep_something(path: Path) -> None:
    folder = UnitDataFolder(path)
    journal = Journal(folder.journal, lambda: 7, 1_000, 10**9)
    journal.append([JournalRow(1, POSITION, 5_000, b"said")])
    journal.close()
    (folder.black_box / "boot").mkdir(parents=True)
    folder.mayday.touch()
    folder.close()


def test_a_unit_finds_its_folder_as_it_left_it(tmp_path: Path) -> None:
    keep_something(tmp_path / "anna")
    again = UnitDataFolder(tmp_path / "anna")
    assert again.quarantine is None
    assert again.journal.exists()
    assert again.black_box.exists()
    assert again.mayday.exists()
    again.close()


@pytest.mark.parametrize("left", [b"", b"\0\0\0\0\0", b"\xff\xff"])
def test_truncated_name_after_a_power_cut_is_no_other_unit(tmp_path: Path, left: bytes) -> None:
    """The name is written at the first start alone, and some file systems keep only its length."""
    keep_something(tmp_path / "anna")
    (tmp_path / "anna" / "unit").write_bytes(left)
    for _ in range(2):
        again = UnitDataFolder(tmp_path / "anna")
        assert again.quarantine is None
        assert again.journal.exists()
        again.close()
    assert (tmp_path / "anna" / "unit").read_text() == "anna\n"


def test_data_of_another_unit_is_moved_aside_and_not_served(tmp_path: Path) -> None:
    keep_something(tmp_path / "anna")
    for number in (1, 2):  # copied twice
        shutil.copytree(tmp_path / "anna", tmp_path / "bert", dirs_exist_ok=True)
        folder = UnitDataFolder(tmp_path / "bert")
        assert folder.quarantine == tmp_path / "bert" / f"of-another-{number}"
        kept = {path.name for path in folder.quarantine.iterdir()}
        assert kept == {"journal.sqlite", "black_box", "mayday"}
        assert not folder.journal.exists()
        assert not folder.mayday.exists()
        folder.close()
    own = UnitDataFolder(tmp_path / "bert")
    assert own.quarantine is None
    own.close()


def test_a_person_is_reported_of_it(tmp_path: Path) -> None:
    keep_something(tmp_path / "anna")
    shutil.copytree(tmp_path / "anna", tmp_path / "bert")
    folder = UnitDataFolder(tmp_path / "bert")
    config = EdgeConfig(unit="bert", source="simulated:search-ground-floor", data=tmp_path)
    agent = compose_agent(config, "bert", folder, open_source(config.source), NoStation(), None)
    parts = agent._parts
    parts.outbox.close()
    parts.journal_writer.close()
    parts.black_box.close()
    (reported,) = parts.journal.read(parts.journal.boot_id, 1, 10)
    parts.journal.close()
    event = decode(EVENT, reported.payload)
    assert isinstance(event, UnitEvent)
    assert event.kind is EventKind.STORAGE_FAULT
    assert "of another unit" in event.detail
    folder.close()


def test_two_agents_do_not_share_a_folder(tmp_path: Path) -> None:
    folder = UnitDataFolder(tmp_path / "anna")
    with pytest.raises(DataFolderInUseError, match="another agent is using"):
        UnitDataFolder(tmp_path / "anna")
    folder.close()
    UnitDataFolder(tmp_path / "anna").close()


def test_a_note_that_cannot_be_written_or_read_stops_no_unit(tmp_path: Path) -> None:
    (tmp_path / "anna" / "unit").mkdir(parents=True)
    folder = UnitDataFolder(tmp_path / "anna")
    assert folder.quarantine is None
    folder.close()


def test_data_that_cannot_be_moved_aside_is_not_used(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    keep_something(tmp_path / "anna")
    shutil.copytree(tmp_path / "anna", tmp_path / "bert")

    def refuse(*_: object) -> None:
        raise OSError(errno.EROFS, "Read-only file system")

    monkeypatch.setattr("pathlib.Path.rename", refuse)
    for _ in range(2):  # and is let go of
        with pytest.raises(LogError, match="Read-only file system"):
            UnitDataFolder(tmp_path / "bert")
