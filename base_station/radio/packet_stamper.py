"""Sound of a source as packets with their times."""

from __future__ import annotations

from collections.abc import Iterator

from base_station.radio.config import RadioConfig
from base_station.radio.encoder import BYTES_PER_SAMPLE, VoiceEncoder
from base_station.radio.opus import SAMPLE_HZ
from base_station.radio.sample_clock import SampleClock
from base_station.radio.sources import Sound
from shared.clock import NS_PER_S

_JUMP_S = 0.05  # between two pieces: something is missing
_SAME_AXIS_S = 10.0  # a longer way forward, or any back: the source's own time begins anew
_DEVICE_WINDOW_S, _STREAM_WINDOW_S = 2.0, 10.0
_DEVICE_SETTLES_S, _STREAM_SETTLES_S = 0.5, 2.0  # servers give the last seconds at once


class PacketStamper:
    """``push`` pieces as they come; of a source that is opened anew another one."""

    def __init__(self, config: RadioConfig) -> None:
        self._config = config
        self._clock = SampleClock(_DEVICE_WINDOW_S if config.is_device else _STREAM_WINDOW_S)
        settles_s = _DEVICE_SETTLES_S if config.is_device else _STREAM_SETTLES_S
        self._settles_ns = round(settles_s * NS_PER_S)
        self._settled_ns: int | None = None  # monotonic; None: nothing came yet
        self._encoder: VoiceEncoder | None = None
        self._began_s = 0.0  # of the piece with which the encoder began
        self._samples = 0  # since then
        self._held: list[tuple[float, bytes]] = []  # until it is known when they were

    def push(self, sound: Sound) -> Iterator[tuple[int, bytes]]:
        """Give packets with the monotonic times (ns) of their first samples."""
        encoder = self._encoder_for(sound)
        self._samples += len(sound.pcm) // BYTES_PER_SAMPLE
        self._clock.note(self._end_s, sound.received_ns)
        for first_sample, packet in encoder.push(sound.pcm):
            self._held.append((self._began_s + first_sample / SAMPLE_HZ, packet))
        if self._settled_ns is None:
            self._settled_ns = sound.received_ns + self._settles_ns
        if sound.received_ns < self._settled_ns:
            return
        delay_ns = round(self._config.delay_s * NS_PER_S)
        for at_s, packet in self._held:
            yield self._clock.time_ns(at_s) - delay_ns, packet
        self._held.clear()

    @property
    def _end_s(self) -> float:
        return self._began_s + self._samples / SAMPLE_HZ

    def _encoder_for(self, sound: Sound) -> VoiceEncoder:
        jump_s = sound.start_s - self._end_s
        if self._encoder is None or abs(jump_s) > _JUMP_S:
            if not 0.0 <= jump_s < _SAME_AXIS_S:
                self._clock.restart()
                self._held.clear()
            self._encoder = VoiceEncoder(self._config.bits_per_s, self._config.silence_dbfs)
            self._began_s, self._samples = sound.start_s, 0
        return self._encoder
