"""Sources of audio: a sound device, a stream or a file, as pieces of PCM with the times they came.

They raise a ``SourceError`` whose text is for a person.  The programs and libraries here
may hang: this is run in a process that can be ended.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import time
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, replace
from threading import Thread
from typing import IO

import av

from base_station.radio.config import DEVICE, FILE, RadioConfig
from base_station.radio.encoder import BYTES_PER_SAMPLE
from base_station.radio.opus import SAMPLE_HZ
from shared.clock import NS_PER_S
from shared.coded_text import coded
from shared.errors import MusterError

BYTES_PER_S = SAMPLE_HZ * BYTES_PER_SAMPLE
_PERIOD_US = 20_000
_OPEN_S, _READ_S = 10.0, 5.0
_MOST_AHEAD_S = 20.0  # servers give some seconds at once; a file they would give as a whole
_JUMP_NS = 2 * NS_PER_S  # between two pieces: the source's own time is another one
_DAMAGED_MAX = 100  # packets in succession
_PROTOCOLS = "http,https,tls,tcp,udp,rtp,rtsp,crypto"  # none that reads this machine's files


class SourceError(MusterError):
    """A source of audio cannot be read."""


@dataclass(frozen=True, slots=True)
class Sound:
    """A piece of audio."""

    pcm: bytes  # 16 bits, mono, 48 kHz
    start_s: float  # on the source's own time axis
    received_ns: int  # monotonic; its last sample was there


def sounds_of(config: RadioConfig) -> Iterator[Sound]:
    """Endless for a device and a file; a stream until it ends.  Raises SourceError."""
    if config.is_device:
        return _device_sounds(config.source.removeprefix(DEVICE))
    if config.is_file and not config.source.endswith(".sdp"):
        return _paced(_repeated(config.source.removeprefix(FILE)), ahead_s=0.0)
    protocols = f"file,{_PROTOCOLS}" if config.is_file else _PROTOCOLS
    url = config.source.removeprefix(FILE)
    return _paced(_stream_sounds(url, protocols), ahead_s=_MOST_AHEAD_S)


def _device_sounds(name: str) -> Iterator[Sound]:
    """Through ``arecord``: the system's ALSA knows the system's devices and plugins."""
    arecord = shutil.which("arecord")
    if arecord is None:
        raise SourceError(
            coded(
                "radio-arecord-missing",
                "arecord is not installed: install the package {package}",
                package="alsa-utils",
            )
        )
    command = (
        *(arecord, "-q", "-D", name, "-t", "raw", "-f", "S16_LE", "-r", str(SAMPLE_HZ), "-c", "1"),
        f"--period-time={_PERIOD_US}",
    )
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        words = _last_words(process.stderr)
        bytes_read, rest = 0, b""
        while block := os.read(process.stdout.fileno(), BYTES_PER_S):
            received_ns = time.monotonic_ns()
            block = rest + block
            whole = len(block) - len(block) % BYTES_PER_SAMPLE
            rest = block[whole:]
            if whole:
                yield Sound(block[:whole], bytes_read / BYTES_PER_S, received_ns)
            bytes_read += whole
        process.wait()
    raise SourceError(
        coded(
            "radio-device-ended",
            "the sound device {device} ended: {reason}",
            device=name,
            reason=" ".join(words) or coded("radio-no-reason", "it gives no reason"),
        )
    )


def _last_words(stderr: IO[bytes]) -> deque[str]:
    """The last line that a program has written, while it goes on."""
    last: deque[str] = deque(maxlen=1)

    def read() -> None:
        for line in stderr:
            last.append(line.decode(errors="replace").strip())

    Thread(target=read, name="arecord", daemon=True).start()
    return last


def _stream_sounds(url: str, protocols: str) -> Iterator[Sound]:
    options = {"protocol_whitelist": protocols, "probesize": "65536"}
    try:
        with av.open(url, timeout=(_OPEN_S, _READ_S), container_options=options) as container:
            if not container.streams.audio:
                raise SourceError(
                    coded("radio-no-audio", "it is opened, and there is no audio in it")
                )
            yield from _decoded(container)
    except av.FFmpegError as error:
        raise SourceError(
            coded(
                "radio-stream-unreadable",
                "the stream cannot be read: {error}",
                error=error.strerror or str(error),
            )
        ) from error


def _decoded(container: av.container.InputContainer) -> Iterator[Sound]:
    resampler = av.AudioResampler(format="s16", layout="mono", rate=SAMPLE_HZ)
    expected_s, damaged = 0.0, 0
    for packet in container.demux(container.streams.audio[0]):
        received_ns = time.monotonic_ns()
        try:
            frames = packet.decode()
        except av.InvalidDataError:
            damaged += 1
            if damaged > _DAMAGED_MAX:
                raise
            continue
        damaged = 0
        for given in frames:
            for frame in resampler.resample(given):
                start_s = expected_s if frame.time is None else frame.time
                pcm = bytes(frame.planes[0])[: frame.samples * BYTES_PER_SAMPLE]
                expected_s = start_s + frame.samples / SAMPLE_HZ
                yield Sound(pcm, start_s, received_ns)


def _repeated(path: str) -> Iterator[Sound]:
    """On one time axis over all rounds."""
    begin_s = end_s = 0.0
    while True:
        for sound in _stream_sounds(path, "file"):
            yield replace(sound, start_s=begin_s + sound.start_s)
            end_s = begin_s + sound.start_s + len(sound.pcm) / BYTES_PER_S
        if end_s == begin_s:
            raise SourceError(coded("radio-file-silent", "there is no audio in the file"))
        begin_s = end_s


def _paced(sounds: Iterator[Sound], ahead_s: float) -> Iterator[Sound]:
    """Not faster than it is played, but for the beginning."""
    first: Sound | None = None
    for sound in sounds:
        first = first or sound
        due_ns = first.received_ns + round((sound.start_s - first.start_s - ahead_s) * NS_PER_S)
        early_ns = due_ns - time.monotonic_ns()
        if early_ns > _JUMP_NS:
            first, early_ns = sound, 0
        if early_ns <= 0:
            yield sound
            continue
        time.sleep(early_ns / NS_PER_S)
        yield Sound(sound.pcm, sound.start_s, time.monotonic_ns())
