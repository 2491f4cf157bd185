"""The recorder: always on, one for each folder, every loss reported."""

from __future__ import annotations

import errno
import os
import shutil
import tracemalloc
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from threading import Event
from typing import NoReturn

import pytest

from base_station.engine.log_feed import FolderFeed
from base_station.storage.data_folder import DataFolder
from base_station.storage.recorder import LOG_FOLDER, Recorder
from shared.channels import EVENT, OPERATOR, POSITION
from shared.clock import NS_PER_S, ManualClock, SystemClock
from shared.errors import DataFolderInUseError
from shared.mcap_log import (
    SegmentInfo,
    SegmentPolicy,
    SegmentReader,
    SegmentState,
    SegmentWriter,
    read_log,
)
from shared.messages import STATION_ID
from tests.rig.full_disk import files_of_at_most
from tests.rig.waiting import PATIENCE_S, until

KEY = POSITION.key("anna")
T0_NS = 1_700_000_000 * NS_PER_S


@contextmanager
def recording(data: Path, segment_s: float = 900.0) -> Iterator[Recorder]:
    recorder = Recorder(data, SystemClock(), SegmentPolicy(segment_s=segment_s))
    yield recorder
    recorder.close()


def payloads(data: Path) -> list[bytes]:
    return [payload for _, _, payload in read_log(data / LOG_FOLDER)]


def test_urgent_record_is_on_the_disk_when_write_returns(tmp_path: Path) -> None:
    with recording(tmp_path) as recorder:
        assert recorder.write(T0_NS, KEY, b"1")
        assert recorder.write(T0_NS, KEY, b"alarm", urgent=True)
        assert payloads(tmp_path) == [b"1", b"alarm"]


def test_records_in_memory_are_readable_at_once(tmp_path: Path) -> None:
    with recording(tmp_path) as recorder:
        feed = FolderFeed(recorder.folder, recorder.flush)
        for number in range(1000):
            recorder.write(T0_NS + number, KEY, number.to_bytes(2, "big"))
        assert len(list(feed.records())) == 1000


def test_segments_hold_all_records_written_before_the_call(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Another flush is in progress meanwhile; an erasure searches the segments."""
    with recording(tmp_path) as recorder, ThreadPoolExecutor() as others:
        writes, begun, go = recorder._writer.add, Event(), Event()

        def slow(t_ns: int, key: str, payload: bytes) -> bool:
            begun.set()
            go.wait()
            return writes(t_ns, key, payload)

        monkeypatch.setattr(recorder._writer, "add", slow)
        recorder.write(T0_NS, KEY, b"1")
        others.submit(recorder.flush)
        begun.wait()
        recorder.write(T0_NS + 1, KEY, b"2")
        asked = recorder._flushes_asked
        complete = others.submit(recorder.complete_segments)
        until(lambda: recorder._flushes_asked > asked)
        go.set()
        (path,) = complete.result()
        with SegmentReader(path) as reader:
            stated = [payload for _, _, payload in reader.records()]
    assert stated == [b"1", b"2"]


def test_close_writes_the_remaining_records(tmp_path: Path) -> None:
    with recording(tmp_path) as recorder:
        recorder.write(T0_NS, KEY, b"1")
    assert payloads(tmp_path) == [b"1"]


def test_second_station_on_the_folder_is_refused(tmp_path: Path) -> None:
    with recording(tmp_path), pytest.raises(DataFolderInUseError, match="another station is using"):
        Recorder(tmp_path, SystemClock())
    with recording(tmp_path):
        pass


def test_segment_being_written_is_open_and_an_abandoned_one_is_torn(
    tmp_path: Path,
) -> None:
    def states(data: Path) -> list[str]:
        return [info.state.value for info in DataFolder(data).segments()]

    data, copy = tmp_path / "data", tmp_path / "copy"
    with recording(data, segment_s=10.0) as recorder:
        for second in range(15):
            recorder.write(T0_NS + second * NS_PER_S, KEY, b"", urgent=True)
        assert states(data) == ["closed", "open"]
        shutil.copytree(data, copy)  # as a crash would have left it
        assert states(copy) == ["closed", "torn"]
    assert states(data) == ["closed", "closed"]
    with recording(copy):
        assert "torn" not in states(copy)


def test_complete_segments_are_reported(tmp_path: Path) -> None:
    reported: list[tuple[SegmentInfo, str]] = []
    recorder = Recorder(
        tmp_path,
        SystemClock(),
        SegmentPolicy(segment_s=10.0),
        on_segment=lambda info, note: reported.append((info, note)),
    )
    for second in range(15):
        recorder.write(T0_NS + second * NS_PER_S, KEY, b"")
    recorder.flush()
    assert [info.messages for info, _ in reported] == [10]
    assert [info.state for info in recorder.segments()] == [SegmentState.CLOSED, SegmentState.OPEN]
    recorder.close()
    assert [info.messages for info, _ in reported] == [10, 5]

    reported.clear()
    Recorder(tmp_path, SystemClock(), on_segment=lambda *one: reported.append(one)).close()
    assert [(info.messages, note) for info, note in reported] == [(10, ""), (5, "")]


def test_torn_segment_is_repaired_at_the_start_and_reported(tmp_path: Path) -> None:
    torn = SegmentWriter(tmp_path / LOG_FOLDER)
    torn.write(T0_NS, KEY, b"1", urgent=True)
    notes: list[str] = []
    recorder = Recorder(tmp_path, SystemClock(), on_segment=lambda _, note: notes.append(note))
    assert [recovery.messages for recovery in recorder.recoveries] == [1]
    assert "1 records kept" in notes[0]
    recorder.write(T0_NS + 1, KEY, b"2")
    recorder.close()
    assert payloads(tmp_path) == [b"1", b"2"]


def test_failing_list_of_segments_stops_nothing(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    def failing(info: SegmentInfo, note: str) -> None:
        raise ValueError("no list")

    recorder = Recorder(tmp_path, SystemClock(), SegmentPolicy(segment_s=1.0), failing)
    for second in range(5):
        recorder.write(T0_NS + second * NS_PER_S, KEY, bytes([second]))
    recorder.close()
    assert len(payloads(tmp_path)) == 5
    assert "not in the list" in caplog.text


def test_failing_recorder_is_reported_and_counts_refused_records(tmp_path: Path) -> None:
    recorder = Recorder(tmp_path, SystemClock())
    recorder.write("no time", KEY, b"")  # type: ignore[arg-type]  # a bug
    assert not recorder.flush()
    assert "the recorder stopped" in recorder.problem
    assert not recorder.write(T0_NS, KEY, b"")
    assert recorder.lost >= 1
    recorder.close()


def test_hanging_disk_is_reported_and_hardly_waited_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    clock, answers, fsync = ManualClock(), Event(), os.fsync
    recorder = Recorder(tmp_path, clock)

    def hang(descriptor: int) -> None:
        answers.wait()
        fsync(descriptor)

    monkeypatch.setattr("shared.mcap_log.durable_file.os.fsync", hang)
    monkeypatch.setattr("base_station.storage.recorder._LONGEST_WAIT_S", 0.1)
    assert recorder.write(T0_NS, KEY, b"1", urgent=True)
    clock.advance(4.0)
    assert (recorder.is_behind, recorder.hangs, recorder.problem) == (True, False, "")
    clock.advance(2.0)
    assert recorder.hangs
    assert "does not answer" in recorder.problem
    monkeypatch.setattr("base_station.storage.recorder._LONGEST_WAIT_S", 3600.0)
    assert recorder.write(T0_NS, KEY, b"2", urgent=True)
    answers.set()
    until(lambda: not recorder.hangs)
    assert recorder.flush()
    assert recorder.problem == ""
    recorder.close()
    assert payloads(tmp_path) == [b"1", b"2"]


def test_low_disk_space_is_reported_and_is_no_failure(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with recording(tmp_path) as recorder:
        assert recorder.low_disk_space == ""
    monkeypatch.setattr("base_station.storage.recorder._LITTLE_FREE_BYTES", 1 << 62)
    with recording(tmp_path) as recorder:
        assert "MB are free for the log" in recorder.low_disk_space
        assert recorder.problem == ""


def test_disk_of_unknown_free_space_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = Event()

    def fail(_: Path) -> NoReturn:
        asked.set()
        raise OSError(errno.ESTALE, "Stale file handle")

    monkeypatch.setattr("base_station.storage.recorder._DISK_CHECK_INTERVAL_NS", 0)
    with recording(tmp_path) as recorder:
        monkeypatch.setattr(shutil, "disk_usage", fail)
        assert asked.wait(PATIENCE_S)
        assert recorder.write(T0_NS, KEY, b"1", urgent=True)
        assert recorder.problem == ""
    assert payloads(tmp_path) == [b"1"]


@contextmanager
def hanging_disk(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[int]]:
    """A hanging disk until the end of ``with``; counts the calls."""
    answers, fsync, asked = Event(), os.fsync, [0]

    def hang(descriptor: int) -> None:
        asked[0] += 1
        answers.wait(PATIENCE_S)
        fsync(descriptor)

    monkeypatch.setattr("shared.mcap_log.durable_file.os.fsync", hang)
    try:
        yield asked
    finally:
        answers.set()


def test_records_that_waited_for_a_slow_disk_are_written_together(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Written half a second after half a second, a disk that takes longer for each would fall
    behind for ever, and in the end be reported as not answering.
    """
    with recording(tmp_path) as recorder:
        with hanging_disk(monkeypatch) as asked:
            recorder.write(T0_NS, KEY, b"first")
            until(lambda: asked[0] == 1)
            for tenth in range(1, 200):
                recorder.write(T0_NS + tenth * NS_PER_S // 10, KEY, bytes([tenth]))
        until(lambda: recorder.on_disk == 200)
        assert asked[0] <= 4


def test_durable_position_is_known(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with recording(tmp_path) as recorder:
        recorder.write(T0_NS, KEY, b"1", urgent=True)
        assert (recorder.written, recorder.on_disk) == (1, 1)
        with hanging_disk(monkeypatch) as asked:
            recorder.write(T0_NS, KEY, b"2")
            until(lambda: asked[0] > 0)
            recorder.write(T0_NS, KEY, b"3")
            assert (recorder.written, recorder.on_disk) == (3, 1)
        with files_of_at_most(0):
            recorder.write(T0_NS, KEY, b"4", urgent=True)
            assert recorder.on_disk < 4
        until(lambda: recorder.on_disk == 4)


def fill(recorder: Recorder, key: str = KEY) -> int:
    """Write until a record is refused; returns the number of accepted records."""
    taken = 0
    while recorder.write(T0_NS + taken, f"{key[:-1]}{key[-1]}", os.urandom(60)):
        taken += 1
    return taken


def test_records_waiting_for_a_disk_take_bounded_memory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Most of the size of small messages is not their bytes."""
    bound = 4_000_000
    policy = SegmentPolicy(waiting_bytes_max=bound)
    recorder = Recorder(tmp_path, SystemClock(), policy)
    with hanging_disk(monkeypatch) as asked:
        recorder.write(T0_NS, KEY, b"")
        until(lambda: asked[0] > 0)
        tracemalloc.start()
        try:
            fill(recorder)
            held_bytes, _ = tracemalloc.get_traced_memory()
        finally:
            tracemalloc.stop()
        assert 0.5 * bound < held_bytes < 1.05 * bound
    recorder.close()


def test_full_memory_has_room_for_alerts_and_then_for_actions_of_people(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    recorder = Recorder(tmp_path, SystemClock(), SegmentPolicy(waiting_bytes_max=100_000))
    with hanging_disk(monkeypatch) as asked:
        recorder.write(T0_NS, KEY, b"")
        until(lambda: asked[0] > 0)
        keys = (KEY, EVENT.key("anna"), OPERATOR.key(STATION_ID), KEY)
        taken = [fill(recorder, key) for key in keys]
        assert recorder.refuses
        assert recorder.lost == 4
    recorder.close()
    all_of_it, alerts, actions, more = taken
    assert more == 0
    assert 0.2 * all_of_it < alerts < 0.3 * all_of_it
    assert 0.2 * all_of_it < actions < 0.3 * all_of_it
    assert len(payloads(tmp_path)) == 1 + sum(taken)
