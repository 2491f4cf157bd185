"""The demo's child processes: started with their output in a file, watched, ended in order."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from threading import Event
from typing import Self

from shared.errors import UserError

_PATIENCE_S = 10.0
_POLL_INTERVAL_S = 0.05


@dataclass(frozen=True, slots=True)
class Child:
    """One running ``muster`` command."""

    name: str
    process: subprocess.Popen[bytes]
    output_path: Path

    @property
    def exit_code(self) -> int | None:
        """None while it runs."""
        return self.process.poll()

    def last_words(self) -> str:
        """The end of what it printed, for an error message."""
        return self.output_path.read_text(errors="replace").strip()[-2000:]


class EndRequestedError(Exception):
    """A person wants the demo to end, which has not begun yet."""


class Children:
    """Starts commands and, as a context manager, ends them all, the last started first."""

    def __init__(self, output_folder: Path, stop: Event) -> None:
        """Once ``stop`` is set nothing is started or waited for: EndRequestedError."""
        output_folder.mkdir(parents=True, exist_ok=True)
        self._output_folder = output_folder
        self._stop = stop
        self._children: list[Child] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        for child in reversed(self._children):
            if child.exit_code is None:
                child.process.send_signal(signal.SIGTERM)
        deadline = time.monotonic() + _PATIENCE_S
        for child in reversed(self._children):
            try:
                child.process.wait(max(0.1, deadline - time.monotonic()))
            except subprocess.TimeoutExpired:
                child.process.kill()
                child.process.wait()

    def start(self, name: str, arguments: Sequence[str]) -> Child:
        """Start ``muster ARGUMENTS`` in a process of its own."""
        self.wait(0.0)
        output_path = self._output_folder / f"{name}.txt"
        with output_path.open("wb") as output:
            process = subprocess.Popen(
                [sys.executable, "-m", "shared.command_line", *arguments],
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                # A Ctrl-C in the terminal reaches the demo alone, which then ends them in order.
                start_new_session=True,
            )
        child = Child(name, process, output_path)
        self._children.append(child)
        return child

    def run(self, name: str, arguments: Sequence[str]) -> bytes:
        """Run ``muster ARGUMENTS`` to its end; what it printed.  UserError where it fails."""
        child = self.start(name, arguments)
        while child.exit_code is None:
            self.wait(_POLL_INTERVAL_S)
        self._children.remove(child)
        if child.exit_code != 0:
            raise UserError(f"`muster {' '.join(arguments)}` failed:\n{child.last_words()}")
        return child.output_path.read_bytes()

    def wait(self, duration_s: float) -> None:
        if self._stop.wait(duration_s):
            raise EndRequestedError

    def wait_for_line(self, child: Child, beginning: str, patience_s: float) -> str:
        """The first line of its output with this beginning; UserError if it does not come."""
        deadline = time.monotonic() + patience_s
        while time.monotonic() < deadline:
            for line in child.output_path.read_text(errors="replace").splitlines():
                if line.startswith(beginning):
                    return line
            if child.exit_code is not None:
                raise UserError(f"{child.name} ended before it was ready:\n{child.last_words()}")
            self.wait(_POLL_INTERVAL_S)
        raise UserError(
            f"{child.name} was not ready within {patience_s:g} s; it printed:\n{child.last_words()}"
        )

    def dead(self) -> tuple[Child, ...]:
        """Those that ended although nobody asked them to."""
        return tuple(child for child in self._children if child.exit_code is not None)
