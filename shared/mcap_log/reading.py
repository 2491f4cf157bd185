"""Reads the segments of a log: by time and topic, whole, growing, torn or damaged."""

from __future__ import annotations

import os
import struct
import zlib
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import BinaryIO

from mcap.opcode import Opcode
from mcap.writer import MCAP0_MAGIC

from shared.errors import LogError
from shared.mcap_log.container import (
    BETWEEN_CHUNKS,
    CHUNK,
    CHUNK_INDEX,
    CHUNK_MARK,
    FOOTER_BYTES,
    INDEX_ENTRY,
    INDEX_OFFSET,
    MESSAGE,
    MESSAGE_BYTES,
    NONSENSE,
    RECORD,
    learn_topic,
    message_offsets,
    records_in,
    unpacked,
)
from shared.mcap_log.folder import segment_paths, segments_within
from shared.mcap_log.schemas import DERIVED
from shared.mcap_log.writing import SegmentInfo, SegmentState

LogRecord = tuple[int, str, bytes]  # log time, key, payload


@dataclass(frozen=True, slots=True)
class _Chunk:
    offset: int  # of the record
    start_ns: int
    end_ns: int
    topic_offsets: bytes | None = None  # of the message indexes; None: not known


@dataclass(slots=True)
class _Contents:
    """What a segment holds, found without decompressing it."""

    chunks: list[_Chunk] = field(default_factory=list)
    topics: dict[int, str] = field(default_factory=dict)
    chunks_learned: int = 0  # of how many chunks, from the first, the topics are known
    counts: dict[int, int] | None = None  # messages a topic; None: not known
    is_complete: bool = False
    readable_bytes: int = 0


@dataclass(frozen=True, slots=True)
class IntactChunk:
    """A chunk as it stands in the file, and what is in it."""

    record: bytes  # with opcode and length
    start_ns: int
    end_ns: int
    index: bytes  # the message index records behind it; empty where they are not whole
    data: bytes  # schema, channel and message records


@dataclass(frozen=True, slots=True)
class _Wanted:
    """Which records are asked for."""

    low_ns: int
    high_ns: int
    keys: Collection[str] | None
    derived: bool

    def has_key(self, key: str) -> bool:
        return (self.keys is None or key in self.keys) and (
            self.derived or not key.startswith(DERIVED)
        )


class SegmentReader:
    """Reads one segment; as a context manager it closes the file.

    Nothing that the bytes of the file may be raises: what cannot be read is described in
    ``damage`` while reading, and reading goes on behind it where it can.
    """

    def __init__(self, path: Path) -> None:
        """Raises LogError when the file cannot be opened."""
        self.path = path
        self.damage: list[str] = []
        try:
            self._file: BinaryIO = path.open("rb")
        except OSError as error:
            raise LogError(f"{path} cannot be read: {error.strerror}") from error
        self._size = os.fstat(self._file.fileno()).st_size
        self._contents = self._from_summary() or self._from_walk()

    def __enter__(self) -> SegmentReader:
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()

    @property
    def is_complete(self) -> bool:
        """Whether the file was ended in order."""
        return self._contents.is_complete

    @property
    def bytes_lost(self) -> int:
        """Behind the last readable record of a file that was not ended in order."""
        return self._size - self._contents.readable_bytes

    def info(self) -> SegmentInfo:
        """Counts the messages of a segment that is not complete by reading it."""
        chunks = self._contents.chunks
        if self._contents.counts is None:
            messages = sum(1 for _ in self.records())
        else:
            topics = self._contents.topics
            messages = sum(
                count
                for topic, count in self._contents.counts.items()
                if not topics.get(topic, "").startswith(DERIVED)
            )
        return SegmentInfo(
            self.path,
            SegmentState.CLOSED if self.is_complete else SegmentState.TORN,
            min((chunk.start_ns for chunk in chunks), default=0),
            max((chunk.end_ns for chunk in chunks), default=0),
            messages,
            self._size,
        )

    def records(
        self,
        start_ns: int | None = None,
        end_ns: int | None = None,
        keys: Collection[str] | None = None,
        *,
        derived: bool = False,
    ) -> Iterator[LogRecord]:
        """The records from ``start_ns`` until before ``end_ns``, in the order of writing."""
        wanted = _Wanted(
            0 if start_ns is None else start_ns,
            1 << 64 if end_ns is None else end_ns,
            keys,
            derived,
        )
        for index, chunk in enumerate(self._contents.chunks):
            outside = chunk.end_ns < wanted.low_ns or chunk.start_ns >= wanted.high_ns
            if outside and index < self._contents.chunks_learned:
                continue
            data = self._chunk_data(chunk)
            offsets = None if keys is None else self._indexed_offsets(chunk, keys, data)
            if offsets is None:
                offsets = list(message_offsets(data, self._contents.topics))
            self._contents.chunks_learned = max(self._contents.chunks_learned, index + 1)
            if not outside:
                yield from self._records_at(data, offsets, wanted)

    def intact_chunks(self) -> Iterator[IntactChunk]:
        """What can be read, as it stands in the file."""
        for chunk in self._contents.chunks:
            data = self._chunk_data(chunk)
            if data:
                _, length = self._record_at(chunk.offset)
                record = self._read(chunk.offset, 9 + length)
                index = self._index_behind(chunk.offset + len(record))
                yield IntactChunk(record, chunk.start_ns, chunk.end_ns, index, data)

    def _index_behind(self, offset: int) -> bytes:
        end = offset
        while end + 9 <= self._size:
            opcode, length = self._record_at(end)
            if opcode != Opcode.MESSAGE_INDEX:
                break
            end += 9 + length
        return self._read(offset, end - offset) if end <= self._size else b""

    def _records_at(self, data: bytes, offsets: list[int], wanted: _Wanted) -> Iterator[LogRecord]:
        topics = {
            number: key for number, key in self._contents.topics.items() if wanted.has_key(key)
        }
        known = self._contents.topics
        unknown = 0
        for offset in offsets:
            _, length, topic, _, t_ns = MESSAGE.unpack_from(data, offset)
            key = topics.get(topic)
            if key is not None and wanted.low_ns <= t_ns < wanted.high_ns:
                yield t_ns, key, data[offset + MESSAGE_BYTES : offset + 9 + length]
            elif topic not in known:
                unknown += 1
        if unknown:
            self._note(f"{unknown} records whose key was in a damaged part are lost")

    def _chunk_data(self, chunk: _Chunk) -> bytes:
        """The chunk's records; nothing, and a note of the damage, where they are not intact."""
        try:
            _, length = self._record_at(chunk.offset)
            return unpacked(self._read(chunk.offset + 9, length))
        except NONSENSE as error:
            self._note(f"the chunk at byte {chunk.offset} is lost ({error})")
            return b""

    def _indexed_offsets(
        self, chunk: _Chunk, keys: Collection[str], data: bytes
    ) -> list[int] | None:
        """Offsets of the wanted topics' messages inside the chunk, in the order of writing.

        None where there is no index.  The index has no checksum, so it is held against the data.
        """
        if chunk.topic_offsets is None or not data:
            return None
        offsets: list[int] = []
        try:
            for topic, at in INDEX_OFFSET.iter_unpack(chunk.topic_offsets):
                if self._contents.topics.get(topic) in keys:
                    offsets += self._index_entries(topic, at, data)
        except NONSENSE:
            self._note(f"the index of the chunk at byte {chunk.offset} is damaged; read without it")
            return None
        return sorted(offsets)

    def _index_entries(self, topic: int, at: int, data: bytes) -> list[int]:
        _, length = self._record_at(at)
        entries = list(INDEX_ENTRY.iter_unpack(self._read(at + 9, length)[6:]))
        offsets = [offset for _, offset in entries]
        found = [MESSAGE.unpack_from(data, offset) for offset in offsets]
        if [(topic, t_ns) for t_ns, _ in entries] != [(head[2], head[4]) for head in found]:
            raise ValueError("it names other messages")
        if any(later <= earlier for earlier, later in pairwise(offsets)):
            raise ValueError("it is out of order")
        return offsets

    def _from_summary(self) -> _Contents | None:
        """The contents as the end of a complete file lists them; None where it does not."""
        try:
            return self._read_summary()
        except NONSENSE:
            return None

    def _read_summary(self) -> _Contents | None:
        if self._size < FOOTER_BYTES + len(MCAP0_MAGIC):
            return None
        footer = self._read(self._size - FOOTER_BYTES, FOOTER_BYTES)
        start, _, expected_crc = struct.unpack_from("<QQI", footer, 9)
        if not footer.endswith(MCAP0_MAGIC) or footer[0] != Opcode.FOOTER or start == 0:
            return None
        summary = self._read(start, self._size - FOOTER_BYTES - start)
        if zlib.crc32(footer[: 9 + 16], zlib.crc32(summary)) != expected_crc:
            self._note("its table of contents is damaged and was made again")
            return None
        contents = _Contents(is_complete=True, readable_bytes=self._size, counts={})
        for opcode, body in records_in(summary):
            if opcode == Opcode.CHANNEL:
                learn_topic(body, contents.topics)
            elif opcode == Opcode.CHUNK_INDEX:
                begin, end, offset, _, count = CHUNK_INDEX.unpack_from(body)
                topic_offsets = body[CHUNK_INDEX.size : CHUNK_INDEX.size + count]
                contents.chunks.append(_Chunk(offset, begin, end, topic_offsets or None))
            elif opcode == Opcode.STATISTICS:
                contents.counts = dict(struct.iter_unpack("<HQ", body[46:]))
        contents.chunks_learned = len(contents.chunks)
        return contents

    def _from_walk(self) -> _Contents:
        """The contents of a file without an end, as far as it goes."""
        contents = _Contents()
        offset = len(MCAP0_MAGIC)
        while offset + 9 <= self._size:
            opcode, length = self._record_at(offset)
            fits = offset + 9 + length <= self._size
            is_chunk = opcode == Opcode.CHUNK and length >= CHUNK.size
            if not fits or not (is_chunk or opcode in BETWEEN_CHUNKS):
                found = self._next_chunk(offset + 1)
                if found is None:
                    break
                self._note(f"bytes {offset} to {found} make no sense")
                offset = found
                continue
            if is_chunk:
                start_ns, end_ns, *_ = CHUNK.unpack(self._read(offset + 9, CHUNK.size))
                contents.chunks.append(_Chunk(offset, start_ns, end_ns))
            offset += 9 + length
            contents.readable_bytes = offset
        return contents

    def _next_chunk(self, offset: int) -> int | None:
        """The next intact chunk record at or behind ``offset``, by the name of its compression."""
        rest = self._read(offset, self._size - offset)
        at = -1
        while (at := rest.find(CHUNK_MARK, at + 1)) >= 0:
            begin = at - 9 - (CHUNK.size - 4)
            if begin >= 0 and rest[begin] == Opcode.CHUNK:
                _, length = RECORD.unpack_from(rest, begin)
                try:
                    unpacked(rest[begin + 9 : begin + 9 + length])
                except NONSENSE:
                    continue
                return offset + begin
        return None

    def _record_at(self, offset: int) -> tuple[int, int]:
        opcode, length = RECORD.unpack(self._read(offset, 9))
        return opcode, length

    def _read(self, offset: int, count: int) -> bytes:
        try:
            data = os.pread(self._file.fileno(), count, offset)
        except (OSError, OverflowError) as error:
            raise ValueError(f"the disk does not give it: {error}") from error
        if len(data) < count:
            raise ValueError("the file ends before it")
        return data

    def _note(self, what: str) -> None:
        note = f"{self.path.name}: {what}"
        if note not in self.damage:
            self.damage.append(note)


def read_log(
    folder: Path,
    start_ns: int | None = None,
    end_ns: int | None = None,
    keys: Collection[str] | None = None,
    on_damage: Callable[[str], None] = lambda _: None,
) -> Iterator[LogRecord]:
    """The records of a folder of segments in the order of writing: ``(t_ns, key, payload)``.

    From ``start_ns`` until before ``end_ns``; log times must not go back from one segment to the
    next.  ``on_damage`` hears in words of each part that could not be read.  Raises LogError
    when a segment cannot be opened.
    """
    for path in segments_within(segment_paths(folder), start_ns, end_ns):
        with SegmentReader(path) as segment:
            yield from segment.records(start_ns, end_ns, keys)
            for note in segment.damage:
                on_damage(note)
