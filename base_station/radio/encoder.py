"""Encodes voice as Opus packets; silence becomes packets of a few bytes."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

import av
import numpy as np

from base_station.radio.opus import SAMPLE_HZ, SILENT_FRAMES_MAX, silence

BYTES_PER_SAMPLE = 2
_PACKET_SAMPLES = 2_880  # 60 ms: the longest that is one frame, so the fewest bytes
_PACKET_BYTES = _PACKET_SAMPLES * BYTES_PER_SAMPLE
_BLOCK_PACKETS = 2  # 120 ms are voice or silence as a whole: the onset of a word is kept with it
_HANG_OVER_BLOCKS = 4  # pauses between words are kept
_FULL_SCALE = 32_768.0


class VoiceEncoder:
    """``push`` PCM as it comes: 16 bits, mono, 48 kHz, without a gap."""

    def __init__(self, bits_per_s: int, silence_dbfs: float) -> None:
        self._codec = av.CodecContext.create("libopus", "w")
        assert isinstance(self._codec, av.AudioCodecContext)
        self._codec.sample_rate = SAMPLE_HZ
        self._codec.layout = "mono"
        self._codec.format = "s16"
        self._codec.bit_rate = bits_per_s
        self._codec.options = {"application": "voip", "frame_duration": "60"}
        self._threshold = _FULL_SCALE * 10.0 ** (silence_dbfs / 20.0)  # root mean square
        self._waiting = b""
        self._block: list[bytes] = []
        self._is_loud = False  # something in the block
        self._silent_blocks = _HANG_OVER_BLOCKS
        self._taken = 0  # samples
        self._given = 0

    def push(self, pcm: bytes) -> Iterator[tuple[int, bytes]]:
        """Give packets, each with the number of its first sample."""
        waiting = self._waiting + pcm
        whole = len(waiting) - len(waiting) % _PACKET_BYTES
        self._waiting = waiting[whole:]
        for begin in range(0, whole, _PACKET_BYTES):
            self._block.append(self._encoded(waiting[begin : begin + _PACKET_BYTES]))
            if len(self._block) == _BLOCK_PACKETS:
                yield from self._end_block()

    def _end_block(self) -> Iterator[tuple[int, bytes]]:
        self._silent_blocks = 0 if self._is_loud else self._silent_blocks + 1
        if self._silent_blocks > _HANG_OVER_BLOCKS:
            yield self._given, silence(SILENT_FRAMES_MAX)
        else:
            for number, packet in enumerate(self._block):
                yield self._given + number * _PACKET_SAMPLES, packet
        self._given += _BLOCK_PACKETS * _PACKET_SAMPLES
        self._block.clear()
        self._is_loud = False

    def _encoded(self, pcm: bytes) -> bytes:
        samples = np.frombuffer(pcm, np.int16).astype(np.float64)
        self._is_loud |= bool(np.sqrt(np.mean(np.square(samples))) > self._threshold)
        frame = av.AudioFrame(format="s16", layout="mono", samples=_PACKET_SAMPLES)
        frame.planes[0].update(pcm)
        frame.sample_rate, frame.time_base = SAMPLE_HZ, Fraction(1, SAMPLE_HZ)
        frame.pts = self._taken
        self._taken += _PACKET_SAMPLES
        (packet,) = self._codec.encode(frame)
        return bytes(packet)
