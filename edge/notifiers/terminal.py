"""Lines on standard output, for a demonstration and for trying out."""

from __future__ import annotations

from pathlib import Path
from threading import Event

from edge.notifiers.signals import PATTERNS, Notice, sentence


class TerminalNotifier:
    """Prints each notice; it takes as long as its pattern does."""

    def __init__(self, title: str, _sysfs: Path) -> None:
        """``title``: stands before each line; may be empty."""
        self._prefix = f"{title}: " if title else ""

    def play(self, notice: Notice, interrupt: Event) -> None:
        print(f"{self._prefix}[{notice.signal}] {sentence(notice)}", flush=True)
        interrupt.wait(sum(pulse.on_s + pulse.off_s for pulse in PATTERNS[notice.signal]))

    def close(self) -> None:
        """Nothing to leave dark or silent."""
