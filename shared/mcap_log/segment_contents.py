"""Contents of a segment: its chunks and topics, from its summary or from its records."""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass, field

from mcap.opcode import Opcode
from mcap.writer import MCAP0_MAGIC

from shared.coded_text import coded
from shared.mcap_log.container import (
    BETWEEN_CHUNKS,
    CHUNK,
    CHUNK_INDEX,
    CHUNK_MARK,
    DATA_END_BYTES,
    FOOTER_BYTES,
    NONSENSE,
    RECORD,
    learn_topic,
    records_in,
    unpacked,
)
from shared.mcap_log.segment_file import SegmentFile


@dataclass(frozen=True, slots=True)
class Chunk:
    offset: int  # of the record
    start_ns: int
    end_ns: int
    topic_offsets: bytes | None = None  # of the message indexes; None: not known


@dataclass(slots=True)
class Contents:
    """Contents of a segment, found without decompressing it."""

    chunks: list[Chunk] = field(default_factory=list)
    topics: dict[int, str] = field(default_factory=dict)
    chunks_learned: int = 0  # of how many chunks, from the first, the topics are known
    counts: dict[int, int] | None = None  # messages a topic; None: not known
    is_complete: bool = False
    readable_bytes: int = 0


def contents_of(file: SegmentFile) -> Contents:
    """Return the content of any bytes; invalid parts are noted as damage of the file."""
    return _from_summary(file) or _from_walk(file)


def _from_summary(file: SegmentFile) -> Contents | None:
    """The contents as the end of a complete file lists them; None where it does not."""
    try:
        return _read_summary(file)
    except NONSENSE:
        _note_contents(file)
        return None


def _read_summary(file: SegmentFile) -> Contents | None:
    if file.size < FOOTER_BYTES + len(MCAP0_MAGIC):
        return None
    footer = file.read(file.size - FOOTER_BYTES, FOOTER_BYTES)
    start, _, expected_crc = struct.unpack_from("<QQI", footer, 9)
    if not footer.endswith(MCAP0_MAGIC) or footer[0] != Opcode.FOOTER or start == 0:
        return None
    summary = file.read(start, file.size - FOOTER_BYTES - start)
    if zlib.crc32(footer[: 9 + 16], zlib.crc32(summary)) != expected_crc:
        _note_contents(file)
        return None
    contents = Contents(is_complete=True, readable_bytes=file.size, counts={})
    for opcode, body in records_in(summary):
        if opcode == Opcode.CHANNEL:
            learn_topic(body, contents.topics)
        elif opcode == Opcode.CHUNK_INDEX:
            begin, end, offset, _, count = CHUNK_INDEX.unpack_from(body)
            topic_offsets = body[CHUNK_INDEX.size : CHUNK_INDEX.size + count]
            contents.chunks.append(Chunk(offset, begin, end, topic_offsets or None))
        elif opcode == Opcode.STATISTICS:
            contents.counts = dict(struct.iter_unpack("<HQ", body[46:]))
    contents.chunks_learned = len(contents.chunks)
    return contents


def _note_contents(file: SegmentFile) -> None:
    file.note(
        coded(
            "segment-contents",
            "{file}: its table of contents is damaged and was made again",
            file=file.path.name,
        )
    )


def _from_walk(file: SegmentFile) -> Contents:
    """The contents of a file without an end, as far as it goes."""
    contents = Contents()
    offset = len(MCAP0_MAGIC)
    while offset + 9 <= file.size:
        try:
            length, chunk = _record_at(file, offset)
        except ValueError:
            found = _next_chunk(file, offset + 1)
            if found is None:
                if _is_behind_chunks(file, offset):
                    contents.readable_bytes = file.size
                break
            file.note(
                coded(
                    "segment-bytes",
                    "{file}: bytes {offset} to {until} make no sense",
                    file=file.path.name,
                    offset=offset,
                    until=found,
                )
            )
            offset = found
            continue
        if chunk is not None:
            contents.chunks.append(chunk)
        offset += 9 + length
        contents.readable_bytes = offset
    return contents


def _record_at(file: SegmentFile, offset: int) -> tuple[int, Chunk | None]:
    """Its length, and the chunk where it is one; ValueError where neither can stand there."""
    opcode, length = file.record_at(offset)
    if offset + 9 + length > file.size:
        raise ValueError("the file ends before it")
    if opcode in BETWEEN_CHUNKS:
        return length, None
    if opcode != Opcode.CHUNK or length < CHUNK.size:
        raise ValueError("no such record stands between chunks")
    start_ns, end_ns, *_ = CHUNK.unpack(file.read(offset + 9, CHUNK.size))
    return length, Chunk(offset, start_ns, end_ns)


def _is_behind_chunks(file: SegmentFile, offset: int) -> bool:
    """True if what begins there and cannot be read is no record: an index, or what ends a file."""
    try:
        opcode, length = file.record_at(offset)
    except ValueError:
        return False
    return opcode == Opcode.MESSAGE_INDEX or (opcode, length) == (Opcode.DATA_END, DATA_END_BYTES)


def _next_chunk(file: SegmentFile, offset: int) -> int | None:
    """The next intact chunk record at or behind ``offset``, by the name of its compression."""
    rest = file.read_from(offset)
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
