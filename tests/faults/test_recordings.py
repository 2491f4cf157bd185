"""A recording reaches the station complete over kills of every process and every other fault."""

from __future__ import annotations

import hashlib
import random
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from base_station.unit_sync.recordings.transfer import HASHES, Transfer, TransferState
from edge.sources.black_box import BlackBoxSource
from shared.messages.recording import RecordingPiece
from tests.rig.recorded_unit import RecordedUnit, U, begin, finish


def test_pulled_recording_is_identical_and_replays(unit: RecordedUnit, tmp_path: Path) -> None:
    fetch = finish(begin(unit, tmp_path))
    assert (fetch.state, fetch.problem) == (TransferState.DONE, "")
    assert fetch.done_bytes == fetch.total_bytes > 0
    pulled = tmp_path / U / unit.boot.name
    assert {one.name for one in pulled.iterdir()} == {one.name for one in unit.boot.iterdir()}
    for one in unit.boot.iterdir():
        assert (pulled / one.name).read_bytes() == one.read_bytes()
    assert (tmp_path / U / "calibrations" / "c1.toml").read_text() == "x = 1\n"
    batches = sum(1 for _ in BlackBoxSource(pulled).batches())
    assert batches == sum(1 for _ in BlackBoxSource(unit.boot).batches()) > 0


def test_hashes_are_verified_by_sha256sum(unit: RecordedUnit, tmp_path: Path) -> None:
    finish(begin(unit, tmp_path, unit.window(0.0, 500.0)))
    finish(begin(unit, tmp_path, unit.window(3000.0, 3500.0)))
    checked = subprocess.run(
        ["sha256sum", "--check", HASHES],
        cwd=tmp_path / U,
        capture_output=True,
        text=True,
        check=True,
    )
    assert checked.stdout.count(": OK") == len(list((tmp_path / U).rglob("*.mcap"))) + 1


def test_only_segments_of_the_window_are_pulled(unit: RecordedUnit, tmp_path: Path) -> None:
    fetch = finish(begin(unit, tmp_path, unit.window(1000.0, 1300.0)))
    pulled = sorted(one.name for one in (tmp_path / U / unit.boot.name).iterdir())
    assert 3 <= len(pulled) <= 5
    assert fetch.total_bytes < sum(one.stat().st_size for one in unit.boot.iterdir()) / 5


@pytest.mark.parametrize("seed", range(5))
def test_repeatedly_killed_station_requests_no_byte_twice(
    unit: RecordedUnit, tmp_path: Path, seed: int
) -> None:
    chance = random.Random(seed)
    given: list[tuple[int, int]] = []

    def note(what: str, reply: bytes) -> bytes:
        if what == "piece":
            piece = RecordingPiece.from_bytes(reply)
            given.append((piece.offset, len(piece.data)))
        return reply

    unit.spoil = note
    for _ in range(8):
        fetch = begin(unit, tmp_path)
        for _ in range(chance.randrange(1, 40)):
            fetch.step()
        fetch._lock.close()  # all that the system does for a program that dies
    fetch = finish(begin(unit, tmp_path))
    assert fetch.state is TransferState.DONE
    assert sum(length for _, length in given) == fetch.total_bytes


def test_transfer_waits_for_an_absent_unit(unit: RecordedUnit, tmp_path: Path) -> None:
    fetch = begin(unit, tmp_path)
    for _ in range(15):
        fetch.step()
    came = fetch.done_bytes
    unit.linked = False
    for _ in range(5):
        fetch.step()
    assert fetch.state is TransferState.WAITING
    assert "FF-01 does not answer" in fetch.problem
    unit.linked = True
    assert finish(fetch).state is TransferState.DONE
    assert fetch.done_bytes > came


def test_corrupted_pieces_are_requested_again(unit: RecordedUnit, tmp_path: Path) -> None:
    chance = random.Random(3)

    def flip(what: str, reply: bytes) -> bytes:
        if what == "piece" and chance.random() < 0.3:
            place = chance.randrange(len(reply))
            return reply[:place] + bytes([reply[place] ^ 4]) + reply[place + 1 :]
        return reply

    unit.spoil = flip
    assert finish(begin(unit, tmp_path)).state is TransferState.DONE
    for one in unit.boot.iterdir():
        assert (tmp_path / U / unit.boot.name / one.name).read_bytes() == one.read_bytes()


def test_files_damaged_at_the_station_are_pulled_again(unit: RecordedUnit, tmp_path: Path) -> None:
    fetch = begin(unit, tmp_path)
    for _ in range(12):
        fetch.step()
    fetch.close()
    (part,) = tmp_path.rglob("*.part")
    part.write_bytes(bytes(part.stat().st_size))
    assert finish(begin(unit, tmp_path)).state is TransferState.DONE


def test_transfer_with_inconsistent_answers_fails_with_a_reason(
    unit: RecordedUnit, tmp_path: Path
) -> None:
    def wrong(what: str, reply: bytes) -> bytes:
        if what != "piece":
            return reply
        piece = RecordingPiece.from_bytes(reply)
        data = bytes(len(piece.data))
        return RecordingPiece(piece.offset, data, hashlib.sha256(data).digest()).to_bytes()

    unit.spoil = wrong
    fetch = finish(begin(unit, tmp_path))
    assert fetch.state is TransferState.FAILED
    assert "different" in fetch.problem
    assert not list(tmp_path.rglob("*.mcap"))


@contextmanager
def given_up(file: Path) -> Iterator[None]:
    """The unit needs the room just now."""
    content = file.read_bytes()
    file.unlink()
    try:
        yield
    finally:
        file.write_bytes(content)


@pytest.mark.parametrize("before", ["piece", "digest"])
def test_complete_file_is_kept_after_the_unit_deletes_it(
    unit: RecordedUnit, tmp_path: Path, before: str
) -> None:
    """Before it is asked for, it is gone; before its hash is asked for, it is here already."""
    first = sorted(unit.boot.iterdir())[0]
    content = first.read_bytes()
    fetch = begin(unit, tmp_path, unit.window(0.0, 10.0))
    assert any(_step_to(fetch, unit, before) for _ in range(100))
    with given_up(first):
        fetch = finish(fetch)
    assert fetch.state is TransferState.DONE
    pulled = tmp_path / U / unit.boot.name / first.name
    if before == "piece":
        assert "1 of 2 files are gone" in fetch.problem
        assert not pulled.exists()
    else:
        assert "1 of 2 files came whole" in fetch.problem
        assert pulled.read_bytes() == content


def _step_to(fetch: Transfer, unit: RecordedUnit, what: str) -> bool:
    """True if the next query is the first of that kind."""
    fetch.step()
    part = next(iter(fetch.folder.rglob("*.mcap.part")), None)
    size = part.stat().st_size if part is not None else -1
    whole = sorted(unit.boot.iterdir())[0].stat().st_size
    return size == (0 if what == "piece" else whole)


def test_complete_part_is_kept_when_the_added_part_is_deleted(
    unit: RecordedUnit, tmp_path: Path
) -> None:
    first = sorted(unit.boot.iterdir())[0]
    content = first.read_bytes()
    window = unit.window(0.0, 10.0)
    try:
        first.write_bytes(content[:1000])
        assert finish(begin(unit, tmp_path, window)).state is TransferState.DONE
        first.write_bytes(content)
        fetch = begin(unit, tmp_path, window)
        fetch.step()
        fetch.step()  # it knows how long the file is now
        with given_up(first):
            fetch = finish(fetch)
    finally:
        first.write_bytes(content)
    assert "are gone" in fetch.problem
    pulled = tmp_path / U / unit.boot.name / first.name
    assert pulled.read_bytes() == content[:1000]
    assert list(tmp_path.rglob("*.part")) == []


def test_growing_recording_is_continued(unit: RecordedUnit, tmp_path: Path) -> None:
    first = sorted(unit.boot.iterdir())[0]
    whole = first.read_bytes()
    try:
        first.write_bytes(whole[:1000])
        assert finish(begin(unit, tmp_path, unit.window(0.0, 10.0))).state is TransferState.DONE
        first.write_bytes(whole)
        asked = len(unit.questions)
        fetch = finish(begin(unit, tmp_path, unit.window(0.0, 10.0)))
    finally:
        first.write_bytes(whole)
    assert fetch.state is TransferState.DONE
    assert (tmp_path / U / unit.boot.name / first.name).read_bytes() == whole
    assert len(unit.questions) > asked
