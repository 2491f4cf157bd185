"""An MCAP file in the making: chunks one after the other, and what makes the file complete.

The library's writer packs every field of every message by itself, which is most of what a log
costs, and its index of a file of many topics takes a hundred bytes of memory a topic and chunk;
the records that come once a file are still the library's.
"""

from __future__ import annotations

import struct
import zlib
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import zstandard
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import (
    Attachment,
    AttachmentIndex,
    DataEnd,
    Footer,
    Header,
    McapRecord,
    Metadata,
    MetadataIndex,
    Statistics,
)
from mcap.writer import LIBRARY_IDENTIFIER, MCAP0_MAGIC

from shared.errors import LogError
from shared.mcap_log.container import (
    CHUNK,
    CHUNK_INDEX,
    CHUNK_MARK,
    COMPRESSION,
    MESSAGE,
    MESSAGE_BYTES,
    RECORD,
)
from shared.mcap_log.durable_file import DurableFile
from shared.mcap_log.identity import PROFILE, SegmentIdentity

_MESSAGE = struct.Struct(MESSAGE.format + "Q")  # and its publish time
_INDEX = struct.Struct("<BQHI")  # opcode, length, topic, bytes of entries
_SIZE = struct.Struct("<Q")
_INDEX_OF_TOPIC = np.dtype([("topic", "<u2"), ("offset", "<u8")])
_CRC_BYTES = 4
_PART_BYTES = 1 << 20  # of a file that is attached
_LEVEL = 1  # of Zstandard: packs positions as small as the usual 3, and sooner


@dataclass(frozen=True, slots=True)
class PackedChunk:
    """A chunk as it will stand in the file."""

    record: bytes  # with opcode and length
    start_ns: int
    end_ns: int
    size: int  # of what is in it
    index: bytes  # the message index records that go behind it
    index_offsets: Mapping[int, int]  # in ``index``, by topic
    counts: Mapping[int, int]  # messages, by topic


def pack_chunk(
    record: bytes, start_ns: int, end_ns: int, size: int, entries: Mapping[int, Sequence[int]]
) -> PackedChunk:
    """``entries``: by topic, time and place of each message in the chunk's data."""
    offsets: dict[int, int] = {}
    index = bytearray()
    for topic, of_topic in entries.items():
        offsets[topic] = len(index)
        entries_bytes = 8 * len(of_topic)
        index += _INDEX.pack(Opcode.MESSAGE_INDEX, 6 + entries_bytes, topic, entries_bytes)
        index += struct.pack(f"<{len(of_topic)}Q", *of_topic)
    counts = {topic: len(of_topic) // 2 for topic, of_topic in entries.items()}
    return PackedChunk(record, start_ns, end_ns, size, bytes(index), offsets, counts)


def compressed_chunk(
    data: bytes,
    start_ns: int,
    end_ns: int,
    entries: Mapping[int, Sequence[int]],
    compressor: zstandard.ZstdCompressor,
) -> PackedChunk:
    """A chunk of these records; ``entries`` as for ``pack_chunk``."""
    packed = compressor.compress(data)
    head = CHUNK.pack(start_ns, end_ns, len(data), zlib.crc32(data), len(COMPRESSION))
    body = b"".join((head, COMPRESSION, _SIZE.pack(len(packed)), packed))
    record = RECORD.pack(Opcode.CHUNK, len(body)) + body
    return pack_chunk(record, start_ns, end_ns, len(data), entries)


class ChunkWriter:
    """Schemas, topics and messages of one chunk after the other."""

    def __init__(self) -> None:
        self._compressor = zstandard.ZstdCompressor(_LEVEL)
        self._parts: list[bytes] = []
        self._entries: dict[int, list[int]] = {}  # by topic: time and place of each message
        self._start_ns = self._end_ns = 0
        self.size = 0

    def add_record(self, record: bytes) -> None:
        """A schema or a topic, with opcode and length."""
        self._parts.append(record)
        self.size += len(record)

    def add_message(
        self, topic: int, t_ns: int, payload: bytes, publish_ns: int, sequence: int
    ) -> None:
        entries = self._entries.get(topic)
        if entries is None:
            if not self._entries:
                self._start_ns = self._end_ns = t_ns
            entries = self._entries[topic] = []
        entries.append(t_ns)
        entries.append(self.size)
        if t_ns > self._end_ns:
            self._end_ns = t_ns
        elif t_ns < self._start_ns:
            self._start_ns = t_ns
        length = MESSAGE_BYTES - 9 + len(payload)
        self._parts.append(_MESSAGE.pack(Opcode.MESSAGE, length, topic, sequence, t_ns, publish_ns))
        self._parts.append(payload)
        self.size += 9 + length

    def take(self) -> PackedChunk | None:
        """Chunk of the records since the last one; None where there was no message."""
        if not self._entries:
            return None
        made = compressed_chunk(
            b"".join(self._parts), self._start_ns, self._end_ns, self._entries, self._compressor
        )
        self._parts.clear()
        self._entries.clear()
        self.size = 0
        return made


class McapFile:
    """``add`` chunks in their order, then ``finish``."""

    def __init__(self, path: Path, identity: SegmentIdentity) -> None:
        self.file = DurableFile(path)
        self.schemas: dict[int, bytes] = {}  # records with opcode and length, by number
        self.topics: dict[int, bytes] = {}
        self.counts: Counter[int] = Counter()  # messages, by topic
        self._chunks: list[bytes] = []  # their records in the file's index
        self._start_ns: int | None = None
        self._end_ns = 0
        self.file.write(MCAP0_MAGIC)
        self.file.write(bytes_of(Header(PROFILE, LIBRARY_IDENTIFIER)))
        self._metadata_indexes: list[bytes] = []
        self._attachment_indexes: list[bytes] = []
        if identity.log_id or identity.revision:  # none of a segment of an earlier version
            self.add_metadata(identity.metadata())

    def add(self, chunk: PackedChunk) -> None:
        offset = self.file.tell()
        self.file.write(chunk.record)
        index_begin = self.file.tell()
        self.file.write(chunk.index)
        self.counts.update(chunk.counts)
        self._chunks.append(_chunk_index(chunk, offset, index_begin))
        earliest_ns = chunk.start_ns if self._start_ns is None else self._start_ns
        self._start_ns = min(earliest_ns, chunk.start_ns)
        self._end_ns = max(self._end_ns, chunk.end_ns)

    def add_metadata(self, metadata: Metadata) -> None:
        """It stands between the chunks, and in the file's index."""
        offset, record = self.file.tell(), bytes_of(metadata)
        self.file.write(record)
        self._metadata_indexes.append(bytes_of(MetadataIndex(offset, len(record), metadata.name)))

    def add_attachment(self, attachment: Attachment) -> None:
        """A file of its own between the chunks, and in the index."""
        offset, record = self.file.tell(), bytes_of(attachment)
        self.file.write(record)
        index = AttachmentIndex(
            offset=offset,
            length=len(record),
            create_time=attachment.create_time,
            log_time=attachment.log_time,
            data_size=len(attachment.data),
            name=attachment.name,
            media_type=attachment.media_type,
        )
        self._attachment_indexes.append(bytes_of(index))

    def add_attachment_file(self, attachment: Attachment, path: Path) -> Iterator[None]:
        """The same with a file's content, in parts (MCAP specification, Attachment, op=0x09)."""
        offset, size = self.file.tell(), path.stat().st_size
        empty = bytes_of(attachment)[RECORD.size : -_CRC_BYTES - _SIZE.size]
        head = empty + _SIZE.pack(size)
        length = len(head) + size + _CRC_BYTES
        self.file.write(RECORD.pack(Opcode.ATTACHMENT, length) + head)
        crc, count = zlib.crc32(head), 0
        with path.open("rb") as content:
            while part := content.read(_PART_BYTES):
                crc, count = zlib.crc32(part, crc), count + len(part)
                self.file.write(part)
                yield
        if count != size:
            raise LogError(f"{path} was changed while it was read; try again")
        self.file.write(struct.pack("<I", crc))
        index = AttachmentIndex(
            offset=offset,
            length=RECORD.size + length,
            create_time=attachment.create_time,
            log_time=attachment.log_time,
            data_size=size,
            name=attachment.name,
            media_type=attachment.media_type,
        )
        self._attachment_indexes.append(bytes_of(index))

    def finish(self) -> None:
        """Write what makes the file complete."""
        self.file.write(bytes_of(DataEnd(0)))
        start = self.file.tell()
        summary = b"".join((*self.schemas.values(), *self.topics.values()))
        indexes = (*self._attachment_indexes, *self._metadata_indexes)
        summary += b"".join((bytes_of(self._statistics()), *self._chunks, *indexes))
        checked = summary + RECORD.pack(Opcode.FOOTER, 20) + struct.pack("<QQ", start, 0)
        self.file.write(summary)
        self.file.write(bytes_of(Footer(start, 0, zlib.crc32(checked))))
        self.file.write(MCAP0_MAGIC)

    def _statistics(self) -> Statistics:
        return Statistics(
            attachment_count=len(self._attachment_indexes),
            channel_count=len(self.topics),
            channel_message_counts=dict(self.counts),
            chunk_count=len(self._chunks),
            message_count=sum(self.counts.values()),
            message_end_time=self._end_ns,
            message_start_time=self._start_ns or 0,
            metadata_count=len(self._metadata_indexes),
            schema_count=len(self.schemas),
        )


def _chunk_index(chunk: PackedChunk, offset: int, index_begin: int) -> bytes:
    """With opcode and length."""
    topics = chunk.index_offsets
    entries = np.fromiter(topics.items(), _INDEX_OF_TOPIC, len(topics))
    entries["offset"] += np.uint64(index_begin)
    packed_bytes = len(chunk.record) - RECORD.size - CHUNK.size - len(COMPRESSION) - _SIZE.size
    body = b"".join(
        (
            CHUNK_INDEX.pack(
                chunk.start_ns, chunk.end_ns, offset, len(chunk.record), entries.nbytes
            ),
            entries.tobytes(),
            _SIZE.pack(len(chunk.index)),
            CHUNK_MARK,
            struct.pack("<QQ", packed_bytes, chunk.size),
        )
    )
    return RECORD.pack(Opcode.CHUNK_INDEX, len(body)) + body


def bytes_of(record: McapRecord) -> bytes:
    """A record with opcode and length."""
    builder = RecordBuilder()
    record.write(builder)
    return bytes(builder.end())  # type: ignore[no-untyped-call]
