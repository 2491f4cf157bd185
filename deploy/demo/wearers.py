"""Wearers of the demo: they press the buttons of their panels, and their panels show what they see
and hear.
"""

from __future__ import annotations

import re
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from shutil import rmtree
from tempfile import mkdtemp
from threading import Thread

from deploy.demo.crew import Responder
from deploy.demo.panel_button import PanelButton

# What a wearer does with the button: pressed and released for so many seconds.
_GESTURES = {"mayday": (3.4,), "ok": (0.2,), "cancel": (0.2, 0.2, 0.2)}
_REACTION_S = 3.0
_SHOWN = re.compile(r"\[(?P<signal>[^\]]+)\] ")  # as an output `terminal:` prints a notice

HELP = "Press a wearer's button: FF-01 mayday (held), FF-01 ok (short), FF-01 cancel (twice)."


class Wearer:
    """One responder with a panel: a button, and a terminal as output."""

    def __init__(self, responder: Responder, folder: Path, output: Path) -> None:
        """``output``: file to which the agent prints."""
        self.responder = responder
        self._socket = folder / responder.unit
        self._button = PanelButton(self._socket)
        self._output = output
        self._read_bytes = 0
        self._has_called = False

    @property
    def flags(self) -> Sequence[str]:
        """Options of ``muster edge run``."""
        button, output = f"socket:{self._socket}", f"terminal:{self.responder.unit}"
        return ("--button", button, "--output", output)

    def press(self, gesture: str, after_s: float = 0.0) -> None:
        """Begin a gesture; it takes its time in a thread of its own."""
        Thread(target=self._press, args=(_GESTURES[gesture], after_s), daemon=True).start()

    def step(self, elapsed_s: float) -> Iterator[str]:
        """Let the wearer react; yield what the panel has shown since the last call."""
        for line in self._new_lines():
            if line.startswith(f"{self.responder.unit}: ["):
                yield line
                found = _SHOWN.search(line)
                if found is not None and found["signal"] in self.responder.reacts_to:
                    self.press("ok", _REACTION_S)
        at_s = self.responder.mayday_at_s
        if at_s is not None and elapsed_s >= at_s and not self._has_called:
            self._has_called = True
            self.press("mayday")

    def close(self) -> None:
        self._button.unplug()

    def _press(self, gesture: Sequence[float], after_s: float) -> None:
        time.sleep(after_s)
        for number, duration_s in enumerate(gesture):
            (self._button.press if number % 2 == 0 else self._button.release)()
            time.sleep(duration_s)
        self._button.release()

    def _new_lines(self) -> Iterator[str]:
        """Yield the lines that the agent has ended since the last call."""
        if not self._output.exists():
            return
        with self._output.open("rb") as file:
            file.seek(self._read_bytes)
            *lines, _ = file.read().split(b"\n")
        self._read_bytes += sum(len(line) + 1 for line in lines)
        for line in lines:
            yield line.decode(errors="replace")


class Wearers:
    """All wearers; a context manager.  ``listen``: to a person who types at the terminal."""

    def __init__(self, crew: Sequence[Responder], output: Path) -> None:
        self._folder = Path(mkdtemp(prefix="muster-"))  # the path of a socket is short
        self._wearers = {
            one.unit: Wearer(one, self._folder, output / f"{one.unit}.txt") for one in crew
        }

    def __enter__(self) -> Wearers:
        return self

    def __exit__(self, *_: object) -> None:
        for wearer in self._wearers.values():
            wearer.close()
        rmtree(self._folder, ignore_errors=True)

    def flags(self, unit: str) -> Sequence[str]:
        return self._wearers[unit].flags

    def step(self, elapsed_s: float) -> list[str]:
        """Return what the panels have shown since the last call."""
        return [line for wearer in self._wearers.values() for line in wearer.step(elapsed_s)]

    def listen(self, show: Callable[[str], None]) -> None:
        """Press buttons as a person types it, until the end of standard input."""
        Thread(target=self._listen, args=(show,), daemon=True).start()

    def _listen(self, show: Callable[[str], None]) -> None:
        for line in sys.stdin:
            if not self.obey(line):
                show(HELP)

    def obey(self, line: str) -> bool:
        """Press as typed; return False where it names no unit or no gesture."""
        unit, _, gesture = line.strip().partition(" ")
        wearer = self._wearers.get(unit.upper())
        if wearer is None or gesture.strip().lower() not in _GESTURES:
            return False
        wearer.press(gesture.strip().lower())
        return True
