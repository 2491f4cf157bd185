"""Writing the log: flushing, chunks, and where one segment ends and the next begins."""

from __future__ import annotations

from pathlib import Path

import pytest

from shared.clock import NS_PER_S
from shared.errors import LogError
from shared.mcap_log import (
    SegmentInfo,
    SegmentPolicy,
    SegmentReader,
    SegmentWriter,
    recover_log,
    segment_paths,
)
from tests.rig.small_log import KEY, T0_NS, on_disk


def test_a_record_is_on_the_disk_half_a_second_of_log_time_later(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path)
    writer.write(T0_NS, KEY, b"1")
    writer.write(T0_NS + 400_000_000, KEY, b"2")
    assert on_disk(tmp_path) == []
    writer.advance(T0_NS + 499_999_999)
    assert on_disk(tmp_path) == []
    writer.advance(T0_NS + 500_000_000)
    assert on_disk(tmp_path) == [b"1", b"2"]


def test_ended_segment_is_closed_and_private(tmp_path: Path) -> None:
    """A station runs for months, and its log says where people were."""
    writer = SegmentWriter(tmp_path)
    for number in range(3):
        writer.write(T0_NS + number, KEY, b"1", urgent=True)
        writer.end_segment()
    held = {link.resolve() for link in Path("/proc/self/fd").iterdir()}
    paths = segment_paths(tmp_path)
    assert len(paths) == 3
    assert held.isdisjoint(paths)
    assert {path.stat().st_mode & 0o777 for path in paths} == {0o640}


def test_an_urgent_record_is_on_the_disk_at_once_with_all_before_it(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path)
    writer.write(T0_NS, KEY, b"1")
    writer.write(T0_NS + 1, KEY, b"mayday", urgent=True)
    assert on_disk(tmp_path) == [b"1", b"mayday"]


def test_records_with_equal_times_keep_their_order(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path, SegmentPolicy(chunk_bytes=100))
    payloads = [bytes([number]) for number in range(100)]
    for number, payload in enumerate(payloads):
        writer.write(T0_NS, f"key/{number % 7}", payload)
    writer.close()
    assert on_disk(tmp_path) == payloads


def test_segments_end_by_time_and_are_reported_of(tmp_path: Path) -> None:
    closed: list[SegmentInfo] = []
    writer = SegmentWriter(tmp_path, SegmentPolicy(segment_s=10.0), closed.append)
    for second in range(25):
        writer.write(T0_NS + second * NS_PER_S, KEY, bytes([second]))
    writer.close()
    assert [path.name for path in segment_paths(tmp_path)] == [
        "000001-20231114T221320Z.mcap",
        "000002-20231114T221330Z.mcap",
        "000003-20231114T221340Z.mcap",
    ]
    assert [info.path for info in closed] == segment_paths(tmp_path)
    assert [(info.start_ns - T0_NS) // NS_PER_S for info in closed] == [0, 10, 20]
    assert [(info.end_ns - T0_NS) // NS_PER_S for info in closed] == [9, 19, 24]
    assert [info.messages for info in closed] == [10, 10, 5]
    for info in closed:
        with SegmentReader(info.path) as reader:
            assert reader.info() == info
    assert on_disk(tmp_path) == [bytes([second]) for second in range(25)]


def test_burst_of_records_is_split_into_chunks(tmp_path: Path) -> None:
    """A flipped bit costs a chunk."""
    writer = SegmentWriter(tmp_path, SegmentPolicy(chunk_bytes=4096))
    for number in range(100):
        writer.write(T0_NS, KEY, bytes([number]) * 1000)
    writer.close()
    with SegmentReader(segment_paths(tmp_path)[0]) as reader:
        sizes = [len(chunk.data) for chunk in reader.intact_chunks()]
    assert len(sizes) > 20
    assert max(sizes) < 4096 + 1100


def test_a_segment_ends_before_its_index_fills_the_memory(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path, SegmentPolicy(index_entries_max=50))
    for number in range(300):
        writer.write(T0_NS + number, f"key/{number % 20}", b"", urgent=number % 20 == 19)
    writer.close()
    assert len(segment_paths(tmp_path)) == 5
    assert len(on_disk(tmp_path)) == 300


def test_a_new_writer_goes_on_behind_the_old_segments(tmp_path: Path) -> None:
    for payload in (b"first", b"second"):
        writer = SegmentWriter(tmp_path)
        writer.write(T0_NS, KEY, payload)
        writer.close()
    assert on_disk(tmp_path) == [b"first", b"second"]


def test_a_writer_without_records_leaves_no_file(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path / "log")
    writer.advance(T0_NS)
    writer.close()
    assert list((tmp_path / "log").iterdir()) == []


def test_a_folder_that_cannot_be_made_is_stated_in_words(tmp_path: Path) -> None:
    (tmp_path / "log").write_text("a file")
    with pytest.raises(LogError, match="cannot be used"):
        SegmentWriter(tmp_path / "log")


def test_files_that_are_no_segments_are_left_alone(tmp_path: Path) -> None:
    for name in ("notes.txt", "recording.mcap", "000001-sometime.mcap"):
        (tmp_path / name).write_bytes(b"mine")
    writer = SegmentWriter(tmp_path)
    writer.write(T0_NS, KEY, b"1")
    writer.close()
    assert recover_log(tmp_path) == []
    assert on_disk(tmp_path) == [b"1"]
    assert (tmp_path / "recording.mcap").read_bytes() == b"mine"
