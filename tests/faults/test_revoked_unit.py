"""A unit is revoked while it publishes, and a program while it subscribes: neither sends or
receives any more, and others lose nothing.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest

from base_station.security.pki.folder import PkiFolder
from shared.bus_zenoh import ClientEndpoint, ZenohBus
from shared.channels import ROOT, Direction, parse_key
from shared.clock import NS_PER_S
from shared.codec import decode
from shared.enrolment import Holder
from shared.mcap_log import read_log
from tests.rig.loaded_program import launch_loaded
from tests.rig.station_command import Agent
from tests.rig.station_process import free_port, station_process
from tests.rig.unit_journal import MessageOfUnit, stated_by
from tests.rig.waiting import until

LOST, OTHER = "FF-01", "FF-02"
COMPILING_S = 200.0  # the first agent on a machine compiles its tracker
REOPENED_S = 3.0  # the router looks once a second, and opens again


@pytest.fixture
def pki(tmp_path: Path) -> PkiFolder:
    folder = PkiFolder(tmp_path / "station")
    folder.create("Test", hosts=[], connect=[f"tls/127.0.0.1:{free_port()}"])
    return folder


@pytest.fixture
def agents(tmp_path: Path, pki: PkiFolder) -> Iterator[dict[str, Agent]]:
    """Enrolled, each with a wearer who walks."""
    started = {}
    for unit_id in (LOST, OTHER):
        enrolment = tmp_path / f"{unit_id}.toml"
        pki.enroll(unit_id).write(enrolment)
        flags = ("--enrolment", str(enrolment), "--data", str(tmp_path / "units"))
        source = ("--source", "simulated:search-ground-floor")
        started[unit_id] = Agent(tmp_path / f"{unit_id}.txt", *flags, *source)
    yield started
    for agent in started.values():
        agent.kill()


def test_revoked_unit_is_disconnected_and_the_other_loses_nothing(
    tmp_path: Path, pki: PkiFolder, agents: dict[str, Agent]
) -> None:
    (listen,) = pki.registry().connect
    log = tmp_path / "station" / "log"

    def reported(unit_id: str) -> set[MessageOfUnit]:
        return stated_by(tmp_path / "units" / unit_id / "journal.sqlite")

    chief = pki.enroll("chief", Holder.OPERATOR)
    shown_ns: list[int] = []
    with (
        station_process(tmp_path / "station", listen, launch=launch_loaded),
        closing(ZenohBus(ClientEndpoint(chief.connect, chief.identity))) as program,
    ):
        program.subscribe(f"{ROOT}/**", lambda _key, _payload: shown_ns.append(time.time_ns()))
        until(lambda: set(logged(log)) == {LOST, OTHER}, "both are heard", COMPILING_S)
        until(lambda: shown_ns, "an operator's program hears them")
        pki.revoke(LOST)
        pki.revoke("chief", Holder.OPERATOR)
        revoked_ns = time.time_ns()
        before = len(reported(LOST))
        until(lambda: len(reported(LOST)) > before + 50, "the lost one speaks on")
        assert agents[OTHER].stop() == 0
        until(lambda: reported(OTHER) <= logged(log)[OTHER].keys(), "the log has all of the other")
        assert len(reported(LOST)) > before + 50
    assert set(logged(log)[OTHER].values()) == {1}
    received = logged(log)[LOST]
    assert set(received.values()) == {1}
    assert reported(LOST) - received.keys()
    assert last_stated_ns(log, LOST) < revoked_ns + REOPENED_S * NS_PER_S
    assert shown_ns[-1] < revoked_ns + REOPENED_S * NS_PER_S


def logged(log: Path) -> dict[str, Counter[MessageOfUnit]]:
    """Count in the log of each message of each unit."""
    messages: dict[str, Counter[MessageOfUnit]] = {}
    for _, key, payload in read_log(log):
        unit_id, channel = parse_key(key)
        if channel.direction is Direction.UP:
            header = decode(channel, payload).header
            messages.setdefault(unit_id, Counter())[header.boot_id, header.seq] += 1
    return messages


def last_stated_ns(log: Path, wanted: str) -> int:
    """By the unit's clock, which is the station's here."""
    reported = ((parse_key(key), payload) for _, key, payload in read_log(log))
    return max(
        decode(channel, payload).header.t_utc_ns
        for (unit_id, channel), payload in reported
        if unit_id == wanted and channel.direction is Direction.UP
    )
