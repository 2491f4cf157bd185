"""Speech by ``espeak-ng``, played by ``aplay`` on the machine's sound card (ALSA).

espeak-ng could play by itself, but reports success where there is no sound card.
"""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path
from threading import Event

from edge.notifiers.signals import Notice, sentence
from shared.errors import ConfigError

_SPEAKER, _PLAYER = "espeak-ng", "aplay"
_PACKAGES = {_SPEAKER: "espeak-ng", _PLAYER: "alsa-utils"}  # of Debian
_WORDS_PER_MINUTE = "150"  # slower than its own 175: there is noise
_POLL_S = 0.05
_PAUSE_S = 2.0  # before it is spoken again
_SYNTHESIS_S = 10.0
_CHARACTERS_MAX = 500


class SpeechNotifier:
    """Voice: ``en``, ``en-us`` and what else ``espeak-ng --voices=en`` lists."""

    def __init__(self, voice: str, _sysfs: Path) -> None:
        """Raises ConfigError where a program is missing, or does not know the voice."""
        for program, package in _PACKAGES.items():
            if shutil.which(program) is None:
                raise ConfigError(
                    f"speech needs the program {program}: on Debian, apt-get install {package}"
                )
        self._voice = voice
        try:
            self._synthesize("")
        except OSError as error:
            raise ConfigError(
                f"{_SPEAKER} cannot speak as {voice!r} ({error}); `{_SPEAKER} --voices=en` lists "
                "the voices"
            ) from error

    def play(self, notice: Notice, interrupt: Event) -> None:
        sound = self._synthesize(sentence(notice)[:_CHARACTERS_MAX])
        process = subprocess.Popen(
            [_PLAYER, "-q", "-"], stdin=subprocess.PIPE, stderr=subprocess.PIPE
        )
        with process:
            assert process.stdin is not None
            assert process.stderr is not None
            try:
                process.stdin.write(sound)
                process.stdin.close()
            except BrokenPipeError:
                pass  # it has ended: what it complains of is said below
            while process.poll() is None:
                if interrupt.wait(_POLL_S):
                    process.kill()
                    return
            complaint = process.stderr.read()
        if process.returncode != 0:
            raise OSError(f"{_PLAYER} plays nothing: {_last_line(complaint)}")
        interrupt.wait(_PAUSE_S)

    def close(self) -> None:
        """Nothing is held open between notices."""

    def _synthesize(self, spoken: str) -> bytes:
        """Return a WAV file.  Raises OSError."""
        command = [_SPEAKER, "-v", self._voice, "-s", _WORDS_PER_MINUTE, "--stdin", "--stdout"]
        try:
            made = subprocess.run(
                command,
                input=spoken.encode(),
                capture_output=True,
                timeout=_SYNTHESIS_S,
                check=False,
            )
        except subprocess.TimeoutExpired as error:
            raise OSError(f"{_SPEAKER} hangs") from error
        if made.returncode != 0:
            raise OSError(_last_line(made.stderr))
        return made.stdout


def _last_line(text: bytes) -> str:
    lines = text.decode(errors="replace").strip().splitlines()
    return lines[-1] if lines else "it says no more"
