"""Opus packets as an Ogg file (RFC 3533, RFC 7845), which browsers play and seek in."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterable, Iterator

from base_station.radio.opus import SAMPLE_HZ, samples_of

_PAGE = struct.Struct("<4sBBqIIIB")
_HEAD = struct.Struct("<8sBBHIhB")
_CRC_OFFSET = 22
_FIRST, _LAST = 2, 4
_SERIAL = 1
_PRE_SKIP_SAMPLES = 312  # by which the encoder is behind
_SEGMENTS_MAX = 255
_PAGE_SAMPLES = SAMPLE_HZ  # a second a page: so fine is the seeking
_VENDOR = b"muster"
_REVERSED = bytes(int(f"{byte:08b}"[::-1], 2) for byte in range(256))


def ogg_opus(packets: Iterable[bytes]) -> bytes:
    """One mono stream; the packets follow each other without a gap."""
    return b"".join(_pages(packets))


def _pages(packets: Iterable[bytes]) -> Iterator[bytes]:
    head = _HEAD.pack(b"OpusHead", 1, 1, _PRE_SKIP_SAMPLES, SAMPLE_HZ, 0, 0)
    yield _page([head], 0, 0, _FIRST)
    tags = b"OpusTags" + struct.pack("<I", len(_VENDOR)) + _VENDOR + struct.pack("<I", 0)
    yield _page([tags], 0, 1, 0)
    number, samples, begin = 2, 0, 0
    waiting: list[bytes] = []
    for packet in packets:
        is_full = sum(map(_segments, waiting)) + _segments(packet) > _SEGMENTS_MAX
        if waiting and (is_full or samples - begin >= _PAGE_SAMPLES):
            yield _page(waiting, samples, number, 0)
            number, begin, waiting = number + 1, samples, []
        waiting.append(packet)
        samples += samples_of(packet)
    yield _page(waiting, samples, number, _LAST)


def _segments(packet: bytes) -> int:
    return len(packet) // 255 + 1


def _page(packets: list[bytes], granule: int, number: int, flags: int) -> bytes:
    lacing = b"".join(b"\xff" * (len(one) // 255) + bytes((len(one) % 255,)) for one in packets)
    page = bytearray(
        _PAGE.pack(b"OggS", 0, flags, granule, _SERIAL, number, 0, len(lacing)) + lacing
    )
    page += b"".join(packets)
    struct.pack_into("<I", page, _CRC_OFFSET, _crc32(bytes(page)))
    return bytes(page)


def _crc32(data: bytes) -> int:
    """That of Ogg: the usual polynomial, highest bit first, from 0.  It is zlib's of the reversed
    bits, in reverse.
    """
    reverse = zlib.crc32(data.translate(_REVERSED), 0xFFFF_FFFF) ^ 0xFFFF_FFFF
    return int.from_bytes(reverse.to_bytes(4, "little").translate(_REVERSED), "big")
