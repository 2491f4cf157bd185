"""``muster base`` and ``muster edge`` as processes, started as they are installed."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Protocol

from tests.rig.lossy_link import Namespace


class Program(Protocol):
    """A process, with the methods of ``subprocess.Popen``."""

    @property
    def pid(self) -> int: ...

    def poll(self) -> int | None: ...
    def kill(self) -> None: ...
    def send_signal(self, number: int, /) -> None: ...
    def wait(self, timeout: float | None = None) -> int: ...


class Launch(Protocol):
    """Starts a program; its output is appended to a file."""

    def __call__(
        self,
        package: str,
        arguments: Sequence[str],
        output: Path,
        network: Namespace | None = None,
        before: str = "",
    ) -> Program:
        """``before``: statements that Python executes first."""


def launch_installed(
    package: str,
    arguments: Sequence[str],
    output: Path,
    network: Namespace | None = None,
    before: str = "",
) -> Program:
    """In an interpreter of its own, which loads the whole program."""
    inside = () if network is None else network.inside()
    code = f"{before}\nfrom {package}.cli import app; app()"
    with output.open("ab") as written:
        return subprocess.Popen(
            [*inside, sys.executable, "-c", code, *arguments],
            stdin=subprocess.DEVNULL,
            stdout=written,
            stderr=written,
        )


def end_hard(program: Program) -> None:
    """At once, as a power cut does."""
    program.kill()
    program.wait()
