"""Makes a complete MCAP file of the intact chunks of another, without taking them apart."""

from __future__ import annotations

import struct
import zlib
from collections import Counter
from pathlib import Path

from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import (
    Channel,
    ChunkIndex,
    DataEnd,
    Footer,
    Header,
    McapRecord,
    Statistics,
)
from mcap.writer import LIBRARY_IDENTIFIER, MCAP0_MAGIC

from shared.mcap_log.container import NONSENSE, RECORD, records_in
from shared.mcap_log.durable_file import DurableFile
from shared.mcap_log.reading import IntactChunk
from shared.mcap_log.writing import PROFILE

_SIZE = struct.Struct("<Q")
_NUMBER = struct.Struct("<H")


class RebuiltSegment:
    """``add`` chunks in their order, then ``finish``."""

    def __init__(self, path: Path) -> None:
        self.file = DurableFile(path)
        self._schemas: dict[int, bytes] = {}  # records as they are, by number
        self._topics: dict[int, bytes] = {}
        self._counts: Counter[int] = Counter()
        self._chunks: list[ChunkIndex] = []
        self.file.write(MCAP0_MAGIC)
        self.file.write(_bytes_of(Header(PROFILE, LIBRARY_IDENTIFIER)))

    def add(self, chunk: IntactChunk) -> None:
        counts = self._learn(chunk.data)
        self._counts.update(counts)
        offset = self.file.tell()
        self.file.write(chunk.record)
        index_offsets = _index_offsets(chunk.index, self.file.tell())
        if index_offsets.keys() == counts.keys():
            self.file.write(chunk.index)
        else:  # it was torn or is damaged: the chunk is read without
            index_offsets = {}
        (name_length,) = struct.unpack_from("<I", chunk.record, 9 + 28)
        name_end = 9 + 32 + name_length
        self._chunks.append(
            ChunkIndex(
                chunk_length=len(chunk.record),
                chunk_start_offset=offset,
                compression=chunk.record[9 + 32 : name_end].decode("ascii"),
                compressed_size=_SIZE.unpack_from(chunk.record, name_end)[0],
                message_end_time=chunk.end_ns,
                message_index_length=len(chunk.index) if index_offsets else 0,
                message_index_offsets=index_offsets,
                message_start_time=chunk.start_ns,
                uncompressed_size=len(chunk.data),
            )
        )

    def finish(self) -> None:
        """Write what makes the file complete."""
        for number in self._counts.keys() - self._topics.keys():
            # The chunk that told its key is lost.
            self._topics[number] = _bytes_of(Channel(number, f"unknown/{number}", "", {}, 0))
        self.file.write(_bytes_of(DataEnd(0)))
        start = self.file.tell()
        summary = b"".join((*self._schemas.values(), *self._topics.values()))
        summary += b"".join(_bytes_of(record) for record in (self._statistics(), *self._chunks))
        checked = summary + RECORD.pack(Opcode.FOOTER, 20) + struct.pack("<QQ", start, 0)
        self.file.write(summary)
        self.file.write(_bytes_of(Footer(start, 0, zlib.crc32(checked))))
        self.file.write(MCAP0_MAGIC)

    def _learn(self, data: bytes) -> Counter[int]:
        """Messages of each topic; schemas and topics are kept on the way."""
        counts: Counter[int] = Counter()
        for opcode, body in records_in(data):
            (number,) = _NUMBER.unpack_from(body)
            if opcode == Opcode.MESSAGE:
                counts[number] += 1
            elif opcode == Opcode.CHANNEL:
                self._topics[number] = RECORD.pack(opcode, len(body)) + body
            elif opcode == Opcode.SCHEMA:
                self._schemas[number] = RECORD.pack(opcode, len(body)) + body
        return counts

    def _statistics(self) -> Statistics:
        return Statistics(
            attachment_count=0,
            channel_count=len(self._topics),
            channel_message_counts=dict(self._counts),
            chunk_count=len(self._chunks),
            message_count=sum(self._counts.values()),
            message_end_time=max((chunk.message_end_time for chunk in self._chunks), default=0),
            message_start_time=min((chunk.message_start_time for chunk in self._chunks), default=0),
            metadata_count=0,
            schema_count=len(self._schemas),
        )


def _index_offsets(index: bytes, begin: int) -> dict[int, int]:
    """Where the index of each topic will stand; nothing where it makes no sense."""
    offsets: dict[int, int] = {}
    at = 0
    try:
        while at < len(index):
            _, length = RECORD.unpack_from(index, at)
            offsets[_NUMBER.unpack_from(index, at + 9)[0]] = begin + at
            at += 9 + length
    except NONSENSE:
        return {}
    return offsets


def _bytes_of(record: McapRecord) -> bytes:
    builder = RecordBuilder()
    record.write(builder)
    return bytes(builder.end())  # type: ignore[no-untyped-call]
