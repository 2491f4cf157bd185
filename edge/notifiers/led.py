"""Light of the kernel's LED class: ``/sys/class/leds/NAME``."""

from __future__ import annotations

from pathlib import Path
from threading import Event

from edge.notifiers.signals import PATTERNS, Notice
from edge.sources.sysfs import devices_in, read_number
from shared.errors import ConfigError

_OFF = 0


class LedNotifier:
    """Light that is on during each pulse, at full brightness."""

    def __init__(self, name: str, sysfs: Path) -> None:
        """Raises ConfigError where the machine has no such LED; it may be attached later."""
        if "/" in name or name in (".", ".."):
            raise ConfigError(f"led:{name} is no name of an LED; write one of {_names(sysfs)}")
        self._led = sysfs / "class" / "leds" / name
        if not self._led.exists():
            raise ConfigError(f"there is no LED {name}; this machine has {_names(sysfs)}")
        self._brightness: int | None = None  # of the light when it is on; None: not opened yet

    def play(self, notice: Notice, interrupt: Event) -> None:
        try:
            on = self._open()
            for pulse in PATTERNS[notice.signal]:
                self._set(on)
                if interrupt.wait(pulse.on_s):
                    break
                self._set(_OFF)
                if interrupt.wait(pulse.off_s):
                    break
            self._set(_OFF)
        except OSError:
            self._brightness = None  # one that is attached again is taken over again
            raise

    def close(self) -> None:
        if self._brightness is not None:
            self._set(_OFF)

    def _open(self) -> int:
        """Take the LED from whatever drives it; return its full brightness."""
        if self._brightness is None:
            (self._led / "trigger").write_text("none")
            self._brightness = int(read_number(self._led / "max_brightness") or 1)
        return self._brightness

    def _set(self, brightness: int) -> None:
        (self._led / "brightness").write_text(str(brightness))


def _names(sysfs: Path) -> str:
    names = [led.name for led in devices_in(sysfs / "class" / "leds")]
    return ", ".join(names) or "none"
