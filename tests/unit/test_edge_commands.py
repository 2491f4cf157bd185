"""A unit does each command once and always answers."""

from __future__ import annotations

import pytest

from edge.commands import CommandDesk
from shared.clock import ManualClock
from shared.envelope import Stamper
from shared.messages import Command, CommandKind, CommandState, Header

NOW_NS = 1_000_000


@pytest.fixture
def rates() -> list[float]:
    return []


@pytest.fixture
def desk(rates) -> CommandDesk:
    return CommandDesk(Stamper("u1", 1, ManualClock()), rates.append)


def command(kind: CommandKind, command_id: str = "c1", expires_ns: int = 0, rate_hz: float = 0.0):
    return Command(Header("station", 1, 1, 0), command_id, kind, "anna", expires_ns, "", rate_hz)


def test_a_rate_is_set_once_however_often_it_is_asked(desk, rates):
    asked = command(CommandKind.SET_POSITION_RATE, rate_hz=10.0)
    first, second = desk.take(asked, NOW_NS), desk.take(asked, NOW_NS)
    assert rates == [10.0]
    assert first.state is second.state is CommandState.RECEIVED
    assert first.command_id == "c1"
    assert second.header.seq == first.header.seq + 1


@pytest.mark.parametrize("rate_hz", [0.0, 0.01, 51.0])
def test_a_rate_out_of_range_is_refused_with_the_reason(desk, rates, rate_hz):
    reply = desk.take(command(CommandKind.SET_POSITION_RATE, rate_hz=rate_hz), NOW_NS)
    assert reply.state is CommandState.REFUSED
    assert "between" in reply.detail
    assert not rates


@pytest.mark.parametrize(
    ("kind", "expires_ns", "state"),
    [
        (CommandKind.EVACUATE, 0, CommandState.RECEIVED),
        (CommandKind.EVACUATE, NOW_NS + 1, CommandState.RECEIVED),
        (CommandKind.EVACUATE, NOW_NS - 1, CommandState.REFUSED),
        (CommandKind.UNKNOWN, 0, CommandState.REFUSED),
    ],
)
def test_expired_and_unknown_commands_are_refused(desk, kind, expires_ns, state):
    assert desk.take(command(kind, expires_ns=expires_ns), NOW_NS).state is state


def test_what_is_remembered_is_bounded(desk):
    for number in range(5000):
        desk.take(command(CommandKind.TEXT, f"c{number}"), NOW_NS)
    assert len(desk._answers) <= 1000
