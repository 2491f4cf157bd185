"""Commands are done once, whatever the radio loses or repeats and however often the unit
restarts.
"""

from __future__ import annotations

from collections import Counter

from hypothesis import given, settings
from hypothesis import strategies as st

from base_station.core.commands.command_tracker import open_orders
from edge.agent.command_handler import CommandHandler
from shared.channels import COMMAND
from shared.clock import NS_PER_S, ManualClock
from shared.codec import encode
from shared.header_factory import HeaderFactory
from shared.messages import STATION_ID, Command, CommandKind, CommandReply, CommandState
from shared.messages.station import SendCommand
from tests.rig.station_script import Script

U = "FF-01"
FOREVER_S = 80_000.0
KINDS = [CommandKind.SET_POSITION_RATE, CommandKind.PAR_REQUEST, CommandKind.LOCATE]


class Radio:
    """A station and a unit; each exchange states how often its message arrives (0: lost)."""

    def __init__(self) -> None:
        self.station = Script()
        self.station.register(U)
        self.journal: list[CommandReply] = []
        self.rates: Counter[float] = Counter()
        self.clock = ManualClock()
        self.boot_id = 0
        self.restart()

    def restart(self) -> None:
        self.boot_id += 1
        header_factory = HeaderFactory(U, self.boot_id, self.clock)
        self.desk = CommandHandler(
            header_factory, lambda rate_hz: self.rates.update([rate_hz]), self.journal
        )

    def send(self, kind: CommandKind) -> None:
        number = len(self.station.pipeline.state.commands) + 1
        rate_hz = float(number) if kind is CommandKind.SET_POSITION_RATE else 0.0
        self.station.act(SendCommand(f"c{number}", kind, U, "", False, "", rate_hz, FOREVER_S))

    def exchange(self, down: int, up: int) -> None:
        """The station sends its unanswered commands; the unit replies."""
        for order in open_orders(self.station.pipeline.state):
            header = self.station.header(STATION_ID)
            command = Command(
                header, order.command_id, order.kind, "chief", order.expires_ns,
                position_rate_hz=order.position_rate_hz,
            )  # fmt: skip
            self.station.record(COMMAND.key(U), encode(command))
            for _ in range(down):
                self.reply((self.desk.take(command),), up)

    def press(self, up: int) -> None:
        self.reply(self.desk.acknowledge(), up)

    def reply(self, replies: tuple[CommandReply, ...], times: int) -> None:
        self.journal.extend(replies)
        self.clock.advance(0.1)
        for reply in replies:
            for _ in range(times):
                self.station.now_s += 0.1
                self.station.say(reply)

    def backfill(self) -> None:
        """The station fetches the messages that it missed."""
        for reply in self.journal:
            self.station.say(reply)


TIMES = st.integers(0, 2)
STEPS = st.one_of(
    st.tuples(st.just("send"), st.sampled_from(KINDS)),
    st.tuples(st.just("exchange"), TIMES, TIMES),
    st.tuples(st.just("press"), TIMES),
    st.tuples(st.just("restart")),
)


@settings(max_examples=150)
@given(st.lists(STEPS, max_size=30))
def test_every_command_is_done_once_and_reported_as_done(steps: list[tuple[object, ...]]) -> None:
    radio = Radio()
    for kind in KINDS:
        radio.send(kind)
    for name, *arguments in steps:
        if name == "send" and len(radio.station.pipeline.state.commands) >= 8:
            continue  # the unit keeps no more than these
        getattr(radio, str(name))(*arguments)
    assert all(count == 1 for count in radio.rates.values())
    radio.exchange(1, 1)
    radio.backfill()
    commands = radio.station.pipeline.state.commands.values()
    rates = [c.position_rate_hz for c in commands if c.kind is CommandKind.SET_POSITION_RATE]
    assert set(radio.rates) <= set(rates)
    assert list(radio.rates)[-1] == rates[-1], "the last that was given holds"
    pressed = {r.command_id for r in radio.journal if r.state is CommandState.ACKNOWLEDGED}
    for command in commands:
        expected = "acknowledged" if command.command_id in pressed else "received"
        if command.position_rate_hz in set(rates) - set(radio.rates):
            expected = "refused"  # replaced by a later command
        assert command.state_of(command.deliveries[U]) == expected
    radio.press(1)
    assert not any(command.is_open for command in commands)
    assert radio.station.t_ns < commands_end_ns(radio)


def commands_end_ns(radio: Radio) -> int:
    """Ends of the commands; no command expires during a test."""
    ends = [command.expires_ns for command in radio.station.pipeline.state.commands.values()]
    return min(ends, default=radio.station.t_ns + NS_PER_S)
