"""The MCAP container as far as reading it needs: its records and what a chunk holds.

Read with ``struct``: the library's reader stops at the first thing that is wrong, and takes
several times as long.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator

import zstandard
from mcap.opcode import Opcode
from mcap.writer import MCAP0_MAGIC

from shared.coded_text import coded

RECORD = struct.Struct("<BQ")  # opcode, length
CHUNK = struct.Struct("<QQQII")  # start, end, uncompressed size, crc, length of compression
MESSAGE = struct.Struct("<BQHIQ")  # opcode, length, channel, sequence, log time
MESSAGE_BYTES = 9 + 2 + 4 + 8 + 8  # up to the payload
CHUNK_INDEX = struct.Struct("<QQQQI")  # start, end, offset, length, length of the index offsets
INDEX_OFFSET = struct.Struct("<HQ")
INDEX_HEAD = struct.Struct("<HI")  # channel, bytes of the entries
INDEX_ENTRY = struct.Struct("<QQ")
DATA_END_BYTES = 4
FOOTER_BYTES = 9 + 20 + len(MCAP0_MAGIC)
CHUNK_BYTES_MAX = 1 << 30
COMPRESSION = b"zstd"
CHUNK_MARK = struct.pack("<I", len(COMPRESSION)) + COMPRESSION
NONSENSE = (ValueError, struct.error, OverflowError)  # what reading damaged bytes may raise
BETWEEN_CHUNKS = (Opcode.HEADER, Opcode.METADATA, Opcode.ATTACHMENT, Opcode.MESSAGE_INDEX)


def unpacked(chunk: bytes) -> bytes:
    """The records inside a chunk record; ValueError when they are not intact."""
    _, _, size, crc, name_length = CHUNK.unpack_from(chunk)
    body = CHUNK.size + name_length
    if chunk[CHUNK.size : body] != COMPRESSION or size > CHUNK_BYTES_MAX:
        raise ValueError(coded("chunk-head", "its head makes no sense"))
    try:
        data = zstandard.decompress(chunk[body + 8 :], size)
    except (zstandard.ZstdError, MemoryError) as error:
        raise ValueError(coded("chunk-packed", "it does not unpack")) from error
    if zlib.crc32(data) != crc:
        raise ValueError(coded("chunk-checksum", "its checksum is wrong"))
    return data


def records_in(data: bytes) -> Iterator[tuple[int, bytes]]:
    """Opcode and body of each MCAP record."""
    offset = 0
    while offset < len(data):
        opcode, length = RECORD.unpack_from(data, offset)
        yield opcode, data[offset + 9 : offset + 9 + length]
        offset += 9 + length


def message_offsets(data: bytes, topics: dict[int, str]) -> Iterator[int]:
    """Positions of the messages in a chunk's data; learns the topics on the way."""
    offset = 0
    unpack = RECORD.unpack_from
    message = int(Opcode.MESSAGE)
    while offset < len(data):
        opcode, length = unpack(data, offset)
        if opcode == message:
            yield offset
        elif opcode == Opcode.CHANNEL:
            learn_topic(data[offset + 9 : offset + 9 + length], topics)
        offset += 9 + length


def learn_topic(channel: bytes, topics: dict[int, str]) -> None:
    number, _, length = struct.unpack_from("<HHI", channel)
    topics[number] = channel[8 : 8 + length].decode("utf-8", "replace")
