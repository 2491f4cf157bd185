"""A real TAK server (taky) as a process, and a TAK client that keeps every event it is sent.

The server is installed into a folder of its own when a test first wants it: its package brings a
top-level ``tests`` of its own, which would hide ours.
"""

from __future__ import annotations

import fcntl
import hashlib
import os
import socket
import ssl
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import ExitStack, suppress
from datetime import UTC, datetime, timedelta
from pathlib import Path
from threading import Thread
from typing import NamedTuple, Self
from xml.etree import ElementTree as ET

from defusedxml.ElementTree import fromstring

from base_station.security.pki.certificates import Issued, issue, make_authority
from shared.enrolment import Holder
from tests.rig.program import end_hard
from tests.rig.station_process import free_port
from tests.rig.waiting import PATIENCE_S, until

_END = b"</event>"
_LOCK = Path(__file__).with_name("taky.lock")
_START = "from taky.cot.__main__ import main; main()"
_YEAR = timedelta(days=365)


class ReceivedEvent(NamedTuple):
    """Event and the machine's time at which it came."""

    event: ET.Element
    raw: bytes
    t_ns: int

    @property
    def uid(self) -> str:
        return self.event.get("uid", "")

    @property
    def kind(self) -> str:
        return self.event.get("type", "")


class TakCertificates:
    """Authority of a TAK server, with the server's and a client's certificates as files."""

    def __init__(self, folder: Path, host: str = "127.0.0.1") -> None:
        now = datetime.now(UTC)
        authority = make_authority("Test TAK", now, _YEAR)
        self.ca, self.ca_key = _write(folder, "ca", authority)
        valid = _YEAR / 2
        server = issue(authority, host, Holder.STATION, now, valid, (host,))
        self.server, self.server_key = _write(folder, "server", server)
        client = issue(authority, "muster", Holder.UNIT, now, valid)
        self.client, self.client_key = _write(folder, "client", client)


def _write(folder: Path, name: str, issued: Issued) -> tuple[Path, Path]:
    certificate, key = folder / f"{name}.pem", folder / f"{name}.key"
    certificate.write_bytes(issued.certificate_pem())
    key.write_bytes(issued.key_pem())
    return certificate, key


def installed_taky() -> Path:
    """Folder with the server's packages, as ``taky.lock`` pins them."""
    version = hashlib.sha256(_LOCK.read_bytes()).hexdigest()[:12]
    folder = Path(sys.prefix) / f"taky-{version}"
    with (Path(sys.prefix) / "taky.installing").open("w") as installing:
        fcntl.flock(installing, fcntl.LOCK_EX)  # tests run side by side
        if not folder.exists():
            part = folder.with_suffix(".part")
            pip = [sys.executable, "-m", "pip", "install", "--quiet", "--require-hashes"]
            subprocess.run([*pip, "--target", part, "-r", _LOCK], check=True)
            part.rename(folder)
    return folder


class TakServer:
    """taky on a port of this machine; it can be stopped and started again."""

    def __init__(self, folder: Path, certificates: TakCertificates | None = None) -> None:
        self._folder = folder
        folder.mkdir(parents=True, exist_ok=True)
        self._certificates = certificates
        self.port = free_port()
        self._write_settings()
        self._process: subprocess.Popen[bytes] | None = None

    @property
    def url(self) -> str:
        return f"{'tcp' if self._certificates is None else 'tls'}://127.0.0.1:{self.port}"

    def _write_settings(self) -> None:
        lines = [
            "[taky]", "bind_ip = 127.0.0.1", f"root_dir = {self._folder}",
            "[cot_server]", f"port = {self.port}",
        ]  # fmt: skip
        if self._certificates is not None:
            made = self._certificates
            lines += [
                "[ssl]", "enabled = true", "client_cert_required = true",
                f"ca = {made.ca}", f"ca_key = {made.ca_key}",
                f"cert = {made.server}", f"key = {made.server_key}",
                f"cert_db = {self._folder / 'cert-db.txt'}",
            ]  # fmt: skip
            (self._folder / "cert-db.txt").touch()
        (self._folder / "taky.conf").write_text("\n".join(lines))

    def __enter__(self) -> Self:
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.kill()

    def start(self) -> None:
        with (self._folder / "taky.log").open("ab") as log:
            self._process = subprocess.Popen(
                [sys.executable, "-W", "ignore", "-c", _START, "-c", self._folder / "taky.conf"],
                stdout=log,
                stderr=log,
                env={**os.environ, "PYTHONUNBUFFERED": "1", "PYTHONPATH": str(installed_taky())},
            )
        until(self._listens, "the TAK server listens")

    def _listens(self) -> bool:
        assert self._process is not None
        assert self._process.poll() is None, (self._folder / "taky.log").read_text()
        with socket.socket() as probe:
            return probe.connect_ex(("127.0.0.1", self.port)) == 0

    @property
    def process(self) -> subprocess.Popen[bytes]:
        assert self._process is not None
        return self._process

    def kill(self) -> None:
        if self._process is not None:
            end_hard(self._process)
            self._process.wait(PATIENCE_S)
            (self._folder / "taky-mgmt.sock").unlink(missing_ok=True)
            self._process = None


class TakClient:
    """A TAK client: ``events`` is what it was sent, oldest first."""

    def __init__(self, port: int, certificates: TakCertificates | None = None) -> None:
        self.events: list[ReceivedEvent] = []
        self._closing = ExitStack()
        connected = self._closing.enter_context(
            socket.create_connection(("127.0.0.1", port), timeout=PATIENCE_S)
        )
        if certificates is not None:
            context = ssl.create_default_context(cafile=str(certificates.ca))
            context.load_cert_chain(certificates.client, certificates.client_key)
            connected = self._closing.enter_context(
                context.wrap_socket(connected, server_hostname="127.0.0.1")
            )
        connected.settimeout(None)
        self._socket = connected
        self._thread = Thread(target=self._listen, daemon=True)
        self._thread.start()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        with suppress(OSError):  # the server was first
            self._socket.shutdown(socket.SHUT_RDWR)
        self._thread.join()
        self._closing.close()

    def send(self, event: bytes) -> None:
        self._socket.sendall(event)

    def _listen(self) -> None:
        buffer = b""
        while True:
            try:
                data = self._socket.recv(1 << 16)
            except OSError:
                return
            if not data:
                return
            t_ns = time.time_ns()
            *events, buffer = (buffer + data).split(_END)
            for one in events:
                raw = one + _END
                self.events.append(ReceivedEvent(fromstring(raw), raw, t_ns))

    def latest(self, uid: str) -> ReceivedEvent | None:
        return next((one for one in reversed(self.events) if one.uid == uid), None)

    def wait_for(self, wanted: Callable[[ReceivedEvent], bool], what: str) -> ReceivedEvent:
        """The newest event of that kind, once there is one."""
        until(lambda: any(map(wanted, list(self.events))), what)
        return next(one for one in reversed(list(self.events)) if wanted(one))
