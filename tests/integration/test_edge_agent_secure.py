"""An enrolled agent over mutual TLS and access rules, and a foreign one."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from functools import partial
from pathlib import Path

import pytest

from base_station.security.pki.folder import PkiFolder
from shared.channels import POSITION, ROOT, tracker_id
from shared.enrolment import Holder
from tests.rig.enrolled_site import EnrolledSite
from tests.rig.station_command import Agent
from tests.rig.waiting import until


@pytest.fixture
def site(tmp_path: Path, port: int) -> Iterator[EnrolledSite]:
    with ExitStack() as stack:
        (tmp_path / "station").mkdir()
        yield EnrolledSite(tmp_path / "station", stack, port)


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Callable[..., Agent]]:
    agents: list[Agent] = []

    def start_agent(*flags: str, source: str = "simulated:straight") -> Agent:
        output = tmp_path / f"agent-{len(agents)}.txt"
        folder = str(tmp_path / "units")
        agents.append(Agent(output, "--source", source, "--data", folder, *flags))
        return agents[-1]

    yield start_agent
    for agent in agents:
        agent.kill()
        print(agent.output())  # shown beside a failure


def test_enrolled_agent_is_received_alive_and_serves_its_journal(site, start):
    site.open()
    agent = start("--enrolment", str(site.enrolment))
    until(lambda: len(site.positions) >= 5, "positions")
    assert set(site.positions) == {POSITION.key("u1")}
    until(lambda: site.alive == [True], "the liveliness token")
    assert list(site.bus.query(f"{ROOT}/u1/journal/index", b"", 10.0))
    until(lambda: site.utc_std_s > 0.0, "the station's time, in its headers")
    until(lambda: "linked to the station" in agent.output(), "the agent's word")
    assert "not secured" not in agent.output()
    assert agent.stop() == 0


def test_agent_of_another_authority_is_refused_and_reports_the_reason(site, start, tmp_path, port):
    site.open()
    (tmp_path / "other").mkdir()
    other = PkiFolder(tmp_path / "other")
    other.create("Other", hosts=[], connect=[f"tls/127.0.0.1:{port}"])
    other.enroll("u1").write(tmp_path / "foreign.toml")
    agent = start("--enrolment", str(tmp_path / "foreign.toml"))
    until(lambda: "no link:" in agent.output(), "the reason")
    assert "is not the one that enrolled this unit" in agent.output()
    assert not site.positions


@pytest.mark.parametrize(
    ("flags", "reported"),
    [
        (("--unit", "u2"), "enrols unit u1, not u2"),
        (("--connect", "tcp/127.0.0.1:1"), "tls/ only"),
    ],
)
def test_flags_that_contradict_the_enrolment_are_refused(site, start, flags, reported):
    agent = start("--enrolment", str(site.enrolment), *flags)
    assert agent.wait() == 2
    assert reported in agent.output()


def test_a_secure_station_needs_an_enrolment(start):
    agent = start("--unit", "u1", "--connect", "tls/127.0.0.1:1")
    assert agent.wait() == 2
    assert "needs the unit's enrolment" in agent.output()


def test_remote_tracking_agent_restarts_with_its_unit(site, start, tmp_path):
    file = tmp_path / "u1@tracker.toml"
    site.pki.enroll("u1", Holder.TRACKER).write(file)
    site.open()
    tracker = start("--enrolment", str(file), source="bus:u1")
    until(lambda: "waiting for the raw stream of u1" in tracker.output(), "the agent")
    for boots in (1, 2):
        unit = start("--enrolment", str(site.enrolment), "--tracker", "none")
        until(partial(site.has_received_boots, boots), "positions of this run")
        assert unit.stop() == 0
    assert "u1 has started again" in tracker.output()
    assert set(site.positions) == {POSITION.key(tracker_id("u1"))}
    assert list(site.bus.query(f"{ROOT}/{tracker_id('u1')}/journal/index", b"", 10.0))
    assert tracker.stop() == 0


@pytest.mark.parametrize(
    ("holder", "source", "reported"),
    [
        (Holder.UNIT, "bus:u2", "not a tracking agent, which --source bus:u2 needs"),
        (Holder.TRACKER, "bus:u3", "is for tracking u2, not u3"),
        (Holder.TRACKER, "simulated:straight", "not a unit"),
    ],
)
def test_enrolment_is_valid_for_its_purpose_only(site, start, tmp_path, holder, source, reported):
    file = tmp_path / "u2.toml"
    site.pki.enroll("u2", holder).write(file)
    agent = start("--enrolment", str(file), source=source)
    assert agent.wait() == 2
    assert reported in " ".join(agent.output().split())


def test_agent_waiting_for_its_unit_stops_on_request(start, port):
    agent = start("--connect", f"tcp/127.0.0.1:{port}", source="bus:u1")
    until(lambda: "trying again every second" in agent.output(), "the agent")
    assert agent.stop() == 0
