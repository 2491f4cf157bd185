"""A segment is rewritten with other records in place of some."""

from __future__ import annotations

from pathlib import Path

from shared.mcap_log import (
    LogRecord,
    SegmentPolicy,
    SegmentReader,
    SegmentState,
    SegmentWriter,
    location_topic,
    recover_log,
    rewrite_segment,
    segment_paths,
)
from tests.rig.small_log import KEY, T0_NS, as_others_read, on_disk


def test_segment_without_remaining_records_stays_as_an_empty_one(tmp_path: Path) -> None:
    """Its name stays, and with it what stands before and behind it."""
    writer = SegmentWriter(tmp_path)
    for number in range(3):
        writer.write(T0_NS + number, KEY, bytes([number]), urgent=True)
        writer.end_segment()
    middle = segment_paths(tmp_path)[1]
    assert rewrite_segment(middle, lambda _: []) == 1
    assert on_disk(tmp_path) == [b"\0", b"\2"]
    with SegmentReader(middle) as reader:
        info = reader.info()
        assert reader.is_whole()
    assert (info.state, info.messages, info.start_ns) == (SegmentState.CLOSED, 0, 0)
    assert recover_log(tmp_path) == []
    assert as_others_read(middle) == []


def test_open_reader_sees_the_segment_before_its_rewrite(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path, SegmentPolicy(chunk_bytes=10))
    for number in range(3):
        writer.write(T0_NS + number, KEY, bytes([number]))
    writer.close()
    [path] = segment_paths(tmp_path)
    with SegmentReader(path) as reader:
        records = reader.records()
        first = next(records)
        rewrite_segment(path, lambda record: [(record[0], record[1], b"anew")])
        assert [one[2] for one in (first, *records)] == [b"\0", b"\1", b"\2"]
    assert on_disk(tmp_path) == [b"anew"] * 3


def test_topics_for_other_programs_are_kept_in_a_rewrite(
    tmp_path: Path,
) -> None:
    writer = SegmentWriter(tmp_path)
    for key in (KEY, location_topic("anna")):
        writer.write(T0_NS, key, b"said")
    writer.close()
    [path] = segment_paths(tmp_path)

    def forget(record: LogRecord) -> list[LogRecord]:
        return [(record[0], record[1], b"")] if record[1] == KEY else [record]

    assert rewrite_segment(path, forget) == 1
    left = [(channel.topic, message.data) for _, channel, message in as_others_read(path)]
    assert left == [(KEY, b""), (location_topic("anna"), b"said")]
