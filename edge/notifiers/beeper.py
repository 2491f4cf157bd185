"""Beeper of the kernel's input class, such as that of ``pwm-beeper`` or ``gpio-beeper``.

A tone is an input event (EV_SND, SND_TONE, frequency in Hz) that is written to the device; 0 Hz is
silence.  Layout: ``struct input_event`` of ``linux/input.h``.
"""

from __future__ import annotations

import os
import struct
from pathlib import Path
from threading import Event

from edge.notifiers.signals import PATTERNS, Notice
from shared.errors import ConfigError

_INPUT_EVENT = struct.Struct("llHHi")  # seconds, microseconds, type, code, value
_EV_SND, _SND_TONE = 0x12, 0x02
_SILENCE_HZ = 0


class BeeperNotifier:
    """Beeper at a path, which is opened for each notice: it may be attached later."""

    def __init__(self, path: str, _sysfs: Path) -> None:
        """Raises ConfigError where it is no path of a device."""
        if not path.startswith("/"):
            raise ConfigError(
                f"beeper:{path} is no path; write that of the input device, as in "
                "beeper:/dev/input/by-path/platform-beeper-event"
            )
        self._path = path

    def play(self, notice: Notice, interrupt: Event) -> None:
        descriptor = os.open(self._path, os.O_WRONLY | os.O_CLOEXEC)
        try:
            for pulse in PATTERNS[notice.signal]:
                _write_tone(descriptor, pulse.tone_hz)
                if interrupt.wait(pulse.on_s):
                    return
                _write_tone(descriptor, _SILENCE_HZ)
                if interrupt.wait(pulse.off_s):
                    return
        finally:
            try:
                _write_tone(descriptor, _SILENCE_HZ)
            finally:
                os.close(descriptor)

    def close(self) -> None:
        """Nothing is held open between notices."""


def _write_tone(descriptor: int, tone_hz: int) -> None:
    os.write(descriptor, _INPUT_EVENT.pack(0, 0, _EV_SND, _SND_TONE, tone_hz))
