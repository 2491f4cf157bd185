"""Enclosures of an MCAP file: its metadata, and the files that are attached to its messages."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from mcap.exceptions import McapError
from mcap.reader import make_reader

from shared.errors import LogError
from shared.mcap_log.container import NONSENSE, RECORD

_CRC = struct.Struct("<I")  # behind the content
_PART_BYTES = 1 << 20


@dataclass(frozen=True, slots=True)
class AttachedFile:
    """Content of a file that is attached: bytes from ``begin`` until before ``end``."""

    record: int  # where what the checksum is of begins
    begin: int
    end: int


@dataclass(frozen=True, slots=True)
class Enclosures:
    """By name; of the same name the last one."""

    metadata: Mapping[str, Mapping[str, str]]
    attachments: Mapping[str, AttachedFile]


def enclosures_of(path: Path) -> Enclosures:
    """Nothing where the file is no complete MCAP file.  Raises OSError where it cannot be read."""
    try:
        with path.open("rb") as file:
            reader = make_reader(file, validate_crcs=True)
            metadata = {one.name: one.metadata for one in reader.iter_metadata()}
            summary = reader.get_summary()
            indexes = () if summary is None else summary.attachment_indexes
            attachments = {
                one.name: AttachedFile(
                    one.offset + RECORD.size,
                    one.offset + one.length - _CRC.size - one.data_size,
                    one.offset + one.length - _CRC.size,
                )
                for one in indexes
            }
    except (McapError, *NONSENSE):
        return Enclosures({}, {})
    return Enclosures(metadata, attachments)


def read_attached(path: Path, attached: AttachedFile) -> Iterator[bytes]:
    """Content of a file that is attached, in parts.  Raises LogError where it is damaged."""
    with path.open("rb") as file:
        file.seek(attached.record)
        crc = zlib.crc32(file.read(attached.begin - attached.record))
        left = attached.end - attached.begin
        while left > 0 and (part := file.read(min(left, _PART_BYTES))):
            crc, left = zlib.crc32(part, crc), left - len(part)
            yield part
        if left or _CRC.unpack(file.read(_CRC.size))[0] != crc:
            raise LogError(f"a file that is attached to {path} is damaged")
