"""Tones as they are written for the sound card, and how soon an interrupt ends any sound."""

from __future__ import annotations

import io
import threading
import time
import wave
from pathlib import Path

import numpy as np
import pytest

from edge.notifiers.signals import PATTERNS, Signal
from edge.notifiers.sound import SoundNotifier, pattern_wave
from edge.notifiers.sound_card import play_wave
from shared.errors import ConfigError
from tests.rig.waiting import PATIENCE_S

PIPE_BYTES = 65_536


@pytest.mark.parametrize("signal", list(Signal))
def test_each_pulse_has_its_length_and_its_tone(signal: Signal) -> None:
    with wave.open(io.BytesIO(pattern_wave(signal))) as sound:
        assert (sound.getnchannels(), sound.getsampwidth()) == (1, 2)
        rate_hz = sound.getframerate()
        samples = np.frombuffer(sound.readframes(sound.getnframes()), "<i2").astype(float)
    begin = 0
    for pulse in PATTERNS[signal]:
        tone = samples[begin : begin + round(pulse.on_s * rate_hz)]
        begin += len(tone)
        silence = samples[begin : begin + round(pulse.off_s * rate_hz)]
        begin += len(silence)
        strongest = np.argmax(np.abs(np.fft.rfft(tone))) * rate_hz / len(tone)
        assert strongest == pytest.approx(pulse.tone_hz, abs=rate_hz / len(tone))
        assert np.abs(tone).max() > 20_000, "it is loud"
        assert abs(tone[0]) < 1_000, "it does not begin with a click"
        assert not silence.any()
    assert begin == len(samples)


def programs_at(folder: Path, aplay: str) -> str:
    player = folder / "aplay"
    player.write_text(f"#!/bin/sh\n{aplay}\n")
    player.chmod(0o755)
    return f"{folder}:/usr/bin:/bin"


def test_a_long_sound_is_interrupted_before_the_card_has_taken_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", programs_at(tmp_path, f"exec sleep {3 * PATIENCE_S:g}"))
    interrupt = threading.Event()
    playing = threading.Thread(target=play_wave, args=(b"\0" * 4 * PIPE_BYTES, interrupt))
    playing.start()
    interrupt.set()
    playing.join(PATIENCE_S)
    assert not playing.is_alive()


def test_sound_is_played_on_the_configured_device(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    reported = tmp_path / "said"
    monkeypatch.setenv("PATH", programs_at(tmp_path, f'echo "$@" > {reported}; cat > /dev/null'))
    begun_s = time.monotonic()
    play_wave(pattern_wave(Signal.TEXT), threading.Event(), "plughw:1")
    assert time.monotonic() - begun_s < PATIENCE_S
    assert reported.read_text() == "-q -D plughw:1 -\n"


def test_a_card_that_refuses_is_an_error_with_the_device_and_the_reason(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", programs_at(tmp_path, "echo 'audio open error: busy' >&2; exit 1"))
    with pytest.raises(OSError, match="plays nothing on hw:9: audio open error: busy"):
        play_wave(b"", threading.Event(), "hw:9")


def test_without_aplay_the_package_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(ConfigError, match="apt-get install alsa-utils"):
        SoundNotifier("default", tmp_path)
