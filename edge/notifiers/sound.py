"""Tones on the machine's sound card (ALSA): the patterns of the beeper, through a loudspeaker."""

from __future__ import annotations

import io
import wave
from functools import cache
from pathlib import Path
from threading import Event

import numpy as np
import numpy.typing as npt

from edge.notifiers.signals import PATTERNS, Notice, Pulse, Signal
from edge.notifiers.sound_card import play_wave, require_programs

_SAMPLES_PER_S = 22_050
_AMPLITUDE = 0.9 * 32_767  # of 16 bits
_RAMP_S = 0.005  # a tone that begins at once begins with a click


class SoundNotifier:
    """ALSA device: ``default``, or another of ``aplay -L``; it may be attached later."""

    def __init__(self, device: str, _sysfs: Path) -> None:
        """Raises ConfigError where no program plays sounds."""
        require_programs("sound")
        self._device = device

    def play(self, notice: Notice, interrupt: Event) -> None:
        play_wave(pattern_wave(notice.signal), interrupt, self._device)

    def close(self) -> None:
        """Nothing is held open between notices."""


@cache
def pattern_wave(signal: Signal) -> bytes:
    """Return the signal's pattern as a WAV file of one channel."""
    samples = np.concatenate([_pulse(pulse) for pulse in PATTERNS[signal]])
    file = io.BytesIO()
    with wave.open(file, "wb") as sound:
        sound.setnchannels(1)
        sound.setsampwidth(2)
        sound.setframerate(_SAMPLES_PER_S)
        sound.writeframes(samples.astype("<i2").tobytes())
    return file.getvalue()


def _pulse(pulse: Pulse) -> npt.NDArray[np.float64]:
    times_s = np.arange(round(pulse.on_s * _SAMPLES_PER_S)) / _SAMPLES_PER_S
    ramp = np.clip(np.minimum(times_s, pulse.on_s - times_s) / _RAMP_S, 0.0, 1.0)
    tone = _AMPLITUDE * ramp * np.sin(2.0 * np.pi * pulse.tone_hz * times_s)
    return np.concatenate((tone, np.zeros(round(pulse.off_s * _SAMPLES_PER_S))))
