"""First process of a container: health, signals, exit codes and secrets, with real processes."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import pytest

from deploy.container import health
from tests.conftest import PROJECT_ROOT
from tests.rig.waiting import until

pytestmark = pytest.mark.slow

# As Muster does it: ready, then it works; SIGTERM ends it in order, and a line on its input stops
# the notifications.
SERVICE = """
import os, signal, sys, threading
from shared.service_manager import ServiceManager
manager, end = ServiceManager(os.environ), threading.Event()
signal.signal(signal.SIGTERM, lambda *_: end.set())
threading.Thread(target=lambda: (sys.stdin.readline(), hang.set()), daemon=True).start()
hang = threading.Event()
manager.working()
print("begun", flush=True)
if "starts" not in sys.argv:
    manager.ready()
while not end.wait(0.1):
    if not hang.is_set() and "starts" not in sys.argv:
        manager.working()
print("closed", flush=True)
sys.exit(7)
"""


@contextmanager
def supervised(
    folder: Path,
    *command: str,
    watchdog_s: float = 600.0,
    environment: Mapping[str, str] | None = None,
) -> Iterator[subprocess.Popen[str]]:
    supervisor = [sys.executable, "-m", "deploy.container.supervisor", "--watchdog-s"]
    with subprocess.Popen(
        [*supervisor, str(watchdog_s), *command],
        cwd=PROJECT_ROOT,
        env={**os.environ, "TMPDIR": str(folder), **(environment or {})},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as running:
        try:
            yield running
        finally:
            running.kill()


def test_service_is_healthy_from_ready_to_its_end_in_order(tmp_path: Path) -> None:
    with supervised(tmp_path, sys.executable, "-c", SERVICE) as running:
        until(lambda: not health.fault(tmp_path / "muster"), "the service is healthy")
        running.send_signal(signal.SIGTERM)
        output, _ = running.communicate(timeout=120)
    assert output.splitlines() == ["begun", "closed"]
    assert running.returncode == 7


def test_starting_service_is_not_healthy_yet(tmp_path: Path) -> None:
    with supervised(tmp_path, sys.executable, "-c", SERVICE, "starts", watchdog_s=0.2) as running:
        assert running.stdout is not None
        assert running.stdout.readline() == "begun\n"
        assert "starting" in health.fault(tmp_path / "muster")
        running.send_signal(signal.SIGTERM)  # and the watchdog does not count yet
        assert running.wait(timeout=120) == 7


def test_hanging_service_is_killed_and_named(tmp_path: Path) -> None:
    with supervised(tmp_path, sys.executable, "-c", SERVICE, watchdog_s=3.0) as running:
        until(lambda: not health.fault(tmp_path / "muster"), "the service is healthy")
        _, error = running.communicate("hang\n", timeout=120)
    assert running.returncode == 128 + signal.SIGKILL
    assert "the program hangs" in error


def test_silence_is_named_by_the_health_check(tmp_path: Path, monkeypatch) -> None:
    (tmp_path / "working").write_text("1000.0")
    monkeypatch.setattr("time.monotonic", lambda: 1000.0 + health.SILENT_S)
    assert health.fault(tmp_path) == ""
    monkeypatch.setattr("time.monotonic", lambda: 1020.0)
    assert health.fault(tmp_path) == "it hangs: nothing came from it for 20 s"


def test_command_passes_its_output_and_its_exit_code(tmp_path: Path) -> None:
    with supervised(tmp_path, "sh", "-c", "echo done; exit 3") as running:
        output, error = running.communicate(timeout=120)
    assert (output, error, running.returncode) == ("done\n", "", 3)


def test_secrets_come_from_files_and_a_missing_one_is_named(tmp_path: Path) -> None:
    (tmp_path / "key").write_text("generated\n")
    show = ("sh", "-c", "echo $AWS_SECRET_ACCESS_KEY")
    files = {"AWS_SECRET_ACCESS_KEY_FILE": str(tmp_path / "key")}
    with supervised(tmp_path, *show, environment=files) as running:
        assert running.communicate(timeout=120)[0] == "generated\n"
    missing = {"AWS_ACCESS_KEY_ID_FILE": "/missing/key"}
    with supervised(tmp_path, *show, environment=missing) as running:
        _, error = running.communicate(timeout=120)
    assert running.returncode == 1
    assert "/missing/key" in error


def test_secrets_of_the_engine_are_copied_to_where_one_user_reads_them(tmp_path: Path) -> None:
    given, show = tmp_path / "given", 'stat -c "%a %n" * && cat password'
    (given / "folder").mkdir(parents=True)
    (given / "password").write_text("generated\n")
    (given / "password").chmod(0o444)
    copies = tmp_path / "muster" / "secrets"
    with supervised(
        tmp_path, "--secrets", str(given), "sh", "-c", f"cd {copies} && {show}"
    ) as running:
        output, error = running.communicate(timeout=120)
    assert (output, error) == ("600 password\ngenerated\n", "")


def test_missing_program_is_named(tmp_path: Path) -> None:
    with supervised(tmp_path, "no-such-program") as running:
        _, error = running.communicate(timeout=120)
    assert running.returncode == 1
    assert "no-such-program" in error
