"""Identity of the log that a segment belongs to, for any reader of MCAP: a metadata record behind
the header.  Segments of earlier versions have none.
"""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

from mcap.opcode import Opcode
from mcap.records import Metadata
from mcap.writer import MCAP0_MAGIC

from shared.errors import LogError
from shared.mcap_log.container import NONSENSE, RECORD
from shared.mcap_log.segment_file import SegmentFile

PROFILE = "muster"
METADATA_NAME = "muster.log"
_LOG_ID, _FOLLOWS, _REVISION, _CRC32 = "log_id", "follows", "revision", "crc32"
_LENGTH = struct.Struct("<I")
_KEPT = 65_536  # heads; they are small


@dataclass(frozen=True, slots=True)
class SegmentIdentity:
    """The same ``log_id`` is in all segments of a log; empty: of an earlier version."""

    log_id: str = ""
    follows: str = ""  # the name of the segment before it; empty: it is the first
    profile: str = PROFILE  # of the program that wrote it
    revision: int = 0  # number of times that its records were changed

    def metadata(self) -> Metadata:
        """With a checksum, for the container has none: a bit that flips makes no other log."""
        contents = {_LOG_ID: self.log_id, _FOLLOWS: self.follows}
        if self.revision:
            contents[_REVISION] = str(self.revision)
        checked = zlib.crc32(" ".join(contents.values()).encode())
        return Metadata(METADATA_NAME, {**contents, _CRC32: f"{checked:08x}"})

    def revised(self) -> SegmentIdentity:
        """Identity of the segment with other records."""
        return replace(self, revision=self.revision + 1)


def identity_of(path: Path) -> SegmentIdentity | None:
    """Identity of a segment; None where it is damaged or gone."""
    try:
        file = path.stat()
    except OSError:
        return None
    return _read(path, file.st_ino, file.st_mtime_ns, file.st_size)


@lru_cache(_KEPT)
def _read(path: Path, _inode: int, _written_ns: int, _size: int) -> SegmentIdentity | None:
    """Every look into a log asks it of all its segments; another file is another key."""
    try:
        file = SegmentFile(path)
    except LogError:
        return None
    try:
        return _identity(file)
    except NONSENSE:
        return None
    finally:
        file.close()


def _identity(file: SegmentFile) -> SegmentIdentity:
    profile, offset = _header(file)
    if profile != PROFILE:
        return SegmentIdentity(profile=profile)
    opcode, length = file.record_at(offset)
    if opcode == Opcode.CHUNK:
        return SegmentIdentity()
    if opcode != Opcode.METADATA:
        raise ValueError("no such record stands there")
    name, contents = _metadata(file.read(offset + RECORD.size, length))
    identity = SegmentIdentity(
        contents.get(_LOG_ID, ""),
        contents.get(_FOLLOWS, ""),
        revision=int(contents.get(_REVISION, "0")),
    )
    if (name, contents) != (METADATA_NAME, identity.metadata().metadata):
        raise ValueError("it is not as it was written")
    return identity


def first_chunk_at(file: SegmentFile) -> int:
    """Offset of its beginning; ValueError where the head is damaged."""
    _, offset = _header(file)
    opcode, length = file.record_at(offset)
    return offset + RECORD.size + length if opcode == Opcode.METADATA else offset


def _header(file: SegmentFile) -> tuple[str, int]:
    """The profile, and what stands behind the header; ValueError where there is none."""
    if file.read(0, len(MCAP0_MAGIC)) != MCAP0_MAGIC:
        raise ValueError("it is no MCAP file")
    opcode, length = file.record_at(len(MCAP0_MAGIC))
    if opcode != Opcode.HEADER:
        raise ValueError("it has no header")
    begin = len(MCAP0_MAGIC) + RECORD.size
    body = file.read(begin, length)
    (count,) = _LENGTH.unpack_from(body)
    return body[4 : 4 + count].decode(), begin + length


def _metadata(body: bytes) -> tuple[str, dict[str, str]]:
    """Name and contents of a metadata record."""
    name, offset = _text(body, 0)
    offset += _LENGTH.size  # of all that follows
    contents = {}
    while offset < len(body):
        key, offset = _text(body, offset)
        contents[key], offset = _text(body, offset)
    return name, contents


def _text(body: bytes, offset: int) -> tuple[str, int]:
    """And what stands behind it."""
    (count,) = _LENGTH.unpack_from(body, offset)
    begin = offset + _LENGTH.size
    if begin + count > len(body):
        raise ValueError("the record ends before it")
    return body[begin : begin + count].decode(), begin + count
