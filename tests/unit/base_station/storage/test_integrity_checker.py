"""Repeated check of the log: segments that were whole may be damaged later."""

from __future__ import annotations

import random
import shutil
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest

from base_station.engine.log_feed import FolderFeed
from base_station.standby.stale_state import StaleState
from base_station.storage.integrity_checker import IntegrityChecker
from base_station.storage.recorder import Recorder
from shared.channels import POSITION
from shared.clock import NS_PER_S, SystemClock
from shared.coded_text import Term
from shared.mcap_log import SegmentPolicy

T0 = 1_800_000_000 * NS_PER_S


@pytest.fixture
def recorder(tmp_path: Path) -> Iterator[Recorder]:
    recorder = Recorder(tmp_path, SystemClock(), SegmentPolicy(segment_s=1.0, chunk_bytes=4096))
    chance = random.Random(1)
    for number in range(300):
        t_ns = T0 + number * NS_PER_S // 100
        recorder.write(t_ns, POSITION.key("anna"), chance.randbytes(100))
    recorder.flush()
    yield recorder
    recorder.close()


def looked(check: IntegrityChecker, recorder: Recorder, times: int = 5) -> IntegrityChecker:
    for _ in range(times):
        check.check_next_segment(recorder.segments())
    return check


def flip(recorder: Recorder) -> Path:
    path = recorder.segments()[0].path
    content = bytearray(path.read_bytes())
    content[len(content) // 3] ^= 0x10
    path.write_bytes(content)
    return path


def test_later_damage_is_found_by_the_next_round(
    recorder: Recorder, monkeypatch: pytest.MonkeyPatch
) -> None:
    check = looked(IntegrityChecker(Term("restore", "")), recorder)
    path = flip(recorder)
    assert looked(check, recorder, 100).damaged == ()
    monkeypatch.setattr("base_station.storage.integrity_checker._AGAIN_LOOKS", 50)
    assert looked(check, recorder, 60).damaged == (path,)


def test_unreadable_segment_is_reported_and_prevents_no_start(
    recorder: Recorder, tmp_path: Path
) -> None:
    shutil.copytree(recorder.folder, tmp_path / "elsewhere" / "log")
    path = tmp_path / "elsewhere" / "log" / recorder.segments()[0].path.name
    path.unlink()
    path.symlink_to(path.name)
    with closing(Recorder(tmp_path / "elsewhere", SystemClock())) as again:
        assert path.name in looked(IntegrityChecker(Term("restore", "")), again).problems()[0]
        assert sum(1 for _ in FolderFeed(again.folder).records()) > 0


def test_segment_missing_at_the_start_is_reported(recorder: Recorder, tmp_path: Path) -> None:
    shutil.copytree(recorder.folder, tmp_path / "elsewhere" / "log")
    assert looked(IntegrityChecker(Term("restore", "")), recorder).problems() == ()
    (tmp_path / "elsewhere" / "log" / recorder.segments()[1].path.name).unlink()
    with closing(Recorder(tmp_path / "elsewhere", SystemClock())) as again:
        (reported,) = looked(IntegrityChecker(Term("restore", "")), again).problems()
        assert reported.startswith("Files of the log are gone, by their numbers 2: check the disk")


def test_damage_found_by_a_reader_is_checked_at_once(recorder: Recorder) -> None:
    check = looked(IntegrityChecker(Term("restore", "")), recorder)
    feed = FolderFeed(recorder.folder, recorder.flush, check.recheck)
    assert sum(1 for _ in feed.records()) == 300
    path = flip(recorder)
    assert sum(1 for _ in feed.records()) < 300
    assert looked(check, recorder).damaged == (path,)
    known = set(check._read)
    list(feed.records())
    assert check._read == known, "it is known"


def test_segment_restored_from_a_backup_is_damaged_no_more(
    recorder: Recorder, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As the console advises people to do it."""
    monkeypatch.setattr("base_station.storage.integrity_checker._AGAIN_LOOKS", 50)
    whole = recorder.segments()[0].path.read_bytes()
    path = flip(recorder)
    check = looked(IntegrityChecker(Term("restore", "Restore it.")), recorder)
    assert "Restore it." in check.problems()[0]
    path.write_bytes(whole)
    assert looked(check, recorder, 60).problems() == ()


def test_only_records_stepped_at_the_start_are_lacking() -> None:
    lacking = StaleState()
    lacking.note_stepped(100, 200)
    for end_ns, lacks in ((90, False), (210, False), (150, True), (210, True)):
        lacking.note_mended(end_ns)
        assert lacking.is_stale is lacks
        assert bool(lacking.problems()) is lacks


def test_station_with_missing_records_restarts_when_idle() -> None:
    lacking = StaleState()
    assert not lacking.can_recover(leads=False, spared=True, in_incident=False)
    lacking.note_stepped(100, 200)
    lacking.note_mended(150)
    assert lacking.can_recover(leads=False, spared=False, in_incident=True)
    assert lacking.can_recover(leads=True, spared=True, in_incident=False)
    assert not lacking.can_recover(leads=True, spared=True, in_incident=True)
    assert not lacking.can_recover(leads=True, spared=False, in_incident=False)


def test_records_cut_out_of_a_file_are_missing_though_the_rest_is_readable(
    recorder: Recorder,
) -> None:
    check, path = IntegrityChecker(Term("restore", "")), recorder.segments()[0].path
    check.note_damaged(path, "a chunk is lost", is_cut=True)
    assert looked(check, recorder).damaged == (path,)
    check.note_mended(path)
    assert looked(check, recorder).damaged == ()
