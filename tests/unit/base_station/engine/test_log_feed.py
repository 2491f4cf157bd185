"""Feed of a log's folder: records as they were recorded, and what was written anew."""

from __future__ import annotations

from pathlib import Path

from base_station.engine.log_feed import FolderFeed
from shared.channels import EVENT, POSITION
from shared.clock import NS_PER_S
from shared.mcap_log import SegmentWriter

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
    first, second = (tmp_path / f"{number:06d}-20261122T070000Z.mcap" for number in (1, 2))
    first.write_bytes(b"with a name in it")
    changed = FolderFeed(tmp_path).watch()
    with first.open("ab") as growing:
        growing.write(b" and more")
    second.write_bytes(b"the next one")
    assert not changed()
    anew = tmp_path / "anew"
    anew.write_bytes(b"without")
    anew.replace(first)
    assert changed()
    assert not FolderFeed(tmp_path).watch()()
