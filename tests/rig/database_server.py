"""A real PostgreSQL server in a folder of its own, that can be killed and frozen: on a Unix socket,
and on this machine's loopback, there with a certificate where it has one.

It ends with the test, also where that is killed: its processes get SIGTERM when this one ends.
"""

from __future__ import annotations

import os
import pwd
import secrets
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path

import psutil
import pytest
from sqlalchemy import create_engine, text
from sqlalchemy.exc import OperationalError

from base_station.security.pki.certificates import Issued
from base_station.storage.db.server_address import SCHEME, ServerAddress
from tests.rig.station_process import free_port
from tests.rig.waiting import until

OWNER = "fire"
_FOLDERS = ("/usr/lib/postgresql/*/bin", "/usr/local/pgsql/bin", "/usr/bin")
# The server does not run as root: it gives up that right, and ends when its parent does.
_AS_OTHER = """
import ctypes, os, signal, sys
user, group, *command = sys.argv[1:]
if os.geteuid() == 0:
    os.setgroups([]), os.setgid(int(group)), os.setuid(int(user))
ctypes.CDLL(None).prctl(1, signal.SIGTERM)
os.execv(command[0], command)
"""


class DatabaseServer:
    def __init__(self, programs: Path, folder: Path) -> None:
        self._programs, self._folder = programs, folder
        self._data, self._password = folder / "data", secrets.token_hex(16)
        user = pwd.getpwnam("nobody") if os.geteuid() == 0 else pwd.getpwuid(os.geteuid())
        self._user, self._group = user.pw_uid, user.pw_gid
        self.port = free_port()
        self._running: subprocess.Popen[bytes] | None = None
        password = folder / "password"
        password.write_text(f"{self._password}\n")
        if os.geteuid() == 0:
            for path in (folder, password):
                os.chown(path, self._user, self._group)
        make = ("--username", OWNER, "--pwfile", str(password), "--auth", "scram-sha-256")
        options = ("--no-sync", "--encoding", "UTF8", "--locale", "C.UTF-8")
        self._program("initdb", "-D", str(self._data), *make, *options).wait(120)

    def start(self, certificate: Issued | None = None) -> None:
        """Takes connections when this returns.  ``certificate``: for TLS, on the loopback."""
        settings = {
            **self._tls_settings(certificate),
            "listen_addresses": "127.0.0.1",
            "port": str(self.port),
            "unix_socket_directories": str(self._folder),
            "max_connections": "60",
            "shared_buffers": "16MB",
            "fsync": "off",  # only this machine's own power cut would lose what was committed
            "log_statement": "all",
        }
        options = [f"--{name}={value}" for name, value in settings.items()]
        self._running = self._program("postgres", "-D", str(self._data), *options)
        until(self._takes_connections)

    def stop(self) -> None:
        """At once; who is connected loses the connection."""
        if self._running is not None:
            self._running.send_signal(signal.SIGQUIT)
            self._running.wait(60)
            self._running = None

    def kill(self) -> None:
        """As a power cut ends it."""
        assert self._running is not None
        children = psutil.Process(self._running.pid).children(recursive=True)
        for process in (psutil.Process(self._running.pid), *children):
            process.kill()
        psutil.wait_procs(children, timeout=60)
        self._running.wait(60)
        self._running = None
        (self._data / "postmaster.pid").unlink(missing_ok=True)

    @contextmanager
    def frozen(self) -> Iterator[None]:
        """It takes connections and does not answer."""
        assert self._running is not None
        main = psutil.Process(self._running.pid)
        processes = [main, *main.children(recursive=True)]
        for process in processes:
            process.suspend()
        try:
            yield
        finally:
            for process in processes:
                process.resume()

    def new_database(self, folder: Path, user: str = OWNER) -> ServerAddress:
        """An empty one, with a file of its password in ``folder``."""
        name = f"station_{secrets.token_hex(4)}"
        self.execute(f"CREATE DATABASE {name}")
        password = folder / f"{name}.password"
        password.write_text(f"{self._password}\n")
        password.chmod(0o600)
        return ServerAddress(self.url(name, user), str(password))

    def url(self, name: str, user: str = OWNER) -> str:
        return f"{SCHEME}://{user}@/{name}?host={self._folder}&port={self.port}"

    def execute(self, statement: str, database: str = "postgres") -> None:
        """As the administrator, outside of a transaction."""
        engine = create_engine(self.url(database), connect_args={"password": self._password})
        try:
            with engine.execution_options(isolation_level="AUTOCOMMIT").connect() as connection:
                connection.execute(text(statement))
        finally:
            engine.dispose()

    @property
    def password(self) -> str:
        return self._password

    @property
    def printed(self) -> str:
        """Log of the server, with every statement."""
        return (self._folder / "postgres.txt").read_text(errors="replace")

    def _tls_settings(self, certificate: Issued | None) -> dict[str, str]:
        if certificate is None:
            return {}
        files = {
            "ssl_cert_file": self._folder / "server.pem",
            "ssl_key_file": self._folder / "server.key",
        }
        contents = (certificate.certificate_pem(), certificate.key_pem())
        for path, content in zip(files.values(), contents, strict=True):
            path.write_bytes(content)
            path.chmod(0o600)  # the server refuses a key that others may read
            if os.geteuid() == 0:
                os.chown(path, self._user, self._group)
        named = {name: str(path) for name, path in files.items()}
        return {"ssl": "on", **named}

    def _takes_connections(self) -> bool:
        try:
            self.execute("SELECT 1")
        except OperationalError:
            return False
        return True

    def _program(self, name: str, *arguments: str) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-c", _AS_OTHER, str(self._user), str(self._group)]
        with (self._folder / f"{name}.txt").open("ab") as output:
            return subprocess.Popen(
                [*command, str(self._programs / name), *arguments],
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=output,
                cwd="/",
            )


@contextmanager
def database_server() -> Iterator[DatabaseServer]:
    """One that runs; skips where PostgreSQL is not installed."""
    programs = _programs()
    if programs is None:
        pytest.skip("no PostgreSQL server is installed: apt-get install postgresql")
    folder = Path(tempfile.mkdtemp(prefix="muster-pg-"))  # short: a socket's path has a limit
    try:
        server = DatabaseServer(programs, folder)
        server.start()
        try:
            yield server
        finally:
            server.stop()
    finally:
        shutil.rmtree(folder, ignore_errors=True)


@cache
def _programs() -> Path | None:
    """The newest version's folder."""
    for pattern in _FOLDERS:
        found = sorted(Path("/").glob(f"{pattern[1:]}/initdb"), key=_version_of)
        if found and (found[-1].parent / "postgres").exists():
            return found[-1].parent
    return None


def _version_of(program: Path) -> int:
    number = program.parent.parent.name
    return int(number) if number.isdecimal() else 0
