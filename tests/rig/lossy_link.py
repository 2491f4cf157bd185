"""Two network namespaces joined by a link that can be made as bad as wanted.

Namespaces and devices have no name in the system and live only as long as their processes,
which end with this one however it ends.  Nothing outside gets an address.
"""

from __future__ import annotations

import ctypes
import os
import secrets
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path
from typing import TypeVar

import msgspec

from shared.errors import BusError
from tests.rig.link_forwarder import Conditions, LinkConditions

T = TypeVar("T")

_NEW_NETWORK = 0x40000000  # CLONE_NEWNET
_END_S = 10.0
_NOT_ALLOWED = "no network namespaces or TUN devices here"

CLEAN = Conditions(delay_s=0.015)  # each way
DARK = Conditions(dark=True)


class Namespace:
    """A network of its own, with its own loopback and one address on the link."""

    def __init__(self, address: str, closing: ExitStack) -> None:
        """Raises BusError where this machine does not allow it."""
        self.address = address
        anchor = ["unshare", "--net", "sh", "-c", "echo ready; exec cat"]
        try:
            self.anchor = started(anchor, closing)
        except OSError as error:
            raise BusError(f"{_NOT_ALLOWED}: {error}") from error

    def inside(self) -> tuple[str, ...]:
        """Prefix of a command that runs in this namespace."""
        return ("nsenter", f"--net={self.path}")

    def join(self, device: str, peer: str) -> None:
        """Take the device in and put the address on it."""
        run("ip", "link", "set", device, "netns", str(self.anchor.pid))
        run(*self.inside(), "ip", "address", "add", self.address, "peer", peer, "dev", device)
        for name in ("lo", device):
            run(*self.inside(), "ip", "link", "set", name, "up")

    def call(self, work: Callable[[], T]) -> T:
        """The result of ``work``, done by a thread of this program that is in here."""
        with ThreadPoolExecutor(1, initializer=enter_network, initargs=(self.path,)) as pool:
            return pool.submit(work).result()

    @property
    def path(self) -> str:
        """The file by which it is entered."""
        return f"/proc/{self.anchor.pid}/ns/net"


def enter_network(path: str) -> None:
    """Puts this thread, and all that it starts, into the network of the file."""
    libc = ctypes.CDLL(None, use_errno=True)
    with Path(path).open("rb") as namespace:
        if libc.setns(namespace.fileno(), _NEW_NETWORK) != 0:
            number = ctypes.get_errno()
            raise OSError(number, f"cannot enter the namespace: {os.strerror(number)}")


class LossyLink:
    """``station`` and ``units`` are the two ends."""

    def __init__(
        self,
        seed: int,
        closing: ExitStack,
        station: Namespace | None = None,
        units: Namespace | None = None,
    ) -> None:
        """Ends that are not given are made.  Raises BusError where this machine does not allow
        it.
        """
        self.station = station or Namespace("10.77.0.1", closing)
        self.units = units or Namespace("10.77.0.2", closing)
        try:
            token = secrets.token_hex(4)  # a name has 15 characters at most
            devices = [f"mstr{token}{end}" for end in "su"]
            module = [sys.executable, "-m", "tests.rig.link_forwarder", str(seed), *devices]
            self._forwarder = started(module, closing)
            self.station.join(devices[0], self.units.address)
            self.units.join(devices[1], self.station.address)
        except OSError as error:
            raise BusError(f"{_NOT_ALLOWED}: {error}") from error
        self.set(CLEAN)

    def set(self, down: Conditions, up: Conditions | None = None) -> None:
        """``down`` from the station to the units, ``up`` the other way, the same if not given.
        Holds for all that is sent from now on.
        """
        reported = LinkConditions(there=down, back=down if up is None else up)
        assert self._forwarder.stdin is not None
        assert self._forwarder.stdout is not None
        self._forwarder.stdin.write(msgspec.json.encode(reported) + b"\n")
        self._forwarder.stdin.flush()
        if self._forwarder.stdout.readline() != b"set\n":
            raise BusError("the link between the namespaces has ended")


def started(command: list[str], closing: ExitStack) -> subprocess.Popen[bytes]:
    """Runs until its input is closed; raises OSError unless it says ``ready``."""
    process = subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    closing.callback(_end, process)
    assert process.stdout is not None
    assert process.stderr is not None
    if process.stdout.readline() != b"ready\n":
        raise OSError(process.stderr.read().decode(errors="replace").strip()[-500:])
    return process


def run(*command: str) -> None:
    """Raises OSError with what the command said where it fails."""
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise OSError(f"{' '.join(command)}: {done.stderr.strip()}")


def _end(process: subprocess.Popen[bytes]) -> None:
    for pipe in (process.stdin, process.stdout, process.stderr):
        if pipe is not None:
            pipe.close()
    process.wait(_END_S)
