"""Makes a complete MCAP file of the intact chunks of another, without taking them apart."""

from __future__ import annotations

import struct
from collections import Counter
from pathlib import Path

from mcap.opcode import Opcode
from mcap.records import Channel

from shared.mcap_log.container import NONSENSE, RECORD, records_in
from shared.mcap_log.durable_file import DurableFile
from shared.mcap_log.making import MadeChunk, McapFile, bytes_of
from shared.mcap_log.reading import IntactChunk

_NUMBER = struct.Struct("<H")
_TIMES = struct.Struct("<QQ")  # of the first and the last message, as a chunk begins
_LOG_TIME = struct.Struct("<6xQ")  # of a message


class RebuiltSegment:
    """``add`` chunks in their order, then ``finish``."""

    def __init__(self, path: Path) -> None:
        self._mcap = McapFile(path)

    @property
    def file(self) -> DurableFile:
        return self._mcap.file

    def add(self, chunk: IntactChunk) -> None:
        counts, times_ns = self._learn(chunk.data)
        start_ns, end_ns = min(times_ns, default=0), max(times_ns, default=0)
        # What it says of its times is outside its checksum, and readers go by it.
        head = chunk.record[: RECORD.size] + _TIMES.pack(start_ns, end_ns)
        index, offsets = chunk.index, _index_offsets(chunk.index)
        if offsets.keys() != counts.keys():  # torn or damaged: the chunk is read without
            index, offsets = b"", {}
        self._mcap.add(
            MadeChunk(
                head + chunk.record[len(head) :],
                start_ns,
                end_ns,
                len(chunk.data),
                index,
                offsets,
                counts,
            )
        )

    def finish(self) -> None:
        """Write what makes the file complete."""
        for number in self._mcap.counts.keys() - self._mcap.topics.keys():
            # The chunk that told its key is lost.
            self._mcap.topics[number] = bytes_of(Channel(number, f"unknown/{number}", "", {}, 0))
        self._mcap.finish()

    def _learn(self, data: bytes) -> tuple[Counter[int], list[int]]:
        """Messages of each topic, and when they came; schemas and topics are kept on the way."""
        counts: Counter[int] = Counter()
        times_ns: list[int] = []
        for opcode, body in records_in(data):
            (number,) = _NUMBER.unpack_from(body)
            if opcode == Opcode.MESSAGE:
                counts[number] += 1
                times_ns.append(_LOG_TIME.unpack_from(body)[0])
            elif opcode == Opcode.CHANNEL:
                self._mcap.topics[number] = RECORD.pack(opcode, len(body)) + body
            elif opcode == Opcode.SCHEMA:
                self._mcap.schemas[number] = RECORD.pack(opcode, len(body)) + body
        return counts, times_ns


def _index_offsets(index: bytes) -> dict[int, int]:
    """Where the index of each topic stands; nothing where it makes no sense."""
    offsets: dict[int, int] = {}
    at = 0
    try:
        while at < len(index):
            _, length = RECORD.unpack_from(index, at)
            offsets[_NUMBER.unpack_from(index, at + 9)[0]] = at
            at += 9 + length
    except NONSENSE:
        return {}
    return offsets
