"""A disk that takes nothing: the writer goes on, says so, and loses nothing that it accepted."""

from __future__ import annotations

import resource
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from base_station.recorder import Recorder
from shared.channels import POSITION
from shared.clock import NS_PER_S, SystemClock
from shared.mcap_log import SegmentInfo, SegmentPolicy, SegmentWriter, read_log, segment_paths

KEY = POSITION.key("anna")
T0_NS = 1_700_000_000 * NS_PER_S


@contextmanager
def files_of_at_most(size_bytes: int) -> Iterator[None]:
    """The kernel refuses to let files grow: the same calls fail as on a full disk."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size_bytes, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, handler)


def write_seconds(writer: SegmentWriter, seconds: range) -> int:
    """Ten records a second; how many were accepted."""
    return sum(
        writer.write(T0_NS + second * NS_PER_S + tenth, KEY, b"%d.%d" % (second, tenth) * 50)
        for second in seconds
        for tenth in range(10)
    )


def payloads(folder: Path) -> list[bytes]:
    return [payload for _, _, payload in read_log(folder)]


def expected(seconds: range) -> list[bytes]:
    return [b"%d.%d" % (second, tenth) * 50 for second in seconds for tenth in range(10)]


def test_what_waited_for_the_disk_goes_to_its_place_when_there_is_room(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path)
    write_seconds(writer, range(20))
    assert writer.problem == ""
    with files_of_at_most(segment_paths(tmp_path)[0].stat().st_size + 100):
        assert write_seconds(writer, range(20, 60)) == 400
        assert "cannot be written" in writer.problem
        assert "free or mend the disk" in writer.problem
        assert writer.waiting_bytes > 0
    write_seconds(writer, range(60, 62))
    assert writer.problem == ""
    writer.close()
    assert payloads(tmp_path) == expected(range(62))
    assert writer.lost == 0


def test_segments_that_end_on_a_full_disk_are_whole_later(tmp_path: Path) -> None:
    closed: list[SegmentInfo] = []
    writer = SegmentWriter(tmp_path, SegmentPolicy(segment_s=10.0), closed.append)
    with files_of_at_most(0):
        write_seconds(writer, range(35))
        assert closed == []
        assert writer.problem
    writer.close()
    assert [info.path for info in closed] == segment_paths(tmp_path)
    assert len(closed) == 4
    assert payloads(tmp_path) == expected(range(35))


def test_records_beyond_what_memory_may_hold_are_refused_and_counted(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path, SegmentPolicy(waiting_bytes_max=2000))
    with files_of_at_most(0):
        accepted = write_seconds(writer, range(100))
        assert 0 < accepted < 1000
        assert writer.lost == 1000 - accepted
        assert f"{writer.lost} records are lost" in writer.problem
    write_seconds(writer, range(100, 102))
    writer.close()
    kept = payloads(tmp_path)
    assert len(kept) + writer.lost == 1020
    assert kept[:accepted] == expected(range(100))[:accepted]


def test_closing_on_a_full_disk_says_what_is_left_behind(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path)
    with files_of_at_most(0):
        write_seconds(writer, range(3))
        writer.close()
    assert writer.problem


def test_what_a_recorder_lost_is_said_until_it_starts_anew(tmp_path: Path) -> None:
    recorder = Recorder(tmp_path, SystemClock(), SegmentPolicy(waiting_bytes_max=2000))
    with files_of_at_most(0):
        for number in range(100):
            recorder.write(T0_NS + number, KEY, bytes(200), urgent=True)
    assert recorder.flush()
    assert recorder.lost > 0
    assert recorder.problem == (
        f"the disk did not keep up: {recorder.lost} records are missing in the log"
    )
    recorder.close()
    assert len(payloads(tmp_path / "log")) + recorder.lost == 100


def test_a_recorder_on_a_full_disk_is_behind_until_there_is_room(tmp_path: Path) -> None:
    recorder = Recorder(tmp_path, SystemClock())
    with files_of_at_most(0):
        assert recorder.write(T0_NS, KEY, b"1", urgent=True)
        assert (recorder.flush(), recorder.is_behind) == (False, True)
        assert "cannot be written" in recorder.problem
    assert (recorder.flush(), recorder.is_behind) == (True, False)
    recorder.close()
    assert payloads(tmp_path / "log") == [b"1"]
