"""A tail of a log gives every record once, while the log is written."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from shared.mcap_log import LogTail, SegmentPolicy, SegmentWriter, segment_paths
from tests.rig.small_log import KEY, T0_NS

PAYLOAD = b"no message of ours, and none is needed here"


@pytest.fixture
def tail(tmp_path: Path) -> Iterator[LogTail]:
    with LogTail(tmp_path) as opened:
        yield opened


def write(writer: SegmentWriter, first: int, last: int) -> None:
    for number in range(first, last):
        writer.write(T0_NS + number, KEY, b"%d %b" % (number, PAYLOAD))
    writer.flush()


def numbers(tail: LogTail) -> list[int]:
    records = tail.read()
    assert all(key == KEY and int(payload.split()[0]) == t - T0_NS for t, key, payload in records)
    return [t_ns - T0_NS for t_ns, _, _ in records]


def test_each_record_comes_once_and_in_order(tmp_path: Path, tail: LogTail) -> None:
    writer = SegmentWriter(tmp_path)
    assert numbers(tail) == []
    write(writer, 0, 10)
    assert numbers(tail) == list(range(10))
    assert numbers(tail) == []
    write(writer, 10, 12)
    assert numbers(tail) == [10, 11]


def test_tail_starts_with_the_newest_segment_and_continues_to_the_next(
    tmp_path: Path, tail: LogTail
) -> None:
    writer = SegmentWriter(tmp_path)
    write(writer, 0, 3)
    writer.end_segment()
    write(writer, 3, 5)
    assert numbers(tail) == [3, 4]
    write(writer, 5, 6)
    writer.end_segment()
    write(writer, 6, 7)
    writer.end_segment()
    write(writer, 7, 8)
    assert numbers(tail) + numbers(tail) + numbers(tail) == [5, 6, 7]
    assert tail.damage == []


def test_a_chunk_that_is_larger_than_what_is_read_at_once_comes_whole(
    tmp_path: Path, tail: LogTail, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("shared.mcap_log.tail._READ_BYTES", 200)
    writer = SegmentWriter(tmp_path, SegmentPolicy(chunk_bytes=1 << 20))
    write(writer, 0, 400)
    found: list[int] = []
    while more := numbers(tail):
        found += more
    assert found == list(range(400))


@pytest.mark.parametrize("cut_bytes", [1, 8, 60, 300])
def test_a_record_of_which_a_part_is_in_the_file_comes_with_the_rest(
    tmp_path: Path, tail: LogTail, cut_bytes: int
) -> None:
    writer = SegmentWriter(tmp_path / "whole")
    write(writer, 0, 5)
    write(writer, 5, 9)
    source = segment_paths(tmp_path / "whole")[0]
    data = source.read_bytes()
    growing = tmp_path / source.name
    growing.write_bytes(data[:-cut_bytes])
    found = numbers(tail)
    growing.write_bytes(data)
    assert found + numbers(tail) == list(range(9))
    assert tail.damage == []


def test_a_damaged_chunk_is_left_out_and_named(tmp_path: Path, tail: LogTail) -> None:
    writer = SegmentWriter(tmp_path)
    write(writer, 0, 3)
    path = segment_paths(tmp_path)[0]
    begin = path.stat().st_size
    write(writer, 3, 6)
    write(writer, 6, 7)
    with path.open("r+b") as file:
        file.seek(begin + 70)
        flipped = bytes(255 - byte for byte in file.read(4))
        file.seek(begin + 70)
        file.write(flipped)
    assert numbers(tail) == [0, 1, 2, 6]
    [damage] = tail.damage
    assert "chunk" in damage


def test_bytes_that_are_no_records_end_a_segment(tmp_path: Path, tail: LogTail) -> None:
    writer = SegmentWriter(tmp_path)
    write(writer, 0, 2)
    with segment_paths(tmp_path)[0].open("ab") as file:
        file.write(b"\xee" * 100)
    assert numbers(tail) == [0, 1]
    assert numbers(tail) == []
    [damage] = tail.damage
    assert "makes no sense" in damage
