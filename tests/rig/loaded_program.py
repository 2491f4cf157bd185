"""``muster base`` and ``muster edge`` as copies of a process that has loaded them.

Tests start hundreds, and to load one takes a core three seconds.  The demo, the benches and the
tests of the start itself launch them as they are installed.
"""

from __future__ import annotations

import ctypes
import importlib
import io
import os
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path

from pwdlib import PasswordHash

from base_station.accounts import passwords
from shared.errors import MusterError
from tests.rig.lossy_link import Namespace, enter_network
from tests.rig.program import Program
from tests.rig.quick_hash import QUICK_HASH
from tests.rig.settable_clock import go_by_machine_clock

_LOADED = get_context("forkserver")
_LOADED.set_forkserver_preload(
    [
        __name__,
        *("base_station.cli", "base_station.app.live", "base_station.app.replay"),
        *("edge.cli", "edge.app.composition"),
    ]
)


@dataclass(frozen=True)
class Invocation:
    """Call that a copy executes."""

    package: str
    arguments: tuple[str, ...]
    output: Path
    environ: dict[str, str]
    stdin: str = ""
    before: str = ""  # statements that Python executes first
    network: str = ""  # file of the network namespace; empty: that of the tests
    by_the_modes: bool = False  # without root's right to write to whatever it likes
    quick_hash: bool = True  # of passwords


class LoadedProgram:
    """One such process, with the methods of ``subprocess.Popen``."""

    def __init__(self, invocation: Invocation) -> None:
        self._process = _LOADED.Process(target=_run, args=(invocation,), daemon=True)
        self._process.start()

    @property
    def pid(self) -> int:
        assert self._process.pid is not None
        return self._process.pid

    def poll(self) -> int | None:
        return self._process.exitcode

    def kill(self) -> None:
        self._process.kill()

    def send_signal(self, number: int, /) -> None:
        os.kill(self.pid, number)

    def wait(self, timeout: float | None = None) -> int:
        """Raises TimeoutError where it has not ended by then."""
        self._process.join(timeout)
        if self._process.exitcode is None:
            raise TimeoutError(f"process {self.pid} has not ended within {timeout} s")
        return self._process.exitcode


@dataclass(frozen=True)
class _LaunchLoaded:
    """As ``launch_installed``, without the time of loading."""

    quick_hash: bool

    def __call__(
        self,
        package: str,
        arguments: Sequence[str],
        output: Path,
        network: Namespace | None = None,
        before: str = "",
    ) -> Program:
        return LoadedProgram(
            Invocation(
                package,
                tuple(arguments),
                output,
                dict(os.environ),
                before=before,
                network="" if network is None else network.path,
                quick_hash=self.quick_hash,
            )
        )


launch_loaded = _LaunchLoaded(quick_hash=True)
launch_loaded_as_it_is = _LaunchLoaded(quick_hash=False)  # where floods of logins are to cost it


class _QuickHash(PasswordHash):
    @classmethod
    def recommended(cls) -> _QuickHash:
        return cls(QUICK_HASH.hashers)


def _run(invocation: Invocation) -> None:
    """As ``shared.command_line.main`` does it, without the entry points of an installed program."""
    if invocation.by_the_modes:
        _drop_file_capabilities()
    if invocation.network:
        enter_network(invocation.network)
    sys.stdin = io.StringIO(invocation.stdin)
    with invocation.output.open("ab") as written:
        os.dup2(written.fileno(), 1)
        os.dup2(written.fileno(), 2)
    os.environ.clear()
    os.environ.update(invocation.environ)
    go_by_machine_clock()
    if invocation.quick_hash:
        vars(passwords)["PasswordHash"] = _QuickHash
    exec(invocation.before, {})
    sys.argv = [invocation.package, *invocation.arguments]
    app: Callable[[], None] = importlib.import_module(f"{invocation.package}.cli").app
    try:
        app()
    except MusterError as error:
        print(error, file=sys.stderr)
        sys.exit(2)


def _drop_file_capabilities() -> None:
    """As a user to whom the modes of files apply."""
    libc = ctypes.CDLL(None, use_errno=True)
    head, words = (ctypes.c_uint32 * 2)(0x20080522, 0), (ctypes.c_uint32 * 6)()
    assert libc.capget(head, words) == 0
    words[0] &= ~0b110  # CAP_DAC_OVERRIDE and CAP_DAC_READ_SEARCH, of what is in effect
    assert libc.capset(head, words) == 0
