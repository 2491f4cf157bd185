"""Packs a complete segment anew in larger chunks.

A segment is written in chunks of half a second, so that a crash costs no more; the index of so many
small chunks is then near half of the file.  In chunks of a megabyte, compressed harder, the same
records take two thirds.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from itertools import pairwise
from pathlib import Path

import zstandard

from shared.mcap_log.container import NONSENSE
from shared.mcap_log.enclosures import enclosures_of
from shared.mcap_log.identity import METADATA_NAME, PROFILE, identity_of
from shared.mcap_log.reading import SegmentReader
from shared.mcap_log.segment_exchange import exchange_segment
from shared.mcap_log.segment_rebuild import RebuiltSegment
from shared.mcap_log.writing import SegmentState

PACKED_BYTES = 1 << 20  # of a chunk, before compression: some seconds of a hundred units
_LEVEL = 9  # of Zstandard


def can_be_packed(path: Path) -> bool:
    """True for a complete segment, undamaged as far as its table of contents shows, that would have
    fewer chunks.  Raises LogError when there is no such file.
    """
    identity = identity_of(path)
    if identity is None or identity.profile != PROFILE:
        return False
    with SegmentReader(path) as reader:
        if reader.state is not SegmentState.CLOSED:
            return False
        try:
            sizes = reader.chunk_sizes()
        except NONSENSE:
            return False
    return any(size + following < PACKED_BYTES for size, following in pairwise(sizes))


def pack_segment(path: Path) -> bool:
    """Pack a segment that ``can_be_packed``; False, and the file as it was, where a part of it
    cannot be read, or it has more than records.

    The records stay as they are, byte by byte and in their order.  The segment is exchanged as a
    whole or not at all; what a reader has open stays as it was.  No process may write to it
    meanwhile.  Raises LogError when the disk refuses.
    """
    return bool(exchange_segment(path, partial(_write_packed, path), attempted="packed"))


def _write_packed(path: Path, making: Path) -> bool:
    enclosures = enclosures_of(path)
    if enclosures.attachments or enclosures.metadata.keys() - {METADATA_NAME}:
        return False
    identity = identity_of(path)
    if identity is None:
        return False
    compressor = zstandard.ZstdCompressor(_LEVEL)
    with SegmentReader(path) as reader:
        packed = RebuiltSegment(making, identity)
        try:
            for data in _joined(one.data for one in reader.intact_chunks()):
                packed.add_records(data, compressor)
                packed.file.sync()  # little at a time: the live log waits for the same disk
            packed.finish()
            packed.file.sync()
        finally:
            packed.file.close()
        counts, is_damaged = reader.topic_counts, bool(reader.damage)
    with SegmentReader(making) as written:
        return not is_damaged and written.is_whole() and written.topic_counts == counts


def _joined(parts: Iterator[bytes]) -> Iterator[bytes]:
    """Join chunks of records to chunks of ``PACKED_BYTES``."""
    joined: list[bytes] = []
    size = 0
    for part in parts:
        joined.append(part)
        size += len(part)
        if size >= PACKED_BYTES:
            yield b"".join(joined)
            joined, size = [], 0
    if joined:
        yield b"".join(joined)
