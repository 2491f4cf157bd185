"""Errors of an archive have codes, and so have the reasons in them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from base_station.archive.catalogue import require_entry
from base_station.archive.copying_errors import as_one, copy_gone, copy_older
from base_station.archive.store import FolderStore
from shared.coded_text import TextCode, code_of_text, text_of_error
from shared.errors import ArchiveError


def code_of_failure(action: Callable[[], object]) -> TextCode:
    with pytest.raises(ArchiveError) as failed:
        action()
    return code_of_text(text_of_error(failed.value))


def test_disk_that_is_gone_is_named_with_what_was_asked_of_it(tmp_path: Path) -> None:
    folder = tmp_path / "archive"
    found = code_of_failure(FolderStore(folder).names)
    assert (found.code, found.texts["archive"]) == ("archive-disk-fails", str(folder))
    assert found.texts["what:"] == "archive-cannot-list"
    assert found.texts["error:"] == "archive-no-folder"


def test_error_of_the_disk_has_the_file(tmp_path: Path) -> None:
    (tmp_path / "i1").write_text("no folder")
    found = code_of_failure(lambda: FolderStore(tmp_path).read_all("i1/incident.mcap"))
    assert (found.code, found.texts["what:"]) == ("archive-disk-fails", "archive-cannot-read")
    assert found.texts["what:file"] == "i1/incident.mcap"
    assert found.texts["error"] == "Not a directory"


def test_shorter_file_and_missing_copy_are_named(tmp_path: Path) -> None:
    store = FolderStore(tmp_path)
    (tmp_path / "part").write_bytes(b"12")
    short = code_of_failure(lambda: store.read("part", 0, 3))
    assert (short.code, short.texts["file"]) == ("archive-file-short", "part")
    missing = code_of_failure(lambda: require_entry(store, "i1"))
    assert (missing.code, missing.texts["incident"]) == ("archive-no-copy", "i1")
    assert missing.texts["known:"] == "archive-has-none"


def test_several_incidents_are_one_text_of_which_each_has_its_code() -> None:
    gone, older = copy_gone("/a", "i1"), text_of_error(copy_older("/a", "i2"))
    assert as_one([gone]) is gone
    both = as_one([gone, older])
    assert both == f"{gone}. {older}"
    found = code_of_text(both)
    assert (found.code, found.texts["first:"]) == ("archive-joined", "archive-copy-gone")
    assert (found.texts["others:"], found.texts["others:incident"]) == ("archive-copy-older", "i2")


def test_of_many_incidents_only_a_few_are_named() -> None:
    text = as_one([copy_gone("/a", f"i{number}") for number in range(200)])
    assert text.endswith("195 more incidents cannot be copied either")
    assert len(text) < 1000
