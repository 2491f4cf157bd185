"""Speech by ``espeak-ng``, played by ``aplay`` on the machine's sound card (ALSA).

espeak-ng could play by itself, but reports success where there is no sound card.
"""

from __future__ import annotations

import subprocess
from pathlib import Path
from threading import Event

from edge.notifiers.signals import Notice, sentence
from edge.notifiers.sound_card import last_line, play_wave, require_programs
from shared.coded_text import coded
from shared.errors import ConfigError

_SPEAKER = "espeak-ng"
_WORDS_PER_MINUTE = "150"  # slower than its own 175: there is noise
_PAUSE_S = 2.0  # before it is spoken again
_SYNTHESIS_S = 10.0
_CHARACTERS_MAX = 500


class SpeechNotifier:
    """Voice: ``en``, ``en-us`` and what else ``espeak-ng --voices=en`` lists."""

    def __init__(self, voice: str, _sysfs: Path) -> None:
        """Raises ConfigError where a program is missing, or does not know the voice."""
        require_programs("speech", _SPEAKER)
        self._voice = voice
        try:
            self._synthesize("")
        except OSError as error:
            raise ConfigError(
                f"{_SPEAKER} cannot speak as {voice!r} ({error}); `{_SPEAKER} --voices=en` lists "
                "the voices"
            ) from error

    def play(self, notice: Notice, interrupt: Event) -> None:
        play_wave(self._synthesize(sentence(notice)[:_CHARACTERS_MAX]), interrupt)
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
            raise OSError(coded("speech-hangs", "{speaker} hangs", speaker=_SPEAKER)) from error
        if made.returncode != 0:
            raise OSError(last_line(made.stderr))
        return made.stdout
