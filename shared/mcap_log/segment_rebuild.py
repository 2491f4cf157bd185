"""Makes a complete MCAP file of the intact chunks of another."""

from __future__ import annotations

import struct
from pathlib import Path

import zstandard
from mcap.opcode import Opcode
from mcap.records import Channel

from shared.mcap_log.chunk_writer import McapFile, bytes_of, compressed_chunk, pack_chunk
from shared.mcap_log.container import MESSAGE, RECORD
from shared.mcap_log.durable_file import DurableFile
from shared.mcap_log.identity import SegmentIdentity
from shared.mcap_log.reading import IntactChunk

_NUMBER = struct.Struct("<H")
_TIMES = struct.Struct("<QQ")  # of the first and the last message, as a chunk begins


class RebuiltSegment:
    """``add`` chunks in their order, then ``finish``."""

    def __init__(self, path: Path, identity: SegmentIdentity) -> None:
        self._mcap = McapFile(path, identity)

    @property
    def file(self) -> DurableFile:
        return self._mcap.file

    def add(self, chunk: IntactChunk) -> None:
        """Its index is made again: the one behind it may be torn, and has no checksum."""
        entries, start_ns, end_ns = self._learn(chunk.data)
        # What it says of its times is outside its checksum, and readers go by it.
        head = chunk.record[: RECORD.size] + _TIMES.pack(start_ns, end_ns)
        record = head + chunk.record[len(head) :]
        self._mcap.add(pack_chunk(record, start_ns, end_ns, len(chunk.data), entries))

    def add_records(self, data: bytes, compressor: zstandard.ZstdCompressor) -> None:
        """A chunk of schema, channel and message records, in the order of the file."""
        entries, start_ns, end_ns = self._learn(data)
        self._mcap.add(compressed_chunk(data, start_ns, end_ns, entries, compressor))

    def finish(self) -> None:
        """Write what makes the file complete."""
        for number in self._mcap.counts.keys() - self._mcap.topics.keys():
            # The chunk with the record of its topic is lost.
            self._mcap.topics[number] = bytes_of(Channel(number, f"unknown/{number}", "", {}, 0))
        self._mcap.finish()

    def _learn(self, data: bytes) -> tuple[dict[int, list[int]], int, int]:
        """Time and place of each message, by topic, the earliest and the latest of the times;
        schemas and topics are kept on the way.
        """
        entries: dict[int, list[int]] = {}
        at = 0
        while at < len(data):
            opcode, length = RECORD.unpack_from(data, at)
            end = at + RECORD.size + length
            if opcode == Opcode.MESSAGE:
                _, _, topic, _, t_ns = MESSAGE.unpack_from(data, at)
                entries.setdefault(topic, []).extend((t_ns, at))
            elif opcode in (Opcode.CHANNEL, Opcode.SCHEMA):
                kept = self._mcap.topics if opcode == Opcode.CHANNEL else self._mcap.schemas
                kept[_NUMBER.unpack_from(data, at + RECORD.size)[0]] = data[at:end]
            at = end
        times_ns = [t_ns for of_topic in entries.values() for t_ns in of_topic[::2]]
        return entries, min(times_ns, default=0), max(times_ns, default=0)
