"""The list of a log's segments: read at the start, added to, and read again when rewritten."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

import pytest

from base_station.storage.segment_list import SegmentList
from shared.clock import NS_PER_S
from shared.mcap_log import SegmentInfo, SegmentPolicy, SegmentReader, SegmentWriter, segment_paths
from tests.rig.small_log import KEY, T0_NS


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Two segments of ten records."""
    with closing(SegmentWriter(tmp_path, SegmentPolicy(segment_s=10.0))) as log:
        for second in range(20):
            log.write(T0_NS + second * NS_PER_S, KEY, b"%d" % second)
    return tmp_path


def info_of(path: Path) -> SegmentInfo:
    with SegmentReader(path) as reader:
        return reader.info()


def test_segments_of_the_folder_are_listed_and_reported(folder: Path) -> None:
    reported: list[tuple[Path, str]] = []
    listed = SegmentList(folder, lambda info, note: reported.append((info.path, note)))
    paths = segment_paths(folder)
    assert len(paths) == 2
    assert [one.path for one in listed.segments] == paths
    assert reported == [(path, "") for path in paths]
    assert (listed.recoveries, listed.foreign) == ((), {})


def test_added_segment_is_reported_though_the_handler_fails(
    folder: Path, caplog: pytest.LogCaptureFixture
) -> None:
    last = segment_paths(folder)[-1]
    added = info_of(last)
    last.rename(folder / "aside")

    def fail(info: SegmentInfo, note: str) -> None:
        raise OSError(info.path.name)

    listed = SegmentList(folder, fail)
    listed.add(added)
    assert [one.path for one in listed.segments][-1] == last
    assert f"segment {last.name} is not in the list of segments" in caplog.text


def test_rewritten_segment_is_described_anew(folder: Path) -> None:
    listed = SegmentList(folder, lambda info, note: None)
    first, last = segment_paths(folder)
    before = listed.segments[0]
    first.write_bytes(last.read_bytes())
    listed.note_rewritten(first)
    assert listed.segments[0] == info_of(first) != before
