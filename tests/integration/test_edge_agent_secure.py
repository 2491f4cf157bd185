"""An enrolled agent over mutual TLS and access rules, and one that does not belong."""

from __future__ import annotations

import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from base_station.pki.access import access_control
from base_station.pki.folder import PkiFolder
from edge.warm_up import compile_trackers
from shared.bus_zenoh import ClientEndpoint, StationEndpoint, ZenohBus
from shared.channels import HEARTBEAT, POSITION, ROOT, alive_key

RUN = "from edge.cli import app; app(prog_name='edge')"


def wait_until(condition: Callable[[], object], what: str) -> None:
    end_s = time.monotonic() + 40.0
    while not condition():
        assert time.monotonic() < end_s, f"never came: {what}"
        time.sleep(0.02)


class Site:
    """A station with an authority of its own; u1 is enrolled."""

    def __init__(self, folder: Path, stack: ExitStack, port: int) -> None:
        address = f"tls/127.0.0.1:{port}"
        self.pki = PkiFolder(folder)
        self.pki.create("Test", hosts=[], connect=[address])
        self.enrolment = folder / "u1.toml"
        self.pki.enroll("u1").write(self.enrolment)
        self._address = address
        self._stack = stack
        self.positions: list[str] = []
        self.alive: list[bool] = []

    def open(self) -> None:
        identity = self.pki.station_identity()
        rules = access_control(self.pki.registry())
        router = ZenohBus(StationEndpoint((self._address,), identity, rules))
        self._stack.callback(router.close)
        self.bus = ZenohBus(ClientEndpoint((self._address,), identity))
        self._stack.callback(self.bus.close)
        self.bus.subscribe(POSITION.key("*"), lambda key, _: self.positions.append(key))
        self.bus.subscribe(HEARTBEAT.key("*"), lambda key, _: None)
        self.bus.watch_alive(alive_key("*"), lambda _, alive: self.alive.append(alive))


@pytest.fixture(scope="module", autouse=True)
def compiled() -> None:
    """So that no agent spends its first minute compiling."""
    compile_trackers()


@pytest.fixture
def port() -> int:
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return int(found.getsockname()[1])


@pytest.fixture
def site(tmp_path: Path, port: int) -> Iterator[Site]:
    with ExitStack() as stack:
        (tmp_path / "station").mkdir()
        yield Site(tmp_path / "station", stack, port)


class Agent:
    """An agent as a process; what it says is read as it comes."""

    def __init__(self, *flags: str) -> None:
        command = [sys.executable, "-c", RUN, "run", "--source", "simulated:straight", *flags]
        self.process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        self.said = ""
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def _read(self) -> None:
        assert self.process.stderr is not None
        for line in self.process.stderr:
            self.said += line

    def end(self) -> int:
        self.process.terminate()
        try:
            code = self.process.wait(30)
        except subprocess.TimeoutExpired:
            self.process.kill()
            code = self.process.wait()
        self._reader.join()
        assert self.process.stderr is not None
        self.process.stderr.close()
        return code


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Callable[..., Agent]]:
    agents: list[Agent] = []

    def start_agent(*flags: str) -> Agent:
        agents.append(Agent("--data", str(tmp_path / "units"), *flags))
        return agents[-1]

    yield start_agent
    for agent in agents:
        agent.end()
        print(agent.said)  # shown beside a failure


def test_an_enrolled_agent_is_heard_lives_and_serves_its_journal(site, start):
    site.open()
    agent = start("--enrolment", str(site.enrolment))
    wait_until(lambda: len(site.positions) >= 5, "positions")
    assert set(site.positions) == {POSITION.key("u1")}
    wait_until(lambda: site.alive == [True], "the liveliness token")
    assert list(site.bus.query(f"{ROOT}/u1/journal/index", b"", 10.0))
    wait_until(lambda: "linked to the station" in agent.said, "the agent's word")
    assert "not secured" not in agent.said
    assert agent.end() == 0


def test_an_agent_of_another_authority_is_not_heard_and_says_why(site, start, tmp_path, port):
    site.open()
    (tmp_path / "other").mkdir()
    other = PkiFolder(tmp_path / "other")
    other.create("Other", hosts=[], connect=[f"tls/127.0.0.1:{port}"])
    other.enroll("u1").write(tmp_path / "foreign.toml")
    agent = start("--enrolment", str(tmp_path / "foreign.toml"))
    wait_until(lambda: "no link:" in agent.said, "the reason")
    assert "is not the one that enrolled this unit" in agent.said
    assert not site.positions


@pytest.mark.parametrize(
    ("flags", "said"),
    [
        (("--unit", "u2"), "enrols unit u1, not u2"),
        (("--connect", "tcp/127.0.0.1:1"), "tls/ only"),
    ],
)
def test_flags_that_contradict_the_enrolment_are_refused(site, start, flags, said):
    agent = start("--enrolment", str(site.enrolment), *flags)
    assert agent.process.wait(30) != 0
    wait_until(lambda: said in agent.said, said)


def test_a_secure_station_needs_an_enrolment(start):
    agent = start("--unit", "u1", "--connect", "tls/127.0.0.1:1")
    assert agent.process.wait(30) != 0
    wait_until(lambda: "needs the unit's enrolment" in agent.said, "the reason")
