"""Reading the log: during writing, windows of time, and missing parts."""

from __future__ import annotations

from pathlib import Path

import pytest

from shared.clock import NS_PER_S
from shared.mcap_log import (
    SegmentPolicy,
    SegmentReader,
    SegmentState,
    SegmentWriter,
    read_log,
    recover_log,
    segment_paths,
)
from shared.mcap_log.segment_file import SegmentFile
from tests.rig.small_log import KEY, T0_NS


def test_open_segment_is_readable_up_to_the_last_flush(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path)
    writer.write(T0_NS, KEY, b"1", urgent=True)
    writer.write(T0_NS + 1, KEY, b"2")
    with SegmentReader(segment_paths(tmp_path)[0]) as reader:
        assert list(reader.records()) == [(T0_NS, KEY, b"1")]
        assert reader.info().state is SegmentState.TORN
        assert reader.damage == []


def test_a_folder_that_is_not_there_has_no_records(tmp_path: Path) -> None:
    assert list(read_log(tmp_path / "nowhere")) == []
    assert recover_log(tmp_path / "nowhere") == []


def test_a_window_opens_only_the_segments_that_it_needs(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path, SegmentPolicy(segment_s=10.0))
    for tenth in range(400):
        writer.write(T0_NS + tenth * NS_PER_S // 10, KEY, bytes([tenth // 256, tenth % 256]))
    writer.close()
    paths = segment_paths(tmp_path)
    for unneeded in (paths[0], paths[3]):
        unneeded.write_bytes(b"not to be read")
    damage: list[str] = []
    window = read_log(
        tmp_path, T0_NS + 11 * NS_PER_S, T0_NS + 29 * NS_PER_S, on_damage=damage.append
    )
    assert [t_ns for t_ns, _, _ in window] == [
        T0_NS + tenth * NS_PER_S // 10 for tenth in range(110, 290)
    ]
    assert damage == []


def test_records_of_one_time_on_both_sides_of_a_border_are_found(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path)
    t_ns = T0_NS + NS_PER_S - 1  # the last nanosecond of the second in which the next one begins
    for number in range(4):
        writer.write(t_ns, KEY, bytes([number]))
        if number % 2:
            writer.end_segment()
    writer.close()
    assert len(segment_paths(tmp_path)) == 2
    for end_ns in (None, t_ns + 1):
        found = read_log(tmp_path, t_ns, end_ns)
        assert [payload for _, _, payload in found] == [b"\0", b"\1", b"\2", b"\3"]
    assert list(read_log(tmp_path, t_ns + 1)) == list(read_log(tmp_path, None, t_ns)) == []


def test_unopenable_segment_does_not_prevent_reading_the_others(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path)
    for number in range(3):
        writer.write(T0_NS + number * NS_PER_S, KEY, bytes([number]))
        writer.end_segment()
    writer.close()
    path = segment_paths(tmp_path)[1]
    path.unlink()
    path.symlink_to(path.name)  # to open it is an error of the file system
    damage: list[str] = []
    found = [payload for _, _, payload in read_log(tmp_path, on_damage=damage.append)]
    assert found == [b"\0", b"\2"]
    (reported,) = damage
    assert reported.startswith(f"{path.name}: the disk does not give it (")
    assert recover_log(tmp_path) == [], "it may be there again tomorrow"
    with SegmentReader(path) as reader:
        assert reader.info().state is SegmentState.UNREADABLE
        assert not reader.is_whole()


def test_a_damaged_length_takes_no_memory_for_what_is_not_there(tmp_path: Path) -> None:
    path = tmp_path / "short"
    path.write_bytes(b"123")
    file = SegmentFile(path)
    assert file.read(1, 2) == b"23"
    with pytest.raises(ValueError, match="ends before"):
        file.read(0, 1 << 60)
    file.close()
