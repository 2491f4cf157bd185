"""First process of a container: starts a program, passes signals on, and watches its health.

It does for a container what systemd does for a service (``deploy/systemd``).  The program notifies
it by the protocol of sd_notify(3) that it is ready, and then once a second that it works.  The last
notification is kept in a file, which ``deploy.container.health`` reads.  A program that hangs is
killed and the container ends; the restart policy of the engine starts it again.
"""

from __future__ import annotations

import argparse
import os
import signal
import socket
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from threading import Thread
from types import FrameType

# Secrets that a program takes from its environment.  They come in files, which `inspect` of an
# engine does not show: the variable NAME_FILE has the path.
SECRETS = ("AWS_ACCESS_KEY_ID", "AWS_SECRET_ACCESS_KEY")
_DATAGRAM_BYTES_MAX = 4096
_SIGNALLED = 128  # exit code of what a signal ended, as of a shell


def state_folder() -> Path:
    """In the memory of the container, and gone with it."""
    return Path(tempfile.gettempdir()) / "muster"


def main(arguments: Sequence[str]) -> int:
    """Run a program until it ends; gives the exit code of the container."""
    parser = argparse.ArgumentParser(description="Run a program as the first one of a container.")
    parser.add_argument(
        "--watchdog-s", type=float, required=True, help="kill it once it is silent for so long"
    )
    parser.add_argument(
        "--secrets", type=Path, default=Path("/run/secrets"), help="folder of the engine's secrets"
    )
    parser.add_argument("program")
    parser.add_argument("arguments", nargs=argparse.REMAINDER)
    options = parser.parse_args(arguments)
    try:
        notifications = Notifications(state_folder())
        copy_secrets(options.secrets, state_folder() / "secrets")
        environment = with_secrets(os.environ)
        supervisor = Supervisor(notifications, options.watchdog_s)
        return supervisor.run(
            [options.program, *options.arguments],
            {**environment, "NOTIFY_SOCKET": str(notifications.socket_path)},
        )
    except OSError as error:
        print(f"muster: the container cannot start: {error}", file=sys.stderr)
        return 1


def copy_secrets(given: Path, folder: Path) -> None:
    """Copy files that an engine gives to everybody in a container to where one user reads them.

    A station refuses to call a password secret that others may read.  Raises OSError.
    """
    folder.mkdir(mode=0o700, exist_ok=True)
    for path in given.iterdir() if given.is_dir() else ():
        if path.is_file():
            own = folder / path.name
            own.touch(mode=0o600)
            own.write_bytes(path.read_bytes())


def with_secrets(environment: Mapping[str, str]) -> dict[str, str]:
    """The environment with the content of secret files; raises OSError where one is missing."""
    found = dict(environment)
    for name in SECRETS:
        path = environment.get(f"{name}_FILE")
        if path is not None:
            found[name] = Path(path).read_text(encoding="utf-8").strip()
    return found


class Notifications:
    """Socket that the program notifies, and the file with the time of the last notification.

    ``state_folder`` is made where it is missing; raises OSError where that fails.
    """

    def __init__(self, folder: Path) -> None:
        folder.mkdir(mode=0o700, exist_ok=True)
        self.socket_path = folder / "notify"
        self._working = folder / "working"
        self._written = folder / "working.part"
        self.socket_path.unlink(missing_ok=True)
        self._working.unlink(missing_ok=True)
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM | socket.SOCK_CLOEXEC)
        self._socket.bind(str(self.socket_path))
        self._is_ready = False

    def wait(self, timeout_s: float | None) -> bool:
        """Wait for a notification, and write its time; False: none came."""
        self._socket.settimeout(timeout_s)
        try:
            received = self._socket.recv(_DATAGRAM_BYTES_MAX)
        except TimeoutError:
            return False
        self._is_ready = self._is_ready or b"READY=1" in received.split(b"\n")
        if self._is_ready:
            self._written.write_text(str(time.monotonic()), encoding="ascii")
            self._written.replace(self._working)
        return True

    @property
    def is_ready(self) -> bool:
        return self._is_ready


class Supervisor:
    """Runs one program; ``run`` it once, in the main thread."""

    def __init__(self, notifications: Notifications, watchdog_s: float) -> None:
        self._notifications = notifications
        self._watchdog_s = watchdog_s
        self._program_pid: int | None = None
        self._ends = False  # SIGTERM came before there was a program

    def run(self, command: Sequence[str], environment: Mapping[str, str]) -> int:
        """Gives the exit code.  Raises OSError where there is no such program."""
        signal.signal(signal.SIGTERM, self._on_end)
        signal.signal(signal.SIGINT, self._on_end)
        self._program_pid = os.posix_spawnp(command[0], list(command), environment)
        if self._ends:
            os.kill(self._program_pid, signal.SIGTERM)
        Thread(target=self._watch, name="watchdog", daemon=True).start()
        while True:  # also ends what lost its parent
            pid, status = os.wait()
            if pid == self._program_pid:
                code = os.waitstatus_to_exitcode(status)
                return code if code >= 0 else _SIGNALLED - code

    def _on_end(self, number: int, _frame: FrameType | None) -> None:
        """The program alone gets SIGTERM, and ends its own processes in their order."""
        if number == signal.SIGINT and os.isatty(sys.stdin.fileno()):
            return  # Ctrl-C: the terminal sends it to the program, too
        if self._program_pid is None:
            self._ends = True
        else:
            os.kill(self._program_pid, signal.SIGTERM)

    def _watch(self) -> None:
        """Kill the program where nothing comes for too long, once it was ready."""
        while self._notifications.wait(self._watchdog_s if self._notifications.is_ready else None):
            pass
        print(
            f"muster: the program hangs: nothing came from it for {self._watchdog_s:.0f} s; it is "
            "killed, and the container ends",
            file=sys.stderr,
            flush=True,
        )
        if self._program_pid is not None:
            os.kill(self._program_pid, signal.SIGKILL)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
