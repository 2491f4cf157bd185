"""A command from the console's button to the wearer's and back, over the bus."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import msgspec
import pytest

from base_station.core.state.command import Order
from base_station.replay.playback import compare
from base_station.unit_sync import command_sender
from base_station.unit_sync.command_sender import CommandSender
from edge.agent.command_handler import CommandHandler
from shared.bus import Subscription
from shared.bus_memory import MemoryBus, MemoryRouter
from shared.channels import COMMAND, REPLY
from shared.clock import ManualClock, SystemClock
from shared.codec import decode, encode
from shared.errors import BusError
from shared.header_factory import HeaderFactory
from shared.messages import STATION_ID, Command, CommandKind, CommandReply
from shared.messages.station import ConfirmCommand, RegisterUnit, SendCommand
from tests.rig.live_station import LiveStation, make_pipeline
from tests.rig.waiting import until

U = "FF-01"


class Unit:
    """A unit's command desk on the bus; it may be deaf, mute or away."""

    def __init__(self, router: MemoryRouter, boot_id: int = 1) -> None:
        self.bus: MemoryBus = router.attach_unit()
        self.rates: list[float] = []
        self.received: list[Command] = []
        self.is_mute = False
        self.desk = CommandHandler(HeaderFactory(U, boot_id, SystemClock()), self.rates.append)
        self._hearing: Subscription | None = None

    def come(self) -> None:
        self._hearing = self.bus.subscribe(COMMAND.key(U), self._take)

    def go(self) -> None:
        assert self._hearing is not None
        self._hearing.close()

    def press(self) -> None:
        for reply in self.desk.acknowledge():
            self.say(reply)

    def say(self, reply: CommandReply) -> None:
        self.bus.publish(REPLY.key(U), encode(reply), REPLY.qos)

    def _take(self, _key: str, payload: bytes) -> None:
        command = decode(COMMAND, payload)
        assert isinstance(command, Command)
        self.received.append(command)
        reply = self.desk.take(command)
        if not self.is_mute:
            self.say(reply)


@pytest.fixture(autouse=True)
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(command_sender, "_AGAIN_AFTER_NS", 10**8)
    monkeypatch.setattr(command_sender, "_POLL_INTERVAL_S", 0.02)


def order(kind: CommandKind, rate_hz: float = 0.0, lasts_s: float = 600.0) -> SendCommand:
    return SendCommand("c1", kind, U, "", False, "", rate_hz, lasts_s)


def state(station: LiveStation) -> str:
    (command,) = station.snapshot().commands
    return command.units[0].state


def test_a_par_is_sent_received_and_acknowledged(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(command_sender, "_AGAIN_AFTER_NS", 10**12)  # a late reply repeats nothing
    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit(U, "one"))
        unit = Unit(station.router)
        unit.come()
        station.act(order(CommandKind.PAR_REQUEST))
        until(lambda: state(station) == "received")
        unit.press()
        until(lambda: state(station) == "acknowledged")
        assert len(unit.received) == 1
        reported = [one.commands[0].units[0].state for one in station.screen.deltas if one.commands]
        assert reported[-1] == "acknowledged"
    records = list(station.log.records())
    keys = [key for _, key, _ in records]
    assert keys.count(COMMAND.key(U)) == 1
    assert keys.count(REPLY.key(U)) == 2
    assert list(compare(records, make_pipeline())) == []


def test_command_is_repeated_until_answered_and_executed_once(tmp_path: Path) -> None:
    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit(U, "one"))
        unit = Unit(station.router)
        unit.is_mute = True
        unit.come()
        station.act(order(CommandKind.SET_POSITION_RATE, 10.0))
        until(lambda: len(unit.received) >= 4)
        assert state(station) == "sent"
        unit.is_mute = False
        until(lambda: state(station) == "received")
        count = len(unit.received)
        assert unit.rates == [10.0]
        assert [one.command_id for one in unit.received] == ["c1"] * count


def test_returning_unit_gets_missed_commands(tmp_path: Path) -> None:
    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit(U, "one"))
        unit = Unit(station.router)
        station.act(order(CommandKind.EVACUATE))
        until(lambda: any(delta.health for delta in station.screen.deltas))
        assert state(station) == "queued"
        unit.come()
        until(lambda: state(station) == "received")
        unit.go()


def test_unanswered_command_expires_and_is_not_repeated(tmp_path: Path) -> None:
    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit(U, "one"))
        station.act(order(CommandKind.EVACUATE, lasts_s=0.3))
        until(lambda: state(station) == "expired")
        unit = Unit(station.router)
        unit.come()
        station.act(ConfirmCommand("c1", U))
        assert state(station) == "acknowledged"
        assert unit.received == []


def test_temporary_failure_of_the_bus_ends_no_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit(U, "one"))
        unit = Unit(station.router)
        unit.come()
        tries = []

        def fail(*_: object) -> None:
            tries.append(1)
            raise BusError("no")

        with monkeypatch.context() as broken:
            broken.setattr(station.bus, "publish", fail)
            station.act(order(CommandKind.EVACUATE))
            until(lambda: len(tries) > 2)
        until(lambda: state(station) == "received")


def test_restarted_station_continues_to_send_commands(tmp_path: Path) -> None:
    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit(U, "one"))
        station.act(order(CommandKind.EVACUATE))
    with LiveStation(tmp_path) as station:
        unit = Unit(station.router)
        unit.come()
        until(lambda: state(station) == "received")


def an_order(expires_ns: int) -> Order:
    return Order(U, "c1", CommandKind.EVACUATE, "anna", expires_ns, "", 0.0)


@pytest.fixture
def link() -> tuple[CommandSender, Unit, ManualClock]:
    router, clock = MemoryRouter(), ManualClock()
    return (
        CommandSender(router.attach_station(), HeaderFactory(STATION_ID, 1, clock), clock),
        Unit(router),
        clock,
    )


def test_repeats_wait_for_a_reply_until_the_end_of_the_command(
    link: tuple[CommandSender, Unit, ManualClock], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(command_sender, "_AGAIN_AFTER_NS", 2 * 10**9)
    down, unit, clock = link
    unit.come()
    orders = [an_order(clock.utc_ns() + 5 * 10**9)]
    counts = []
    for _ in range(14):
        down.send_due(orders)
        counts.append(len(unit.received))
        clock.advance(0.5)
    assert counts == [1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 3, 3]
    assert [one.header.seq for one in unit.received] == [1, 2, 3]


def test_returning_unit_gets_commands_at_once(
    link: tuple[CommandSender, Unit, ManualClock], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(command_sender, "_AGAIN_AFTER_NS", 100 * 10**9)
    down, unit, clock = link
    orders = [an_order(clock.utc_ns() + 10**12)]
    come_and_go: list[Callable[[], None]] = [unit.come, unit.go, unit.come]
    for happens in come_and_go:
        happens()
        down.send_due(orders)
        clock.advance(0.1)
    assert len(unit.received) == 2


def test_unreachable_unit_does_not_delay_commands_to_others(
    link: tuple[CommandSender, Unit, ManualClock], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nor are the others told again and again for it."""
    down, unit, clock = link
    unit.come()
    has_subscriber = down._bus.has_subscriber

    def fail_for_one(key: str) -> bool:
        if "FF-00" in key or "FF-99" in key:
            raise BusError("no")
        return has_subscriber(key)

    monkeypatch.setattr(down._bus, "has_subscriber", fail_for_one)
    monkeypatch.setattr(command_sender, "_AGAIN_AFTER_NS", 2 * 10**9)
    order = an_order(clock.utc_ns() + 10**12)
    orders = [msgspec.structs.replace(order, unit_id=one) for one in ("FF-00", U, "FF-99")]
    for _ in range(3):
        down.send_due(orders)
        clock.advance(0.2)
    assert len(unit.received) == 1


def test_answered_command_is_not_repeated(
    link: tuple[CommandSender, Unit, ManualClock], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(command_sender, "_AGAIN_AFTER_NS", 0)
    down, unit, clock = link
    unit.come()
    one = an_order(clock.utc_ns() + 10**12)
    another = msgspec.structs.replace(one, command_id="c2")
    down.start()
    down.report([one])
    until(lambda: unit.received)
    down.report([another])  # the first is answered
    until(lambda: unit.received[-1].command_id == "c2")
    count = len(unit.received)
    until(lambda: len(unit.received) > count + 3)
    down.close()
    assert {one.command_id for one in unit.received[count:]} == {"c2"}
