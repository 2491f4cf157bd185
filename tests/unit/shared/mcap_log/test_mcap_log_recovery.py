"""Segments torn by a crash are closed in order, and the loss is reported."""

from __future__ import annotations

import errno
from pathlib import Path
from typing import NoReturn

import pytest
from mcap.reader import make_reader

from shared.channels import TEMPERATURE
from shared.errors import LogError
from shared.mcap_log import (
    SegmentReader,
    SegmentWriter,
    read_log,
    recover_log,
    rewrite_segment,
    segment_paths,
)
from shared.mcap_log.container import RECORD
from tests.rig.small_log import KEY, T0_NS, as_others_read, on_disk


def test_a_recovery_that_was_cut_off_goes_on(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path)
    writer.write(T0_NS, KEY, b"1", urgent=True)
    [path] = segment_paths(tmp_path)
    path.with_name(path.name + ".recovering").write_bytes(b"half made")
    path.rename(path.with_name(path.name + ".torn"))
    [recovery] = recover_log(tmp_path)
    assert recovery.path == path
    assert recovery.bytes_lost == 0
    assert "1 records kept" in str(recovery)
    assert on_disk(tmp_path) == [b"1"]
    assert sorted(file.name for file in tmp_path.iterdir()) == [path.name, path.name + ".torn"]


def test_every_original_of_a_repeatedly_truncated_segment_is_kept(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path)
    writer.write(T0_NS, KEY, b"1", urgent=True)
    [path] = segment_paths(tmp_path)
    for number in range(3):
        with path.open("ab") as file:
            file.write(bytes([number]))
        assert len(recover_log(tmp_path)) == 1
    names = [f"{path.name}{torn}" for torn in ("", ".torn", ".torn2", ".torn3")]
    assert sorted(one.name for one in tmp_path.iterdir()) == names
    assert [(tmp_path / name).read_bytes()[-1] for name in names[1:]] == [0, 1, 2]
    assert on_disk(tmp_path) == [b"1"]


def test_a_recovery_that_was_cut_off_goes_on_with_the_last_of_several_originals(
    tmp_path: Path,
) -> None:
    writer = SegmentWriter(tmp_path)
    originals = []
    for number in range(3):
        writer.write(T0_NS + number, KEY, bytes([number]), urgent=True)
        originals.append(segment_paths(tmp_path)[0].read_bytes())
    [path] = segment_paths(tmp_path)
    path.unlink()
    for torn, original in zip((".torn", ".torn2", ".torn10"), originals, strict=True):
        path.with_name(path.name + torn).write_bytes(original)
    path.with_name(path.name + ".torn.copy").write_bytes(b"somebody's own")
    path.with_name(path.name + ".recovering").write_bytes(b"half made")
    [recovery] = recover_log(tmp_path)
    assert recovery.torn_path.read_bytes() == originals[-1]
    assert on_disk(tmp_path) == [b"\0", b"\1", b"\2"]


def test_unfinished_repair_does_not_replace_an_existing_segment(
    tmp_path: Path,
) -> None:
    """Forgetting was cut off: what was mended before, and perhaps forgotten in, stays."""
    writer = SegmentWriter(tmp_path)
    writer.write(T0_NS, KEY, b"1", urgent=True)
    recover_log(tmp_path)
    [path] = segment_paths(tmp_path)
    assert rewrite_segment(path, lambda record: [(*record[:2], b"(forgotten)")]) == 1
    path.with_name(path.name + ".recovering").write_bytes(b"half made")
    assert recover_log(tmp_path) == []
    assert on_disk(tmp_path) == [b"(forgotten)"]
    assert sorted(one.name for one in tmp_path.iterdir()) == [path.name, path.name + ".torn"]


def test_a_segment_that_was_moved_away_does_not_come_back(tmp_path: Path) -> None:
    """The recovered part of a segment before its repair stays in its place."""
    writer = SegmentWriter(tmp_path)
    writer.write(T0_NS, KEY, b"1", urgent=True)
    recover_log(tmp_path)
    [path] = segment_paths(tmp_path)
    path.unlink()
    assert recover_log(tmp_path) == []
    assert [one.name for one in tmp_path.iterdir()] == [path.name + ".torn"]


@pytest.mark.parametrize(
    ("torn_off", "reported"), [(b"", "kept, whole"), (b"torn", "kept, 4 bytes")]
)
def test_loss_by_truncation_is_reported(tmp_path: Path, torn_off: bytes, reported: str) -> None:
    writer = SegmentWriter(tmp_path)
    writer.write(T0_NS, KEY, b"1", urgent=True)
    [path] = segment_paths(tmp_path)
    with path.open("ab") as file:
        file.write(torn_off)
    [recovery] = recover_log(tmp_path)
    assert reported in str(recovery)
    assert recover_log(tmp_path) == []


@pytest.mark.parametrize("half", [0, 8])
def test_the_times_of_a_chunk_are_those_of_what_is_in_it(tmp_path: Path, half: int) -> None:
    """Its head is outside its checksum: bits that flip there would hide it from every window."""
    writer = SegmentWriter(tmp_path)
    for number in range(3):
        writer.write(T0_NS + number, KEY, bytes([number]), urgent=number == 2)
    [path] = segment_paths(tmp_path)
    with SegmentReader(path) as reader:
        time_at = reader._contents.chunks[0].offset + RECORD.size + half
    original = path.read_bytes()
    content = bytearray(original)
    content[time_at + 7] ^= 0x08
    path.write_bytes(content)
    assert len(recover_log(tmp_path)) == 1
    with SegmentReader(path) as reader:
        assert (reader.info().start_ns, reader.info().end_ns) == (T0_NS, T0_NS + 2)
        assert [payload for _, _, payload in reader.records(T0_NS + 1, T0_NS + 2)] == [b"\1"]
        [chunk] = reader.intact_chunks()
    assert chunk.record in original


def test_damage_before_the_truncation_is_reported(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path)
    for number in range(2):
        writer.write(T0_NS + number, KEY, bytes([number]), urgent=True)
    [path] = segment_paths(tmp_path)
    with SegmentReader(path) as reader:
        place = reader._contents.chunks[0].offset + 60
    content = bytearray(path.read_bytes())
    content[place] ^= 1
    path.write_bytes(content)
    [recovery] = recover_log(tmp_path)
    assert "is lost" in str(recovery)
    assert "whole" not in str(recovery)


def test_a_log_that_is_person_elses_is_not_called_torn(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refused(_: Path) -> NoReturn:
        raise PermissionError(errno.EACCES, "Permission denied")

    monkeypatch.setattr(Path, "iterdir", refused)
    with pytest.raises(LogError, match="run this as the user to whom it belongs"):
        recover_log(tmp_path)


@pytest.mark.parametrize("lost_bytes", [0, 1, 31])  # 31: all that is said of the last key
def test_a_chunk_whose_index_is_torn_off_is_found_under_every_key(
    tmp_path: Path, lost_bytes: int
) -> None:
    keys = [TEMPERATURE.key(unit_id) for unit_id in ("anna", "bert", "carl")]
    writer = SegmentWriter(tmp_path)
    for key in keys:
        writer.write(T0_NS, key, b"said")
    writer.flush()
    [path] = segment_paths(tmp_path)
    path.write_bytes(path.read_bytes()[: path.stat().st_size - lost_bytes])
    assert recover_log(tmp_path)
    for key in keys:
        assert [record[1] for record in read_log(tmp_path, keys={key})] == [key]
    with path.open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    (chunk,) = summary.chunk_indexes
    named = [summary.channels[number].topic for number in chunk.message_index_offsets]
    assert named == keys, "other readers go by it"


def test_an_index_in_which_a_bit_flipped_before_the_tear_is_made_again(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path)
    writer.write(T0_NS, KEY, b"said")
    writer.flush()
    [path] = segment_paths(tmp_path)
    whole = path.read_bytes()
    path.write_bytes(whole[:-1] + bytes([whole[-1] ^ 1]))
    assert recover_log(tmp_path)
    assert [message.data for _, _, message in as_others_read(path)] == [b"said"]
    with SegmentReader(path) as reader:
        assert [payload for _, _, payload in reader.records(keys={KEY})] == [b"said"]
        assert reader.damage == []
