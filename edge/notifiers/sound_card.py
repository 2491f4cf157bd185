"""Playing of sound on the machine's sound card (ALSA), by the program ``aplay``.

``aplay`` reads the sound from memory, not from a pipe: a pipe holds less than a message takes, and
filling it would hold up an interrupt until most of it was played.
"""

from __future__ import annotations

import os
import shutil
import subprocess
from threading import Event

from shared.coded_text import coded
from shared.errors import ConfigError

DEFAULT_DEVICE = "default"
_PLAYER = "aplay"
_PACKAGES = {_PLAYER: "alsa-utils", "espeak-ng": "espeak-ng"}  # of Debian
_POLL_S = 0.05


def require_programs(purpose: str, *more: str) -> None:
    """Raise ConfigError where ``aplay`` or one of ``more`` is not installed."""
    for program in (*more, _PLAYER):
        if shutil.which(program) is None:
            raise ConfigError(
                f"{purpose} needs the program {program}: on Debian, apt-get install "
                f"{_PACKAGES[program]}"
            )


def play_wave(wave: bytes, interrupt: Event, device: str = DEFAULT_DEVICE) -> None:
    """Play a WAV file to its end, or until soon after ``interrupt`` is set.  Raises OSError."""
    with os.fdopen(os.memfd_create("sound"), "w+b") as sound:
        sound.write(wave)
        sound.seek(0)
        process = subprocess.Popen(
            [_PLAYER, "-q", "-D", device, "-"], stdin=sound, stderr=subprocess.PIPE
        )
    with process:
        assert process.stderr is not None
        while process.poll() is None:
            if interrupt.wait(_POLL_S):
                process.kill()
                return
        complaint = process.stderr.read()
    if process.returncode != 0:
        raise OSError(
            coded(
                "output-no-sound",
                "{player} plays nothing on {device}: {complaint}; `{player} -L` lists the devices",
                player=_PLAYER,
                device=device,
                complaint=last_line(complaint),
            )
        )


def last_line(text: bytes) -> str:
    """Return the last line that a program has written, for a person."""
    lines = text.decode(errors="replace").strip().splitlines()
    return lines[-1] if lines else "it says no more"
