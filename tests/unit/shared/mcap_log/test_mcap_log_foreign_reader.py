"""The log in another reader of MCAP: keys, schemas, times, and topics of its own."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

import pytest
from google.protobuf.descriptor_pb2 import FileDescriptorSet
from mcap.data_stream import ReadDataStream
from mcap.reader import make_reader
from mcap.records import Chunk

from shared.channels import STATUS
from shared.clock import ManualClock
from shared.codec import encode
from shared.header_factory import HeaderFactory
from shared.mcap_log import (
    SegmentReader,
    SegmentWriter,
    location_topic,
    segment_paths,
)
from shared.messages import Header, Temperature
from tests.rig.small_log import KEY, T0_NS, as_others_read, on_disk


def temperature(header: Header) -> bytes:
    return encode(Temperature(header, 21.5))


def test_any_reader_of_mcap_sees_key_schema_times_and_sequence(tmp_path: Path) -> None:
    header_factory = HeaderFactory("anna", 77, ManualClock(utc_ns=T0_NS))
    payload = temperature(header_factory.header())
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


def test_the_index_of_a_file_says_of_its_chunks_what_they_say_themselves(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path)
    for number in range(3):
        writer.write(T0_NS + number, KEY, bytes(100 * number))
        writer.write(T0_NS + number, STATUS.key("bert"), b"said", urgent=True)
    writer.close()
    [path] = segment_paths(tmp_path)
    with path.open("rb") as file:
        summary = make_reader(file).get_summary()
        assert summary is not None
        assert len(summary.chunk_indexes) == 3
        for index in summary.chunk_indexes:
            file.seek(index.chunk_start_offset + 9)
            chunk = Chunk.read(ReadDataStream(BytesIO(file.read(index.chunk_length - 9))))
            assert (index.message_start_time, index.message_end_time, index.compression) == (
                chunk.message_start_time, chunk.message_end_time, chunk.compression,
            )  # fmt: skip
            assert (index.compressed_size, index.uncompressed_size) == (
                len(chunk.data), chunk.uncompressed_size,
            )  # fmt: skip
            behind = index.chunk_start_offset + index.chunk_length
            places = sorted(index.message_index_offsets.values())
            assert places[0] == behind
            assert behind < places[1] < behind + index.message_index_length
        statistics = summary.statistics
        assert statistics is not None
        assert (statistics.message_start_time, statistics.message_end_time) == (T0_NS, T0_NS + 2)
        assert sorted(statistics.channel_message_counts.values()) == [3, 3]
        assert (statistics.attachment_count, statistics.metadata_count) == (0, 1)
