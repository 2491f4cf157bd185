"""The demo run by a script, and ended by a person."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
from pathlib import Path

import psutil
import pytest

from tests.rig.station_process import free_port
from tests.rig.waiting import until


def start_demo(folder: Path, *arguments: str) -> subprocess.Popen[str]:
    ports = ("--http-port", str(free_port()), "--bus-port", str(free_port()))
    flags = ("--headless", "--data", str(folder), *ports, *arguments)
    return subprocess.Popen(
        [sys.executable, "-m", "shared.command_line", "demo", *flags],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


def processes_of(folder: Path) -> list[str]:
    """Command lines of what still runs on the demo's folder."""
    found = []
    for process in psutil.process_iter(["cmdline"]):
        words = process.info["cmdline"] or []
        if any(str(folder) in word for word in words):
            found.append(" ".join(words))
    return found


def test_demo_in_a_script_receives_five_units_and_leaves_no_process(tmp_path):
    demo = start_demo(tmp_path, "--for", "12")
    output, _ = demo.communicate(timeout=240)
    assert demo.returncode == 0, output
    received = re.search(r"(\d+) messages of 5 units, 0 of them not understood", output)
    assert received is not None, output
    assert int(received[1]) > 100
    assert "muster base replay" in output
    assert processes_of(tmp_path) == []


def test_demo_with_a_second_station_receives_five_units(tmp_path):
    """The one that leads has its first login only once it leads."""
    demo = start_demo(tmp_path, "--standby", "--for", "3")
    output, _ = demo.communicate(timeout=240)
    assert demo.returncode == 0, output
    assert "of 5 units, 0 of them not understood" in output
    assert processes_of(tmp_path) == []


def test_ctrl_c_ends_all_processes(tmp_path):
    demo = start_demo(tmp_path)
    assert demo.stdout is not None
    for line in demo.stdout:
        if "password" in line:
            break
    until(lambda: "FF-05" in str(processes_of(tmp_path)), "the last agent")
    demo.send_signal(signal.SIGINT)
    output, _ = demo.communicate(timeout=60)
    assert demo.returncode == 0, output
    assert "muster base replay" in output
    assert processes_of(tmp_path) == []


@pytest.mark.parametrize("word", ["Enrolling", "Starting"])
def test_ctrl_c_during_the_start_and_repeated_ends_the_demo(tmp_path, word):
    demo = start_demo(tmp_path)
    assert demo.stdout is not None
    while word not in demo.stdout.readline():
        assert demo.poll() is None
    until(lambda: len(processes_of(tmp_path)) > 1, "what it has started")
    for _ in range(3):
        demo.send_signal(signal.SIGINT)
    output, _ = demo.communicate(timeout=60)
    assert demo.returncode == 0, output
    assert "Ended before it had begun." in output
    assert "Traceback" not in output
    assert processes_of(tmp_path) == []
