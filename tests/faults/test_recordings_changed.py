"""A recording that changes during its pull: files that the unit repaired, deleted, or rewrote."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

import pytest

from base_station.unit_sync.recordings import transfer as fetching
from base_station.unit_sync.recordings.transfer import TransferState
from tests.rig.changing_recordings import RecordingsUnit, listed, pulled
from tests.rig.recorded_unit import U, finish


def test_shortened_file_is_pulled_at_its_current_length(tmp_path: Path) -> None:
    """Its power was lost, and it mended what it had recorded."""
    unit = RecordingsUnit(a=b"recorded" * 300)

    def lose(question: str) -> None:
        if "offset=1024" in question:
            unit.files["boot/a.mcap"] = b"recorded" * 128

    unit.before = lose
    fetch = finish(unit.pull(tmp_path), steps=20)
    assert (fetch.state, fetch.problem) == (TransferState.DONE, "")
    assert pulled(tmp_path) == {"a.mcap": b"recorded" * 128}


def test_restarted_transfer_counts_no_file_twice(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    files = {"a": b"a" * 500, "b": b"b" * 5000}
    unit = RecordingsUnit(**files)
    fetch = unit.pull(tmp_path)

    def give_up(question: str) -> None:
        if "digest?path=boot/a" in question:
            del unit.files["boot/a.mcap"]

    unit.before = give_up
    while "boot/a.mcap" in unit.files:
        fetch.step()
    with monkeypatch.context() as patched:
        patched.setattr(fetching, "_SPARED_BYTES", 1 << 62)
        fetch.step()
    assert fetch.state is TransferState.WAITING
    unit.files = RecordingsUnit(**files).files
    fetch = finish(fetch)
    assert fetch.state is TransferState.DONE
    assert fetch.problem.startswith("1 of 2 files came whole")


def test_complete_file_is_kept_when_the_unit_replaces_and_deletes_it(
    tmp_path: Path,
) -> None:
    unit = RecordingsUnit(a=b"before" * 20)
    finish(unit.pull(tmp_path))
    unit.files["boot/a.mcap"] = b"another" * 40

    def give_up(question: str) -> None:
        if "offset=0" in question:  # what was added did not fit to what was here
            unit.files.clear()

    unit.before = give_up
    fetch = finish(unit.pull(tmp_path))
    assert fetch.state is TransferState.DONE
    assert "1 of 1 files are gone" in fetch.problem
    assert pulled(tmp_path)["a.mcap"] == b"before" * 20


def test_complete_file_is_kept_during_the_transfer_of_its_extension(tmp_path: Path) -> None:
    """The unit may never come back, and whoever pulls may be killed."""
    unit, before = RecordingsUnit(a=b"before" * 20), b"before" * 20
    finish(unit.pull(tmp_path))
    grown = unit.files["boot/a.mcap"] = before + bytes(100_000)
    fetch = unit.pull(tmp_path)
    for _ in range(4):
        fetch.step()
    assert 0 < fetch.done_bytes < fetch.total_bytes
    assert pulled(tmp_path)["a.mcap"] == before
    fetch.close()
    unit.pieces.clear()
    assert finish(unit.pull(tmp_path)).state is TransferState.DONE
    assert pulled(tmp_path) == {"a.mcap": grown}
    assert sum(unit.pieces) < len(grown) - len(before), "what had come is not asked for again"


def test_damaged_list_of_hashes_does_not_end_the_transfer(tmp_path: Path) -> None:
    unit = RecordingsUnit(a=b"all of it")
    finish(unit.pull(tmp_path))
    hashes = tmp_path / U / fetching.HASHES
    hashes.write_bytes(b"\xff\xfe" + hashes.read_bytes())
    unit.files["boot/b.mcap"] = b"another"
    assert finish(unit.pull(tmp_path)).state is TransferState.DONE
    digest = hashlib.sha256(b"another").hexdigest()
    assert f"{digest}  boot/b.mcap" in hashes.read_text(encoding="utf-8").splitlines()


def test_replaced_file_is_pulled_in_its_current_version(tmp_path: Path) -> None:
    unit = RecordingsUnit(a=b"before" * 20, b=b"before" * 20)
    finish(unit.pull(tmp_path))
    unit.files = {"boot/a.mcap": b"shorter", "boot/b.mcap": b"longer" * 99}
    fetch = finish(unit.pull(tmp_path))
    assert (fetch.state, fetch.problem) == (TransferState.DONE, "")
    assert pulled(tmp_path) == {"a.mcap": b"shorter", "b.mcap": b"longer" * 99}


def test_file_deleted_during_a_waiting_transfer_is_reported_as_gone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It asks anew what there is, and is not told of it any more."""
    unit = RecordingsUnit(a=b"a" * 500, b=b"b" * 5000, c=b"c" * 500)
    fetch = unit.pull(tmp_path)
    while not (tmp_path / U / "boot" / "a.mcap").exists():
        fetch.step()
    with monkeypatch.context() as patched:
        patched.setattr(fetching, "_SPARED_BYTES", 1 << 62)
        for _ in range(3):
            fetch.step()
        assert fetch.state is TransferState.WAITING
    del unit.files["boot/a.mcap"], unit.files["boot/b.mcap"]
    fetch = finish(fetch)
    assert fetch.state is TransferState.DONE
    assert fetch.problem == "1 of 3 files are gone: the unit needed the room"
    assert pulled(tmp_path)["a.mcap"] == b"a" * 500
    assert listed(tmp_path).keys() == {"a.mcap", "c.mcap"}


def test_received_files_of_a_failed_transfer_are_listed_with_their_hashes(
    tmp_path: Path,
) -> None:
    unit = RecordingsUnit(a=b"half")
    finish(unit.pull(tmp_path))
    whole = unit.files["boot/a.mcap"] = b"half of it"
    unit.files["boot/b.mcap"] = b"another"

    def spoil(question: str) -> None:
        if "digest?path=boot/b" in question:
            unit.files["boot/b.mcap"] = os.urandom(7)

    unit.before = spoil
    fetch = finish(unit.pull(tmp_path))
    assert (fetch.state, "different" in fetch.problem) == (TransferState.FAILED, True)
    assert pulled(tmp_path) == {"a.mcap": whole}
    assert listed(tmp_path) == {"a.mcap": hashlib.sha256(whole).hexdigest()}
