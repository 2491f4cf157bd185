"""Commands at a unit: each is done once and always answered."""

from __future__ import annotations

import pytest

from edge.agent.command_handler import CommandHandler
from shared.clock import ManualClock
from shared.header_factory import HeaderFactory
from shared.messages import Command, CommandKind, CommandState, Header


@pytest.fixture
def rates() -> list[float]:
    return []


@pytest.fixture
def command_handler(rates) -> CommandHandler:
    return CommandHandler(HeaderFactory("u1", 1, ManualClock()), rates.append)


SENT_NS = 1_000_000


def command(kind: CommandKind, command_id: str = "c1", expires_ns: int = 0, rate_hz: float = 0.0):
    header = Header("station", 1, 1, 0, t_utc_ns=SENT_NS)
    return Command(header, command_id, kind, "anna", expires_ns, "", rate_hz)


def test_rate_is_set_once_however_often_it_is_requested(command_handler, rates):
    asked = command(CommandKind.SET_POSITION_RATE, rate_hz=10.0)
    first, second = command_handler.take(asked), command_handler.take(asked)
    assert rates == [10.0]
    assert first.state is second.state is CommandState.RECEIVED
    assert first.command_id == "c1"
    assert second.header.seq == first.header.seq + 1


@pytest.mark.parametrize("rate_hz", [0.1, 50.0])
def test_least_and_greatest_rate_of_the_station_are_accepted(command_handler, rates, rate_hz):
    asked = command(CommandKind.SET_POSITION_RATE, rate_hz=rate_hz)
    assert command_handler.take(asked).state is CommandState.RECEIVED
    assert rates == [rate_hz]


@pytest.mark.parametrize("rate_hz", [0.0, 0.01, 51.0])
def test_rate_out_of_range_is_refused_with_the_reason(command_handler, rates, rate_hz):
    reply = command_handler.take(command(CommandKind.SET_POSITION_RATE, rate_hz=rate_hz))
    assert reply.state is CommandState.REFUSED
    assert "between" in reply.detail
    assert not rates


@pytest.mark.parametrize(
    ("kind", "expires_ns", "state"),
    [
        (CommandKind.EVACUATE, 0, CommandState.RECEIVED),
        (CommandKind.EVACUATE, SENT_NS + 1, CommandState.RECEIVED),
        (CommandKind.EVACUATE, SENT_NS, CommandState.REFUSED),
        (CommandKind.EVACUATE, SENT_NS - 1, CommandState.REFUSED),
        (CommandKind.UNKNOWN, 0, CommandState.REFUSED),
    ],
)
def test_expired_and_unknown_commands_are_refused(command_handler, kind, expires_ns, state):
    assert command_handler.take(command(kind, expires_ns=expires_ns)).state is state


def test_number_of_kept_commands_is_bounded_to_the_newest(command_handler, rates):
    for number in range(5000):
        command_handler.take(command(CommandKind.TEXT, f"c{number}"))
    asked = command(CommandKind.SET_POSITION_RATE, rate_hz=10.0)
    for _ in range(2):
        command_handler.take(asked)
    assert len(command_handler._replies) == 1000
    assert rates == [10.0]


ASKING = [
    CommandKind.EVACUATE,
    CommandKind.PAR_REQUEST,
    CommandKind.TEXT,
    CommandKind.LOCATE,
    CommandKind.ALL_CLEAR,
]


@pytest.mark.parametrize("kind", [kind for kind in CommandKind if kind is not CommandKind.UNKNOWN])
def test_wearer_acknowledges_requests_for_it_once(command_handler, kind):
    reply = command_handler.take(command(kind, rate_hz=5.0))
    assert reply.awaits_wearer is (kind in ASKING)
    answers = command_handler.acknowledge()
    assert [answer.state for answer in answers] == [CommandState.ACKNOWLEDGED] * (kind in ASKING)
    assert not command_handler.acknowledge()


def test_repeat_after_the_acknowledgement_is_answered_with_it(command_handler):
    asked = command(CommandKind.PAR_REQUEST)
    command_handler.take(asked)
    (acknowledged,) = command_handler.acknowledge()
    again = command_handler.take(asked)
    assert (again.state, again.awaits_wearer) == (CommandState.ACKNOWLEDGED, False)
    assert again.header.seq == acknowledged.header.seq + 1
    assert not command_handler.acknowledge()


def test_one_press_answers_all_requests(command_handler):
    for number in range(3):
        command_handler.take(command(CommandKind.TEXT, f"c{number}"))
    assert [answer.command_id for answer in command_handler.acknowledge()] == ["c0", "c1", "c2"]


def test_unit_without_outputs_refuses_to_signal_its_place(rates):
    handler = CommandHandler(HeaderFactory("u1", 1, ManualClock()), rates.append, has_outputs=False)
    reply = handler.take(command(CommandKind.LOCATE))
    assert (reply.state, reply.detail) == (
        CommandState.REFUSED, "this unit has no sounder and no light"
    )  # fmt: skip
    assert reply.text_code.code == "refused-no-output"
    assert handler.take(command(CommandKind.LOCATE)).text_code == reply.text_code, "a repeat, too"
    assert handler.take(command(CommandKind.EVACUATE, "c2")).state is CommandState.RECEIVED
