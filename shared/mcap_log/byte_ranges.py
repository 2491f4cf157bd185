"""Byte ranges of a complete segment: which bytes have the records of which time."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path

from shared.errors import LogError
from shared.mcap_log.container import FOOTER_BYTES, RECORD
from shared.mcap_log.segment_contents import contents_of
from shared.mcap_log.segment_file import SegmentFile


@dataclass(frozen=True, slots=True)
class ChunkRange:
    """A chunk with its index: bytes from ``offset`` until before ``end``."""

    from_ns: int
    until_ns: int  # of its last message
    offset: int
    end: int


@dataclass(frozen=True, slots=True)
class SegmentRanges:
    chunks: tuple[ChunkRange, ...]
    summary_offset: int  # from there to the end is the file's own table of contents
    size: int


def byte_ranges_of(path: Path) -> SegmentRanges:
    """Raises LogError where the file is not complete."""
    file = SegmentFile(path)
    try:
        contents = contents_of(file)
        if not contents.is_complete:
            raise LogError(f"{path} is not complete: muster log recover {path} WHOLE.mcap")
        footer = file.read(file.size - FOOTER_BYTES, FOOTER_BYTES)
        (summary_offset,) = struct.unpack_from("<Q", footer, RECORD.size)
        ends = [one.offset for one in contents.chunks[1:]]
        return SegmentRanges(
            tuple(
                ChunkRange(one.start_ns, one.end_ns, one.offset, end)
                for one, end in zip(contents.chunks, [*ends, summary_offset], strict=False)
            ),
            summary_offset,
            file.size,
        )
    finally:
        file.close()
