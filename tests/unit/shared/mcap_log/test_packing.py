"""A complete segment is packed in larger chunks, and has the same records."""

from __future__ import annotations

import errno
import itertools
import os
from pathlib import Path

import pytest
from mcap.reader import make_reader

from shared.clock import NS_PER_S
from shared.errors import LogError
from shared.mcap_log import (
    DELTA_TOPIC,
    LogTail,
    SegmentPolicy,
    SegmentReader,
    SegmentWriter,
    can_be_packed,
    identity_of,
    location_topic,
    pack_segment,
    read_log,
    recover_log,
    rewrite_segment,
    segment_paths,
)
from shared.mcap_log.packing import PACKED_BYTES
from shared.mcap_log.recovery import MAKING
from tests.rig.small_log import KEY, T0_NS

TOPICS = [KEY, "muster/v1/other/up/status", location_topic("anna"), DELTA_TOPIC]
SECONDS = 60
PAYLOAD = bytes(range(256)) * 40


def write(folder: Path, seconds: int = SECONDS) -> Path:
    """A segment with two chunks a second, and an open one behind it."""
    writer = SegmentWriter(folder, SegmentPolicy(flush_every_s=0.5))
    for half in range(2 * seconds):
        for topic in TOPICS:
            payload = f"{half} {topic}".encode() + PAYLOAD
            writer.write(T0_NS + half * NS_PER_S // 2, topic, payload, urgent=topic == TOPICS[-1])
    writer.end_segment()
    [path] = segment_paths(folder)
    writer.write(T0_NS + seconds * NS_PER_S, KEY, b"open", urgent=True)
    return path


def as_others_read(path: Path) -> list[tuple[object, ...]]:
    """Everything that the library's reader shows of each message."""
    with path.open("rb") as file:
        messages = make_reader(file, validate_crcs=True).iter_messages(log_time_order=False)
        return [
            (
                channel.topic,
                channel.message_encoding,
                schema and schema.name,
                message.log_time,
                message.publish_time,
                message.sequence,
                message.data,
            )
            for schema, channel, message in messages
        ]


def test_packed_segment_has_the_same_records_in_fewer_bytes(tmp_path: Path) -> None:
    path = write(tmp_path)
    records, shown = list(read_log(tmp_path, derived=True)), as_others_read(path)
    identity, size = identity_of(path), path.stat().st_size
    assert can_be_packed(path)
    assert pack_segment(path)
    assert not can_be_packed(path)
    assert list(read_log(tmp_path, derived=True)) == records
    assert as_others_read(path) == shown
    assert len(shown) == 2 * SECONDS * len(TOPICS)
    assert identity_of(path) == identity
    assert path.stat().st_size < 0.6 * size
    with SegmentReader(path) as reader:
        assert reader.is_whole()
        *sizes, last = reader.chunk_sizes()
    assert len(sizes) == 4
    assert all(PACKED_BYTES <= one < 1.2 * PACKED_BYTES for one in sizes)
    assert last < PACKED_BYTES
    assert [one.path for one in recover_log(tmp_path)] == [segment_paths(tmp_path)[1]]


@pytest.mark.parametrize("key", TOPICS)
def test_a_topic_of_a_span_is_read_by_the_index(tmp_path: Path, key: str) -> None:
    path = write(tmp_path)
    span = T0_NS + 20 * NS_PER_S, T0_NS + 40 * NS_PER_S
    wanted = [one for one in read_log(tmp_path, *span, derived=True) if one[1] == key]
    pack_segment(path)
    assert list(read_log(tmp_path, *span, keys={key}, derived=True)) == wanted
    assert len(wanted) == 40


def test_readers_that_have_it_open_go_on(tmp_path: Path) -> None:
    path = write(tmp_path)
    expected = list(read_log(tmp_path, derived=True))
    with SegmentReader(path) as reader:
        records = reader.records(derived=True)
        first = next(records)
        pack_segment(path)
        assert [first, *records] == expected[:-1]
    with LogTail(tmp_path) as tail:
        assert tail.read() == expected[-1:]


def test_segment_that_cannot_be_read_whole_stays_as_it_is(tmp_path: Path) -> None:
    path = write(tmp_path)
    flipped = bytearray(path.read_bytes())
    flipped[len(flipped) // 2] ^= 0xFF
    path.write_bytes(flipped)
    assert not pack_segment(path)
    assert path.read_bytes() == flipped
    assert [one.name for one in tmp_path.iterdir() if one.name.endswith(MAKING)] == []


@pytest.mark.parametrize("cut", [0.3, 0.999])
def test_torn_segment_is_not_packed(tmp_path: Path, cut: float) -> None:
    path = write(tmp_path)
    path.write_bytes(path.read_bytes()[: round(cut * path.stat().st_size)])
    assert not can_be_packed(path)
    assert not can_be_packed(segment_paths(tmp_path)[1])  # that is being written


def test_file_of_more_than_records_stays_as_it_is(tmp_path: Path) -> None:
    path = write(tmp_path)
    records = list(read_log(tmp_path))[:-1]
    with_more = tmp_path / "incident" / path.name
    with_more.parent.mkdir()
    writer = SegmentWriter(with_more.parent, SegmentPolicy(chunk_bytes=100))
    for record in records:
        writer.write(*record, urgent=True)
    assert writer._segment is not None
    writer._segment.add_attachment("picture", "image/png", b"pixels", T0_NS)
    writer.close()
    [with_more] = segment_paths(with_more.parent)
    assert can_be_packed(with_more)
    assert not pack_segment(with_more)


def test_rewritten_segment_is_packed_again(tmp_path: Path) -> None:
    path = write(tmp_path)
    pack_segment(path)
    rewrite_segment(path, lambda record: [(*record[:2], b"x" * 100_000)])
    assert can_be_packed(path)
    assert pack_segment(path)
    identity = identity_of(path)
    assert identity is not None
    assert identity.revision == 1


def test_full_disk_leaves_the_segment_and_no_other_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write(tmp_path)
    before, names = path.read_bytes(), sorted(tmp_path.iterdir())
    real, count = os.pwrite, itertools.count()

    def full(file: int, data: bytes, offset: int) -> int:
        if next(count) > 5:
            raise OSError(errno.ENOSPC, "No space left on device")
        return real(file, data, offset)

    monkeypatch.setattr(os, "pwrite", full)
    with pytest.raises(LogError, match="No space left"):
        pack_segment(path)
    assert path.read_bytes() == before
    assert sorted(tmp_path.iterdir()) == names


def test_packing_that_was_killed_leaves_the_segment_and_no_other_file(tmp_path: Path) -> None:
    path = write(tmp_path)
    before = path.read_bytes()
    half_made = path.with_name(path.name + MAKING)
    half_made.write_bytes(before[: len(before) // 2])
    recover_log(tmp_path)
    assert path.read_bytes() == before
    assert not half_made.exists()
    half_made.write_bytes(b"of another that was killed")
    assert pack_segment(path)
    assert not half_made.exists()
