"""Opus packets (RFC 6716): how long one is, and the one that stands for silence."""

from __future__ import annotations

SAMPLE_HZ = 48_000  # of the time axis of Opus, for every codec rate
NS_PER_SAMPLE_3 = 62_500  # of three samples: the length of one is no whole number
_SILK_MS = (10, 20, 40, 60)
_HYBRID_MS = (10, 20)
_CELT_MS = (2.5, 5, 10, 20)
_SILENT_FRAME = b"\xff\xfe"  # 20 ms, mono, full band
_SILENT_TOC = 0xF8 | 3  # and a count of frames of one size follows
SILENT_FRAME_SAMPLES = 960
SILENT_FRAMES_MAX = 6  # 120 ms: a packet has no more


def samples_of(packet: bytes) -> int:
    """Length of a packet in samples at 48 kHz (RFC 6716, section 3.1); 0: it is no packet."""
    if not packet:
        return 0
    config, code = packet[0] >> 3, packet[0] & 3
    if config < 12:
        frame_ms: float = _SILK_MS[config & 3]
    elif config < 16:
        frame_ms = _HYBRID_MS[config & 1]
    else:
        frame_ms = _CELT_MS[config & 3]
    counted = packet[1] & 0x3F if len(packet) > 1 else 0
    frames = (1, 2, 2, counted)[code]
    return round(frames * frame_ms * SAMPLE_HZ / 1000)


def duration_ns(packet: bytes) -> int:
    return samples_of(packet) * NS_PER_SAMPLE_3 // 3


def silence(frames: int) -> bytes:
    """A packet of so many times 20 ms without a sound, six at most."""
    return bytes((_SILENT_TOC, frames)) + _SILENT_FRAME * frames


def is_silence(packet: bytes) -> bool:
    """True for a packet of ``silence``."""
    return len(packet) > 2 and packet == silence(packet[1])
