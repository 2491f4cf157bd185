"""A radio channel is recorded at the right time, and continues over faults of its source."""

from __future__ import annotations

import os
import threading
import time
import wave
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path

import av
import numpy as np
import numpy.typing as npt
import pytest

from base_station.radio.channel import RadioChannel
from base_station.radio.config import RadioConfig
from base_station.radio.opus import SAMPLE_HZ
from base_station.radio.radio_log import RadioLog
from shared.clock import NS_PER_S, SystemClock
from tests.rig.audio_stream import AudioStream, Behaviour
from tests.rig.tone_pattern import onsets_s, tone_pattern
from tests.rig.waiting import until

pytestmark = pytest.mark.slow

NAME = "Tac-1"
PERIOD_NS = 2 * NS_PER_S
DRIFT_MAX_S = 0.2  # that the sound may be from the clock


@pytest.fixture
def stream() -> Iterator[AudioStream]:
    with AudioStream() as stream:
        yield stream


def decoded(ogg: bytes) -> npt.NDArray[np.float64]:
    resampler = av.AudioResampler(format="s16", layout="mono", rate=SAMPLE_HZ)
    with av.open(BytesIO(ogg), "r") as container:
        parts = [
            part.to_ndarray()[0]
            for frame in container.decode(audio=0)
            for part in resampler.resample(frame)
        ]
    return np.concatenate(parts).astype(np.float64)


def voice_until_ns(log: RadioLog) -> int:
    spans = log.spans(NAME, 0, time.time_ns())
    return spans.voice[-1][1] if spans.voice else 0


def recorded_for(log: RadioLog, from_ns: int, seconds: float) -> bool:
    return voice_until_ns(log) > from_ns + seconds * NS_PER_S


def largest_drift_s(log: RadioLog, from_ns: int, until_ns: int) -> float:
    """Largest difference of the onsets in the window from their even seconds."""
    from_ns = -(-from_ns // PERIOD_NS) * PERIOD_NS - NS_PER_S
    found = onsets_s(decoded(log.audio(NAME, from_ns, until_ns)), SAMPLE_HZ)
    assert len(found) >= (until_ns - from_ns) // PERIOD_NS - 1
    return max(abs((onset_s - 1.0 + 1.0) % 2.0 - 1.0) for onset_s in found)


def test_stream_is_recorded_with_correct_times_over_failures(
    stream: AudioStream, tmp_path: Path
) -> None:
    log = RadioLog(tmp_path)
    channel = RadioChannel(NAME, RadioConfig(stream.url), tmp_path / NAME, SystemClock())
    channel.start()
    try:
        until(lambda: recorded_for(log, time.time_ns(), -3.0), "the first voice")
        (begin_ns, _), *_ = log.spans(NAME, 0, time.time_ns()).recorded
        until(lambda: recorded_for(log, begin_ns, 8.0), "some seconds")
        steady_ns = voice_until_ns(log)
        assert largest_drift_s(log, begin_ns, steady_ns) < DRIFT_MAX_S
        assert channel.view().state == "recording"
        for behaviour, words in (
            (Behaviour.ENDS, "is not recorded"),
            (Behaviour.RUBBISH, "cannot be read"),
            (Behaviour.HANGS, "is not recorded"),
        ):
            stream.behaviour = behaviour
            until(lambda: words in channel.problem, f"{words}")  # noqa: B023  # waited for here
            assert NAME in channel.problem
            assert channel.view().state == "away"
            stream.behaviour = Behaviour.PLAYS
            again_ns = time.time_ns()
            until(lambda: recorded_for(log, again_ns, 6.0), "voice again")  # noqa: B023  # as above
            assert channel.problem == ""
    finally:
        channel.close()
    spans = log.spans(NAME, begin_ns, time.time_ns())
    assert len(spans.recorded) == 4  # each failure is a gap
    for span in spans.recorded:
        assert largest_drift_s(log, *span) < DRIFT_MAX_S


def test_sound_device_is_recorded_with_correct_times(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Through ALSA and ``arecord``, from a pipe in place of a card."""
    pipe, settings = tmp_path / "pipe", tmp_path / "asound.conf"
    os.mkfifo(pipe)
    settings.write_text(
        f'pcm.radio {{ type file; slave.pcm "null"; file "/dev/null"; infile "{pipe}"; '
        'format "raw" }'
    )
    monkeypatch.setenv("ALSA_CONFIG_PATH", f"/usr/share/alsa/alsa.conf:{settings}")
    ended = threading.Event()

    def play() -> None:
        with pipe.open("wb", buffering=0) as file:
            began_ns, given = time.time_ns(), 0
            while not ended.wait(0.005):
                while given < (time.time_ns() - began_ns) * SAMPLE_HZ // NS_PER_S - 960:
                    try:
                        file.write(tone_pattern(began_ns, given, 960, SAMPLE_HZ).tobytes())
                    except OSError:
                        return
                    given += 960

    threading.Thread(target=play, daemon=True).start()
    log = RadioLog(tmp_path / "radio")
    config = RadioConfig("device:radio")
    channel = RadioChannel(NAME, config, log.folder / NAME, SystemClock())
    channel.start()
    try:
        until(lambda: recorded_for(log, time.time_ns(), -3.0), "the first voice")
        (begin_ns, _), *_ = log.spans(NAME, 0, time.time_ns()).recorded
        until(lambda: recorded_for(log, begin_ns, 8.0), "some seconds")
    finally:
        ended.set()
        channel.close()
    assert largest_drift_s(log, begin_ns, voice_until_ns(log)) < DRIFT_MAX_S


def test_file_is_repeated_in_real_time(tmp_path: Path) -> None:
    """A file of two seconds from an even one on: the pattern continues over the repetitions."""
    path = tmp_path / "exercise.wav"
    with wave.open(str(path), "wb") as file:
        file.setparams((1, 2, SAMPLE_HZ, 0, "NONE", ""))
        file.writeframes(tone_pattern(0, 0, 2 * SAMPLE_HZ, SAMPLE_HZ).tobytes())
    log = RadioLog(tmp_path / "radio")
    config = RadioConfig(f"file:{path}")
    channel = RadioChannel(NAME, config, log.folder / NAME, SystemClock())
    channel.start()
    try:
        until(lambda: recorded_for(log, time.time_ns(), -3.0), "the first voice")
        (begin_ns, _), *_ = log.spans(NAME, 0, time.time_ns()).recorded
        until(lambda: recorded_for(log, begin_ns, 8.0), "some rounds")
        assert voice_until_ns(log) < time.time_ns()
    finally:
        channel.close()
    spans = log.spans(NAME, 0, time.time_ns())
    assert len(spans.recorded) == 1
    found = onsets_s(decoded(log.audio(NAME, begin_ns, voice_until_ns(log))), SAMPLE_HZ)
    assert np.allclose(np.diff(found), 2.0, atol=DRIFT_MAX_S)
    assert len(found) >= 4


def test_unusable_source_is_reported(tmp_path: Path) -> None:
    channel = RadioChannel(
        NAME, RadioConfig("device:there-is-none"), tmp_path / NAME, SystemClock()
    )
    channel.start()
    try:
        until(lambda: "there-is-none ended: " in channel.problem, "the reason")
    finally:
        channel.close()
