"""Writing the log: segments, flushing, schemas, and what any other reader of MCAP sees."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest
from google.protobuf.descriptor_pb2 import FileDescriptorSet
from mcap.reader import make_reader

from shared.channels import STATUS, TEMPERATURE
from shared.clock import NS_PER_S, ManualClock
from shared.codec import encode
from shared.envelope import Stamper
from shared.errors import LogError
from shared.mcap_log import (
    SegmentInfo,
    SegmentPolicy,
    SegmentReader,
    SegmentState,
    SegmentWriter,
    location_topic,
    read_log,
    recover_log,
    rewrite_segment,
    segment_paths,
)
from shared.mcap_log.durable_file import DurableFile
from shared.mcap_log.segment_file import SegmentFile
from shared.messages import Header, Temperature

T0_NS = 1_700_000_000 * NS_PER_S
KEY = TEMPERATURE.key("anna")


def temperature(header: Header) -> bytes:
    return encode(Temperature(header, 21.5))


def on_disk(folder: Path) -> list[bytes]:
    return [payload for _, _, payload in read_log(folder)]


def as_others_read(path: Path) -> list[tuple[Any, Any, Any]]:
    with path.open("rb") as file:
        return list(make_reader(file, validate_crcs=True).iter_messages(log_time_order=False))


def test_a_record_is_on_the_disk_half_a_second_of_log_time_later(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path)
    writer.write(T0_NS, KEY, b"1")
    writer.write(T0_NS + 400_000_000, KEY, b"2")
    assert on_disk(tmp_path) == []
    writer.advance(T0_NS + 499_999_999)
    assert on_disk(tmp_path) == []
    writer.advance(T0_NS + 500_000_000)
    assert on_disk(tmp_path) == [b"1", b"2"]


def test_what_is_ended_is_let_go_of_and_nobody_elses_to_read(tmp_path: Path) -> None:
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


def test_segments_end_by_time_and_are_told_of(tmp_path: Path) -> None:
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


def test_what_comes_at_once_is_cut_into_chunks(tmp_path: Path) -> None:
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


def test_any_reader_of_mcap_sees_key_schema_times_and_sequence(tmp_path: Path) -> None:
    stamper = Stamper("anna", 77, ManualClock(utc_ns=T0_NS))
    payload = temperature(stamper.header())
    writer = SegmentWriter(tmp_path)
    writer.write(T0_NS + 5, KEY, payload)
    writer.close()
    [(schema, channel, message)] = as_others_read(segment_paths(tmp_path)[0])
    assert (channel.topic, channel.message_encoding) == (KEY, "protobuf")
    assert (schema.name, schema.encoding) == ("muster.v1.Temperature", "protobuf")
    described = FileDescriptorSet.FromString(schema.data)
    assert {file.package for file in described.file} == {"muster.v1"}
    assert len(described.file) >= 2  # the header's file comes along
    assert message.data == payload
    assert (message.log_time, message.publish_time, message.sequence) == (T0_NS + 5, T0_NS, 1)


@pytest.mark.parametrize("payload", [b"", b"\n", b"\x0a\xff", b"\x0a\x05xxxxx", b"no message"])
def test_bytes_that_are_no_message_are_kept_as_they_came(tmp_path: Path, payload: bytes) -> None:
    writer = SegmentWriter(tmp_path)
    writer.write(T0_NS, STATUS.key("anna"), payload)
    writer.write(T0_NS, "muster/v1/anna/up/unheard_of", payload)
    writer.close()
    assert on_disk(tmp_path) == [payload, payload]
    [known, unknown] = as_others_read(segment_paths(tmp_path)[0])
    assert known[2].publish_time == T0_NS
    assert unknown[0] is None


def test_topics_made_for_foxglove_are_there_for_others_only(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path)
    writer.write(T0_NS, KEY, b"ours")
    writer.write(T0_NS, location_topic("anna"), b"")
    info = writer.current()
    assert info is not None
    assert info.messages == 1
    writer.close()
    assert on_disk(tmp_path) == [b"ours"]
    [path] = segment_paths(tmp_path)
    assert [schema.name for schema, _, _ in as_others_read(path)] == [
        "muster.v1.Temperature",
        "foxglove.LocationFix",
    ]
    with SegmentReader(path) as reader:
        assert reader.info().messages == 1
        assert len(list(reader.records(derived=True))) == 2


def test_what_is_being_written_can_be_read_up_to_the_last_flush(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path)
    writer.write(T0_NS, KEY, b"1", urgent=True)
    writer.write(T0_NS + 1, KEY, b"2")
    with SegmentReader(segment_paths(tmp_path)[0]) as reader:
        assert list(reader.records()) == [(T0_NS, KEY, b"1")]
        assert reader.info().state is SegmentState.TORN
        assert reader.damage == []


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


def test_of_a_segment_that_is_torn_again_and_again_every_original_is_kept(tmp_path: Path) -> None:
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


@pytest.mark.parametrize(("torn_off", "said"), [(b"", "kept, whole"), (b"torn", "kept, 4 bytes")])
def test_what_a_tear_cost_is_said(tmp_path: Path, torn_off: bytes, said: str) -> None:
    writer = SegmentWriter(tmp_path)
    writer.write(T0_NS, KEY, b"1", urgent=True)
    [path] = segment_paths(tmp_path)
    with path.open("ab") as file:
        file.write(torn_off)
    [recovery] = recover_log(tmp_path)
    assert said in str(recovery)
    assert recover_log(tmp_path) == []


def test_what_was_damaged_before_the_tear_is_not_called_whole(tmp_path: Path) -> None:
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


def test_a_folder_that_cannot_be_made_is_said_in_words(tmp_path: Path) -> None:
    (tmp_path / "log").write_text("a file")
    with pytest.raises(LogError, match="cannot be used"):
        SegmentWriter(tmp_path / "log")


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


def test_of_a_segment_from_which_all_is_taken_an_empty_one_is_left(tmp_path: Path) -> None:
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


def test_who_reads_a_segment_while_it_is_written_anew_has_it_as_it_was(tmp_path: Path) -> None:
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


def test_files_that_are_no_segments_are_left_alone(tmp_path: Path) -> None:
    for name in ("notes.txt", "recording.mcap", "000001-sometime.mcap"):
        (tmp_path / name).write_bytes(b"mine")
    writer = SegmentWriter(tmp_path)
    writer.write(T0_NS, KEY, b"1")
    writer.close()
    assert recover_log(tmp_path) == []
    assert on_disk(tmp_path) == [b"1"]
    assert (tmp_path / "recording.mcap").read_bytes() == b"mine"


def test_a_damaged_length_takes_no_memory_for_what_is_not_there(tmp_path: Path) -> None:
    path = tmp_path / "short"
    path.write_bytes(b"123")
    file = SegmentFile(path)
    assert file.read(1, 2) == b"23"
    with pytest.raises(ValueError, match="ends before"):
        file.read(0, 1 << 60)
    file.close()


def test_what_a_disk_takes_and_then_drops_is_written_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A system drops what it could not bring to the disk, and says so once."""
    writer = SegmentWriter(tmp_path)
    writer.write(T0_NS, KEY, b"1", urgent=True)
    [path] = segment_paths(tmp_path)
    safe_bytes = path.stat().st_size

    def drop(descriptor: int) -> None:
        os.ftruncate(descriptor, safe_bytes)
        raise OSError(5, "Input/output error")

    with monkeypatch.context() as failing:
        failing.setattr("shared.mcap_log.durable_file.os.fsync", drop)
        writer.write(T0_NS + 1, KEY, b"mayday", urgent=True)
        assert "Input/output error" in writer.problem
        assert writer.waiting_bytes > 0
        writer.write(T0_NS + 2, KEY, b"3", urgent=True)
    writer.write(T0_NS + 3, KEY, b"4", urgent=True)
    assert writer.problem == ""
    assert writer.waiting_bytes == 0
    writer.close()
    assert [message.data for *_, message in as_others_read(path)] == [b"1", b"mayday", b"3", b"4"]


def test_what_is_written_in_parts_and_then_dropped_is_written_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = DurableFile(tmp_path / "file")
    write, fsync = os.pwrite, os.fsync
    full = OSError(28, "No space left on device")
    troubles = [None, full, full]  # the first write is cut short, the next two are refused

    def write_some(descriptor: int, data: bytes, offset: int) -> int:
        if troubles:
            trouble = troubles.pop(0)
            if trouble is not None:
                raise trouble
            data = data[:3]
        return write(descriptor, data, offset)

    def drop(descriptor: int) -> None:
        os.ftruncate(descriptor, 0)
        raise full

    monkeypatch.setattr(os, "pwrite", write_some)
    file.write(b"first ")
    file.write(b"second ")
    for _ in range(2):
        with pytest.raises(OSError, match="No space"):
            file.sync()
        file.write(b"more ")
    monkeypatch.setattr(os, "fsync", drop)
    with pytest.raises(OSError, match="No space"):
        file.sync()
    monkeypatch.setattr(os, "fsync", fsync)
    file.sync()
    assert file.path.read_bytes() == b"first second more more "
    assert (file.tell(), file.waiting_bytes) == (23, 0)
    file.close()


def test_a_name_that_did_not_reach_the_disk_is_brought_there_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = DurableFile(tmp_path / "file")
    file.write(b"something")
    fsync, synced = os.fsync, []

    def fail_once(descriptor: int) -> None:
        synced.append(Path(f"/proc/self/fd/{descriptor}").readlink())
        if len(synced) == 1:
            raise OSError(5, "Input/output error")
        fsync(descriptor)

    monkeypatch.setattr(os, "fsync", fail_once)
    with pytest.raises(OSError, match="Input/output"):
        file.sync()
    file.sync()
    assert synced == [tmp_path, tmp_path, file.path]
    file.close()
