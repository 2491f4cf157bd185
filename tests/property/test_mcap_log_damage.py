"""A log that is torn or damaged at any place yields all other records and states what is
missing.
"""

from __future__ import annotations

import os
import random
import struct
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mcap.opcode import Opcode
from mcap.reader import make_reader

from shared.channels import CHANNELS
from shared.mcap_log import (
    LogRecord,
    SegmentPolicy,
    SegmentReader,
    SegmentState,
    SegmentWriter,
    read_log,
    recover_log,
    segment_paths,
)
from shared.mcap_log.schemas import location_topic

MANY = settings(max_examples=60)
FIXTURES = [HealthCheck.function_scoped_fixture]
T0_NS = 1_700_000_000_000_000_000
POLICY = SegmentPolicy(chunk_bytes=2048)


def records() -> list[LogRecord]:
    """Payloads of random bytes, over known and unknown keys."""
    chance = random.Random(7)
    keys = [channel.key(unit) for channel in CHANNELS for unit in ("anna", "ben")]
    keys += ["muster/v1/anna/up/unheard_of", "elsewhere"]
    return [
        (T0_NS + number * 1_000_000, chance.choice(keys), chance.randbytes(chance.randrange(90)))
        for number in range(400)
    ]


RECORDS = records()


def write_log(folder: Path, *, close: bool) -> Path:
    writer = SegmentWriter(folder, POLICY)
    for index, record in enumerate(RECORDS):
        writer.write(*record)
        if index % 50 == 0:
            writer.write(record[0], location_topic("anna"), b"derived")
            writer.flush()
    if close:
        writer.close()
    else:
        writer.flush()
    return segment_paths(folder)[0]


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_log(tmp_path_factory.mktemp("whole"), close=True)


@pytest.fixture(scope="module")
def unfinished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_log(tmp_path_factory.mktemp("unfinished"), close=False)


def log_of(folder: Path, content: bytes) -> Path:
    for old in folder.iterdir():
        old.unlink()
    (folder / "000001-20231114T221320Z.mcap").write_bytes(content)
    return folder


def as_others_read(path: Path) -> list[LogRecord]:
    with path.open("rb") as file:
        return [
            (message.log_time, channel.topic, message.data)
            for _, channel, message in make_reader(file, validate_crcs=True).iter_messages()
            if not channel.topic.startswith("foxglove/")
        ]


def assert_in_order_of(found: list[LogRecord], written: list[LogRecord]) -> None:
    """Assert that every record found was written, in that order, none twice."""
    rest = iter(written)
    assert all(record in rest for record in found)


@settings(MANY, suppress_health_check=FIXTURES)
@given(cut=st.floats(0.0, 1.0))
def test_log_torn_anywhere_is_read_and_repaired_up_to_the_tear(
    tmp_path: Path, whole: Path, cut: float
) -> None:
    content = whole.read_bytes()
    size = round(cut * len(content))
    folder = log_of(tmp_path, content[:size])
    found = list(read_log(folder))
    assert found == RECORDS[: len(found)]

    recoveries = recover_log(folder)
    assert len(recoveries) == (0 if size == len(content) else 1)
    damage: list[str] = []
    assert list(read_log(folder, on_damage=damage.append)) == found
    assert damage == []
    with SegmentReader(segment_paths(folder)[0]) as mended:
        assert mended.state is SegmentState.CLOSED
        assert mended.info().messages == len(found)
    key = RECORDS[0][1]
    assert list(read_log(folder, keys={key})) == [record for record in found if record[1] == key]
    assert as_others_read(segment_paths(folder)[0]) == found
    for recovery in recoveries:
        assert recovery.messages == len(found)
        assert recovery.torn_path.read_bytes() == content[:size]
    assert recover_log(folder) == []


@settings(MANY, suppress_health_check=FIXTURES)
@given(cut=st.floats(0.0, 1.0))
def test_records_flushed_before_a_tear_are_read(
    tmp_path: Path, unfinished: Path, cut: float
) -> None:
    folder = log_of(tmp_path, unfinished.read_bytes() + b"\0" * round(cut * 5000))
    assert list(read_log(folder)) == RECORDS
    assert recover_log(folder)[0].bytes_lost == round(cut * 5000)


@pytest.mark.slow
@settings(MANY, suppress_health_check=FIXTURES)
@given(at=st.floats(0.0, 1.0, exclude_max=True), bit=st.integers(0, 7), end=st.booleans())
def test_a_flipped_bit_costs_one_chunk_at_most_and_is_reported(
    tmp_path: Path, whole: Path, unfinished: Path, at: float, bit: int, end: bool
) -> None:
    content = bytearray((whole if end else unfinished).read_bytes())
    content[int(at * len(content))] ^= 1 << bit
    folder = log_of(tmp_path, bytes(content))
    damage: list[str] = []
    found = list(read_log(folder, on_damage=damage.append))
    assert_in_order_of(found, RECORDS)
    assert found == RECORDS or damage or not end
    if not end:
        recover_log(folder)
        mended = [r for r in read_log(folder) if not r[1].startswith("unknown/")]
        assert mended == found
    assert len(found) > 0.7 * len(RECORDS) or not end
    for key in {one[1] for one in RECORDS}:
        assert list(read_log(folder, keys={key})) == [r for r in found if r[1] == key]


def test_flipped_bit_of_an_index_hides_no_record(tmp_path: Path, whole: Path) -> None:
    """An index has no checksum, and states its length twice."""
    content = whole.read_bytes()
    at = min(
        content.index(bytes([Opcode.MESSAGE_INDEX]) + struct.pack("<Q", 6 + 16 * entries))
        for entries in range(2, 4)
    )
    (topic,) = struct.unpack_from("<H", content, at + 9)
    with SegmentReader(whole) as reader:
        key = reader._contents.topics[topic]
    expected = [record for record in RECORDS if record[1] == key]
    for bit in range(8 * (9 + 6 + 32)):
        flipped = bytearray(content)
        flipped[at + bit // 8] ^= 1 << bit % 8
        assert list(read_log(log_of(tmp_path, bytes(flipped)), keys={key})) == expected


@settings(MANY, suppress_health_check=FIXTURES)
@given(content=st.binary(max_size=300), magic=st.booleans())
def test_bytes_of_no_log_yield_nothing(tmp_path: Path, content: bytes, magic: bool) -> None:
    folder = log_of(tmp_path, (b"\x89MCAP0\r\n" if magic else b"") + content)
    assert list(read_log(folder)) == []
    recover_log(folder)
    assert list(read_log(folder)) == []


@settings(MANY, suppress_health_check=FIXTURES)
@given(st.data())
def test_a_window_and_keys_select_what_a_filter_selects(
    tmp_path: Path, data: st.DataObject
) -> None:
    end = data.draw(st.booleans())
    if not any(tmp_path.iterdir()):
        write_log(tmp_path / "whole", close=True)
        write_log(tmp_path / "unfinished", close=False)
    folder = tmp_path / ("whole" if end else "unfinished")
    times = st.none() | st.integers(-5, 405).map(lambda number: T0_NS + number * 1_000_000)
    start_ns, end_ns = data.draw(times), data.draw(times)
    keys = data.draw(st.none() | st.sets(st.sampled_from(sorted({r[1] for r in RECORDS}))))
    expected = [
        record
        for record in RECORDS
        if (start_ns is None or record[0] >= start_ns)
        and (end_ns is None or record[0] < end_ns)
        and (keys is None or record[1] in keys)
    ]
    damage: list[str] = []
    assert list(read_log(folder, start_ns, end_ns, keys, damage.append)) == expected
    assert damage == []  # its indexes are read as they stand


PAGE = 4096  # a disk reads so many bytes or none


@pytest.mark.parametrize("end", [False, True])
def test_unreadable_part_of_a_disk_costs_its_records_and_is_reported(
    tmp_path: Path, whole: Path, unfinished: Path, monkeypatch: pytest.MonkeyPatch, end: bool
) -> None:
    content = (whole if end else unfinished).read_bytes()
    pread = os.pread
    bad = 0

    def fail_at_one(descriptor: int, count: int, offset: int) -> bytes:
        if offset < bad + PAGE and bad < offset + count:
            raise OSError(5, "Input/output error")
        return pread(descriptor, count, offset)

    for bad in range(0, len(content), PAGE):
        folder = log_of(tmp_path, content)
        damage: list[str] = []
        with monkeypatch.context() as failing:
            failing.setattr(os, "pread", fail_at_one)
            found = list(read_log(folder, on_damage=damage.append))
            recover_log(folder)
        assert_in_order_of(found, RECORDS)
        tells_keys = not end and bad < len(content) // 2
        assert len(found) > 0.7 * len(RECORDS) or tells_keys
        assert found == RECORDS or damage
        mended = [record for record in read_log(folder) if not record[1].startswith("unknown/")]
        assert mended in (found, RECORDS)
