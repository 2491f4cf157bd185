"""Notifications of a station and of an agent to systemd, as processes."""

from __future__ import annotations

import socket
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.rig.station_command import Agent, Command
from tests.rig.waiting import PATIENCE_S


@pytest.fixture
def received(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[], str]]:
    """Gives what was said next; the socket is in the environment of what is started."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as listening:
        listening.bind(str(tmp_path / "notify"))
        listening.settimeout(PATIENCE_S)
        monkeypatch.setenv("NOTIFY_SOCKET", str(tmp_path / "notify"))
        yield lambda: listening.recv(100).decode("ascii")


def test_station_notifies_ready_and_watchdog(
    received: Callable[[], str], serve: Callable[..., Command]
) -> None:
    station = serve()
    stated = {received()}
    while "READY=1" not in stated:
        stated.add(received())
    station.wait_ready()
    assert [received() for _ in range(3)] == ["WATCHDOG=1"] * 3
    assert station.stop() == 0


@pytest.mark.parametrize("source", ["simulated:straight", "ximu3:tcp://127.0.0.1:9"])
def test_agent_notifies_ready_after_its_tracker_has_run_or_without_samples(
    received: Callable[[], str], tmp_path: Path, source: str
) -> None:
    """Until then it has all the time that it takes to compile the tracker."""
    flags = ("--unit", "FF-01", "--source", source, "--data", str(tmp_path))
    with Agent(tmp_path / "output.txt", *flags) as agent:
        before_ready = list(iter(received, "READY=1"))
        assert len(before_ready) > 1
        assert {*before_ready, received(), received()} == {"WATCHDOG=1"}
        assert agent.stop() == 0
