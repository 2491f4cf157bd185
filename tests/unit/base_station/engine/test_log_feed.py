"""Feed of a log's folder: records as they were recorded, and what was written anew."""

from __future__ import annotations

from pathlib import Path

from base_station.engine.log_feed import FolderFeed
from shared.channels import EVENT, POSITION
from shared.clock import NS_PER_S
from shared.mcap_log import (
    Segment,
    SegmentIdentity,
    SegmentWriter,
    pack_segment,
    rewrite_segment,
    segment_path,
    segment_paths,
)

KEY = POSITION.key("anna")
ALERT = EVENT.key("anna")


def test_log_feeds_its_records_and_requests_the_flush_first(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path)
    for second in range(10):
        writer.write(second * NS_PER_S, KEY if second % 2 else ALERT, bytes([second]))
    feed = FolderFeed(tmp_path, writer.flush)
    assert [payload[0] for _, _, payload in feed.records()] == list(range(10))
    window = feed.records(3 * NS_PER_S, 8 * NS_PER_S, {KEY})
    assert [payload[0] for _, _, payload in window] == [3, 5, 7]


def test_log_feed_detects_rewriting_and_not_growth(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path)
    writer.write(0, KEY, b"with a name in it", urgent=True)
    changed = FolderFeed(tmp_path).watch()
    writer.write(NS_PER_S, KEY, b"and more", urgent=True)
    writer.end_segment()
    writer.write(2 * NS_PER_S, KEY, b"the next one", urgent=True)
    assert not changed()
    first, _ = segment_paths(tmp_path)
    assert pack_segment(first)
    assert not changed()
    rewrite_segment(first, lambda record: [(*record[:2], b"without")])
    assert changed()
    changed = FolderFeed(tmp_path).watch()
    assert not changed()
    assert pack_segment(first)
    assert not changed()
    rewrite_segment(first, lambda _: [])
    assert changed()
    writer.close()


def test_log_feed_detects_rewriting_of_a_log_of_an_earlier_version(tmp_path: Path) -> None:
    segment = Segment(segment_path(tmp_path, 1, 0), 1000, SegmentIdentity())
    segment.add(0, KEY, b"with a name in it")
    segment.finish()
    segment.file.sync()
    segment.file.close()
    changed = FolderFeed(tmp_path).watch()
    assert not changed()
    rewrite_segment(segment.file.path, lambda record: [(*record[:2], b"without")])
    assert changed()
