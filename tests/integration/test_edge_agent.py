"""An agent as a process of its own, on a real Zenoh router."""

from __future__ import annotations

import signal
import socket
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path

import pytest

from shared.bus_zenoh import StationEndpoint, ZenohBus
from shared.channels import COMMAND, ROOT, Qos, alive_key, parse_key
from shared.clock import SystemClock
from shared.codec import decode, encode
from shared.header_factory import HeaderFactory
from shared.messages import (
    Command,
    CommandKind,
    CommandReply,
    CommandState,
    EventKind,
    JournalChunk,
    JournalIndex,
    Message,
    Position,
    RawImu,
    UnitEvent,
)
from tests.rig.station_command import Agent
from tests.rig.waiting import until

WALK = "simulated:search-ground-floor"


class Station:
    """The other end: notes every message, and asks for journals."""

    def __init__(self, port: int) -> None:
        self.bus = ZenohBus(StationEndpoint((f"tcp/127.0.0.1:{port}",)))
        self.raw: dict[tuple[int, int], bytes] = {}
        self.messages: list[Message] = []
        self.alive: list[bool] = []
        self.bus.subscribe(f"{ROOT}/u1/**", self._take)
        self.bus.watch_alive(alive_key("*"), lambda _, alive: self.alive.append(alive))

    def __repr__(self) -> str:
        return f"Station(alive={self.alive}, {len(self.messages)} messages)"

    def of(self, kind: type[Message]) -> list[Message]:
        return [message for message in list(self.messages) if isinstance(message, kind)]

    def ask(self, what: str) -> list[bytes]:
        return list(self.bus.query(f"{ROOT}/u1/journal/{what}", b"", 10.0))

    def journal(self, boot_id: int, last_seq: int) -> dict[int, bytes]:
        question = f"range?epoch={boot_id};from=1;to={last_seq};bytes=2000"
        chunks = [JournalChunk.from_bytes(reply) for reply in self.ask(question)]
        assert all(chunk.boot_id == boot_id for chunk in chunks)
        return {entry.seq: entry.payload for chunk in chunks for entry in chunk.entries}

    def _take(self, key: str, payload: bytes) -> None:
        channel = parse_key(key)[1]
        if channel is not COMMAND:
            message = decode(channel, payload)
            self.raw[message.header.boot_id, message.header.seq] = payload
            self.messages.append(message)


@pytest.fixture
def station(port: int) -> Iterator[Station]:
    station = Station(port)
    yield station
    station.bus.close()


@pytest.fixture
def start(port: int, tmp_path: Path) -> Iterator[Callable[..., Agent]]:
    agents: list[Agent] = []

    def start_agent(source: str = WALK, *flags: str) -> Agent:
        arguments = ("--unit", "u1", "--source", source, "--data", str(tmp_path / "data"), *flags)
        output = tmp_path / f"agent-{len(agents)}.txt"
        agents.append(Agent(output, *arguments, "--connect", f"tcp/127.0.0.1:{port}"))
        return agents[-1]

    yield start_agent
    for agent in agents:
        agent.kill()
        print(agent.output())  # shown beside a failure


def test_after_a_kill_the_journal_of_both_boots_is_served(station, start):
    first = start()
    until(lambda: len(station.of(Position)) >= 10)
    first.kill()
    until(lambda: station.alive == [True, False])
    old_boot = station.messages[0].header.boot_id
    received = {seq: raw for (_, seq), raw in station.raw.items()}

    second = start()
    until(lambda: station.alive == [True, False, True])
    until(lambda: station.messages[-1].header.boot_id != old_boot)
    (index,) = station.ask("index")
    boots = JournalIndex.from_bytes(index).boots
    assert [boot.boot_id for boot in boots] == [old_boot, station.messages[-1].header.boot_id]
    assert boots[0].last_seq >= max(received)
    kept = station.journal(old_boot, boots[0].last_seq)
    assert list(kept) == list(range(1, boots[0].last_seq + 1))
    assert all(kept[seq] == raw for seq, raw in received.items())
    assert second.stop() == 0


def test_messages_before_the_stations_start_are_in_the_journal(port, start):
    agent = start()
    until(lambda: "no link: 127.0.0.1 is there but nothing listens" in agent.output(), "the reason")
    assert "not secured" in agent.output()
    station = Station(port)
    try:
        until(lambda: station.of(Position))
        first_received = min(seq for _, seq in station.raw)
        assert first_received > 1
        boot_id = station.messages[0].header.boot_id
        assert list(station.journal(boot_id, first_received)) == list(range(1, first_received + 1))
        assert agent.stop(signal.SIGINT) == 0
        until(lambda: station.of(UnitEvent))
        last = station.of(UnitEvent)[-1]
        assert isinstance(last, UnitEvent)
        assert (last.kind, last.detail) == (EventKind.STOPPED, "stopped by a signal")
    finally:
        station.bus.close()


@pytest.mark.parametrize("hangs", [False, True])
def test_starting_agent_links_with_the_second_station(station, start, hangs):
    with socket.socket() as first:
        first.bind(("127.0.0.1", 0))
        if hangs:
            first.listen()  # and nobody answers
        start(WALK, "--connect", f"tcp/127.0.0.1:{first.getsockname()[1]}")
        until(lambda: station.of(Position))


def test_command_is_answered_executed_and_kept_over_a_kill(station, start):
    agent = start()
    until(lambda: station.of(Position))
    header = HeaderFactory("station", 1, SystemClock()).header()
    command = Command(header, "c1", CommandKind.SET_POSITION_RATE, "anna", 0, position_rate_hz=20.0)
    station.bus.publish(COMMAND.key("u1"), b"\x00 no command", Qos.ALERT)
    station.bus.publish(COMMAND.key("all"), encode(command), Qos.ALERT)
    until(lambda: station.of(CommandReply))
    (reply,) = station.of(CommandReply)
    assert isinstance(reply, CommandReply)
    assert (reply.command_id, reply.state) == ("c1", CommandState.RECEIVED)
    until(lambda: closest_positions_ns(station) <= 60_000_000)
    agent.kill()
    until(lambda: station.alive == [True, False])
    station.messages.clear()
    start()
    until(lambda: closest_positions_ns(station) <= 60_000_000)


def test_unit_without_tracker_refuses_a_position_rate(station, start):
    """Its agent at the station sends them, over no radio."""
    start(WALK, "--tracker", "none")
    until(lambda: station.of(RawImu))
    header = HeaderFactory("station", 1, SystemClock()).header()
    command = Command(header, "c1", CommandKind.SET_POSITION_RATE, "anna", 0, position_rate_hz=1.0)
    station.bus.publish(COMMAND.key("u1"), encode(command), Qos.ALERT)
    until(lambda: station.of(CommandReply))
    (reply,) = station.of(CommandReply)
    assert isinstance(reply, CommandReply)
    assert reply.state is CommandState.REFUSED
    assert "sends no positions" in reply.detail


def test_acknowledgement_of_the_wearer_is_kept_over_a_kill(station, start):
    """The simulated wearer looks at the unit every 10 s."""
    par = Command(
        HeaderFactory("station", 1, SystemClock()).header(),
        "c1",
        CommandKind.PAR_REQUEST,
        "anna",
        0,
    )
    first = start(WALK, "--speed", "5")
    until(lambda: station.of(Position))
    station.bus.publish(COMMAND.key("u1"), encode(par), Qos.ALERT)
    until(lambda: len(station.of(CommandReply)) == 2)
    first.kill()
    start(WALK, "--speed", "5")
    until(lambda: station.alive == [True, False, True])
    station.bus.publish(COMMAND.key("u1"), encode(par), Qos.ALERT)
    until(lambda: len(station.of(CommandReply)) == 3)
    replies = station.of(CommandReply)
    assert [(reply.state, reply.awaits_wearer) for reply in replies] == [
        (CommandState.RECEIVED, True),
        (CommandState.ACKNOWLEDGED, False),
        (CommandState.ACKNOWLEDGED, False),
    ]


def closest_positions_ns(station: Station) -> int:
    times = [message.header.t_mono_ns for message in station.of(Position)]
    return min((b - a for a, b in pairwise(times)), default=10**18)


def test_a_radio_outage_interrupts_the_bus_and_not_the_journal(station, start):
    start("simulated:loses-radio", "--speed", "10")
    until(lambda: station.alive == [True, False, True])
    until(lambda: len(station.of(Position)) > 150)
    arrived = sorted(seq for _, seq in station.raw)
    missed = set(range(arrived[0], arrived[-1] + 1)) - set(arrived)
    assert len(missed) > 200  # 45 s of messages, at ten times their rate
    boot_id = station.messages[0].header.boot_id
    assert missed <= set(station.journal(boot_id, arrived[-1]))


def test_end_of_the_source_is_reported_and_ends_the_agent(station, start):
    agent = start("simulated:straight", "--speed", "20")
    assert agent.wait() == 0
    until(lambda: len(station.of(UnitEvent)) >= 2)
    kinds = [event.kind for event in station.of(UnitEvent) if isinstance(event, UnitEvent)]
    assert kinds[-2:] == [EventKind.SOURCE_ENDED, EventKind.STOPPED]


def test_a_second_agent_with_the_same_folder_is_refused(start):
    first = start()
    until(lambda: "no link" in first.output(), "the first runs")
    second = start()
    assert second.wait() == 2
    assert "another agent is using" in second.output()
