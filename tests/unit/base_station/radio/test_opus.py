"""Lengths of Opus packets, and silence."""

from __future__ import annotations

import av
import numpy as np
import pytest

from base_station.radio.opus import duration_ns, is_silence, samples_of, silence
from shared.clock import NS_PER_MS


@pytest.mark.parametrize(
    ("packet", "ms"),
    [
        (bytes((0 << 3,)), 10),  # SILK, narrow band
        (bytes((11 << 3,)), 60),
        (bytes((13 << 3 | 1,)), 40),  # hybrid, two frames of one size
        (bytes((16 << 3 | 2,)), 5),  # CELT, two frames
        (bytes((31 << 3 | 3, 6)), 120),
        (bytes((3,)), 0),  # broken: the count is missing
        (b"", 0),
    ],
)
def test_length_of_a_packet_is_in_its_first_bytes(packet: bytes, ms: int) -> None:
    """RFC 6716, table 2."""
    assert samples_of(packet) == 48 * ms
    assert duration_ns(packet) == ms * NS_PER_MS


@pytest.mark.parametrize("frames", [1, 6])
def test_silence_is_a_packet_that_decodes_to_nothing(frames: int) -> None:
    packet = silence(frames)
    assert is_silence(packet)
    assert not is_silence(packet + b"x")
    assert not is_silence(b"\x7b\x01")
    decoder = av.CodecContext.create("libopus", "r")
    assert isinstance(decoder, av.AudioCodecContext)
    decoder.sample_rate = 48_000
    (frame,) = decoder.decode(av.Packet(packet))
    assert frame.samples == samples_of(packet) == 960 * frames
    assert not np.any(frame.to_ndarray())
