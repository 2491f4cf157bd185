"""From a command to the outputs, and from what they have played to the station."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from edge.agent.command_handler import CommandHandler
from edge.agent.mayday_progress import MaydayProgress
from edge.agent.open_commands import OpenCommands
from edge.agent.wearer_notifier import WearerNotifier
from edge.notifiers.outputs import PlayedNotice
from edge.notifiers.signals import Notice, Signal
from shared.clock import NS_PER_S, ManualClock
from shared.header_factory import HeaderFactory
from shared.messages import (
    Command,
    CommandKind,
    CommandReply,
    CommandState,
    EventKind,
    Header,
    UnitEvent,
)

HEADER = Header("station", 1, 1, 0)


class Outputs:
    """Plays nothing until it is told to."""

    def __init__(self) -> None:
        self.shown: tuple[Notice, ...] = ()
        self.played: list[Notice] = []
        self.is_audible = True

    def start(self) -> None:
        pass

    def show(self, notices: tuple[Notice, ...]) -> None:
        self.shown = notices

    def take_played(self) -> tuple[PlayedNotice, ...]:
        played, self.played = self.played, []
        return tuple(PlayedNotice(one, self.is_audible) for one in played)

    def close(self) -> None:
        pass


class Rig:
    def __init__(self, folder: Path, known: tuple[CommandReply, ...] = ()) -> None:
        self.clock = ManualClock()
        self.outputs = Outputs()
        self.pipeline = SimpleNamespace(
            motionless_s=0.0, is_worn=True, is_on_foot=True, battery=None
        )
        self.link = SimpleNamespace(is_lost=False)
        self.journal = SimpleNamespace(acknowledged_seq=0)
        maydays = MaydayProgress()
        parts: tuple[Any, ...] = (
            self.outputs,
            OpenCommands(folder / "open_commands.json"),
            CommandHandler(HeaderFactory("u1", 1, self.clock), None, known, maydays),
            maydays,
            self.pipeline,
            self.link,
            self.journal,
            self.clock,
        )
        self.notifier = WearerNotifier(*parts)

    def signals(self) -> list[Signal]:
        self.notifier.step()
        return [notice.signal for notice in self.outputs.shown]


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[Rig]:
    rig = Rig(tmp_path)
    with closing(rig.notifier):
        yield rig


def command(kind: CommandKind, *, text: str = "", expires_ns: int = 0) -> Command:
    return Command(HEADER, kind.name, kind, "officer", expires_ns, text)


def test_a_command_is_received_then_notified_once_then_acknowledged(rig: Rig) -> None:
    received = rig.notifier.take_command(command(CommandKind.EVACUATE))
    assert (received.state, received.awaits_wearer) == (CommandState.RECEIVED, True)
    assert rig.signals() == [Signal.EVACUATE]
    rig.outputs.played += [*rig.outputs.shown, *rig.outputs.shown]  # on two outputs
    (notified,) = rig.notifier.step()
    assert (notified.state, notified.awaits_wearer) == (CommandState.NOTIFIED, True)
    repeat = rig.notifier.take_command(command(CommandKind.EVACUATE))
    assert repeat.state is CommandState.NOTIFIED
    (acknowledged,) = rig.notifier.acknowledge()
    assert acknowledged.state is CommandState.ACKNOWLEDGED
    assert rig.signals() == []
    assert rig.notifier.take_command(command(CommandKind.EVACUATE)).state is (
        CommandState.ACKNOWLEDGED
    )
    assert rig.signals() == []


def test_a_command_that_was_answered_before_it_was_played_is_not_notified(rig: Rig) -> None:
    rig.notifier.take_command(command(CommandKind.TEXT, text="come out"))
    rig.signals()
    rig.outputs.played += rig.outputs.shown
    rig.notifier.acknowledge()
    assert rig.notifier.step() == ()


def test_a_command_whose_time_is_over_is_silent(rig: Rig) -> None:
    expires_ns = rig.clock.utc_ns() + NS_PER_S
    rig.notifier.take_command(command(CommandKind.LOCATE, expires_ns=expires_ns))
    assert rig.signals() == [Signal.LOCATE]
    rig.clock.advance(2.0)
    assert rig.signals() == []


def test_a_mayday_that_the_station_has_is_confirmed_to_the_wearer(rig: Rig) -> None:
    header = Header("u1", 1, 7, 0)
    rig.notifier.note_sent((UnitEvent(header, EventKind.MAYDAY, "button"),))
    assert rig.signals() == [Signal.MAYDAY_CALLED]
    rig.journal.acknowledged_seq = 7
    assert rig.signals() == [Signal.MAYDAY_CALLED, Signal.MAYDAY_SENT]


def test_a_link_that_is_lost_for_half_a_minute_is_notified(rig: Rig) -> None:
    assert rig.signals() == []
    rig.link.is_lost = True
    assert rig.signals() == []
    rig.clock.advance(31.0)
    assert rig.signals() == [Signal.LINK_LOST]
    rig.link.is_lost = False
    assert rig.signals() == []


def test_a_press_and_motion_end_the_pre_alert(rig: Rig) -> None:
    rig.pipeline.motionless_s = 21.0
    assert rig.signals() == [Signal.PRE_ALERT]
    rig.pipeline.motionless_s = 0.0
    assert rig.signals() == []


def acknowledgement(seq: int) -> Command:
    return Command(
        HEADER, "m1", CommandKind.MAYDAY_ACKNOWLEDGED, "ada", 0, mayday_boot_id=1, mayday_seq=seq
    )


def call(rig: Rig, kind: EventKind, seq: int) -> None:
    rig.notifier.note_sent((UnitEvent(Header("u1", 1, seq, 0), kind, "button"),))


def test_a_mayday_that_was_acknowledged_is_played_and_reported_once(rig: Rig) -> None:
    call(rig, EventKind.MAYDAY, 7)
    assert rig.notifier.take_command(acknowledgement(7)).state is CommandState.RECEIVED
    assert rig.signals() == [Signal.MAYDAY_CALLED, Signal.MAYDAY_ACKNOWLEDGED]
    shown = rig.outputs.shown
    rig.outputs.played += shown
    (notified,) = rig.notifier.step()
    assert (notified.command_id, notified.state) == ("m1", CommandState.NOTIFIED)
    rig.notifier.take_command(acknowledgement(7))
    rig.signals()
    assert rig.outputs.shown == shown, "a repeat is the same notice, which is played once"


def test_acknowledgement_after_the_cancelled_mayday_is_refused_silently(rig: Rig) -> None:
    call(rig, EventKind.MAYDAY, 7)
    call(rig, EventKind.MAYDAY_CANCELLED, 8)
    reply = rig.notifier.take_command(acknowledgement(7))
    assert reply.state is CommandState.REFUSED
    assert "cancelled" in reply.detail
    assert Signal.MAYDAY_ACKNOWLEDGED not in rig.signals()


def test_a_repeat_after_another_call_does_not_acknowledge_that(rig: Rig) -> None:
    call(rig, EventKind.MAYDAY, 7)
    rig.notifier.take_command(acknowledgement(7))
    call(rig, EventKind.MAYDAY, 9)
    rig.notifier.take_command(acknowledgement(7))
    assert Signal.MAYDAY_ACKNOWLEDGED not in rig.signals()


def end(command_id: str, end_id: str = "e1") -> Command:
    return Command(HEADER, end_id, CommandKind.END_ORDER, "ada", 0, ended_command_id=command_id)


def test_an_order_that_ends_is_silent_and_asks_the_button_no_more(rig: Rig) -> None:
    rig.notifier.take_command(command(CommandKind.EVACUATE))
    rig.notifier.take_command(command(CommandKind.PAR_REQUEST))
    reply = rig.notifier.take_command(end("EVACUATE"))
    assert (reply.command_id, reply.state) == ("e1", CommandState.RECEIVED)
    assert rig.signals() == [Signal.PAR_REQUEST]
    assert [one.command_id for one in rig.notifier.acknowledge()] == ["PAR_REQUEST"]


def test_an_order_that_comes_again_after_its_end_is_played_again(rig: Rig) -> None:
    rig.notifier.take_command(command(CommandKind.EVACUATE))
    rig.signals()
    rig.outputs.played += rig.outputs.shown
    rig.notifier.step()
    rig.notifier.take_command(end("EVACUATE"))
    assert rig.signals() == []
    reply = rig.notifier.take_command(command(CommandKind.EVACUATE))
    assert (reply.state, reply.awaits_wearer) == (CommandState.NOTIFIED, True)
    assert rig.signals() == [Signal.EVACUATE]
    rig.notifier.take_command(end("EVACUATE", "e2"))
    assert rig.signals() == []


def test_the_end_of_what_the_unit_does_not_know_is_none(rig: Rig) -> None:
    assert rig.notifier.take_command(end("elsewhere")).state is CommandState.RECEIVED
    assert rig.signals() == []


def test_a_mayday_that_was_acknowledged_at_once_need_not_be_stated_to_have_arrived(
    rig: Rig,
) -> None:
    call(rig, EventKind.MAYDAY, 7)
    rig.journal.acknowledged_seq = 7
    rig.notifier.take_command(acknowledgement(7))
    assert rig.signals() == [Signal.MAYDAY_CALLED, Signal.MAYDAY_ACKNOWLEDGED]


def test_an_alarm_that_was_acknowledged_is_played_and_not_again_after_a_restart(
    tmp_path: Path,
) -> None:
    first = Rig(tmp_path)
    with closing(first.notifier):
        received = first.notifier.take_command(command(CommandKind.ALARM_ACKNOWLEDGED))
        assert (received.state, received.awaits_wearer) == (CommandState.RECEIVED, False)
        assert first.signals() == [Signal.ALARM_ACKNOWLEDGED]
    again = Rig(tmp_path, (received,))
    with closing(again.notifier):
        again.notifier.start()
        assert again.signals() == [Signal.ALARM_ACKNOWLEDGED], "it was not played yet"
        again.outputs.played += again.outputs.shown
        (notified,) = again.notifier.step()
        assert notified.state is CommandState.NOTIFIED
        assert again.signals() == [Signal.ALARM_ACKNOWLEDGED], "other outputs may still play it"
    last = Rig(tmp_path, (received, notified))
    with closing(last.notifier):
        last.notifier.start()
        assert last.signals() == []


def sent_again(kind: CommandKind, repeat_id: str) -> Command:
    return Command(HEADER, repeat_id, kind, "ada", 0, repeats=kind.name)


def all_clear(evacuation: str = "EVACUATE") -> Command:
    return Command(HEADER, "ac", CommandKind.ALL_CLEAR, "ada", 0, ended_command_id=evacuation)


def test_an_order_that_is_sent_again_is_played_anew_in_place_of_the_first(rig: Rig) -> None:
    rig.notifier.take_command(command(CommandKind.EVACUATE))
    rig.signals()
    reply = rig.notifier.take_command(sent_again(CommandKind.EVACUATE, "r1"))
    assert (reply.state, reply.repeats) == (CommandState.RECEIVED, "EVACUATE")
    rig.notifier.take_command(sent_again(CommandKind.EVACUATE, "r2"))
    assert rig.signals() == [Signal.EVACUATE]
    assert [notice.key for notice in rig.outputs.shown] == ["r2"]
    replies = rig.notifier.acknowledge()
    assert [(one.command_id, one.repeats) for one in replies] == [
        ("EVACUATE", ""), ("r1", "EVACUATE"), ("r2", "EVACUATE")
    ]  # fmt: skip
    assert rig.signals() == []


@pytest.mark.parametrize("first", ["EVACUATE", "r1"])
def test_an_order_that_was_acknowledged_does_not_alarm_again_also_after_a_restart(
    tmp_path: Path, first: str
) -> None:
    """Holds for the order itself and for a repetition of it."""
    before = Rig(tmp_path)
    with closing(before.notifier):
        begun = (
            command(CommandKind.EVACUATE)
            if first == "EVACUATE"
            else sent_again(CommandKind.EVACUATE, first)
        )
        before.notifier.take_command(begun)
        acknowledged = before.notifier.acknowledge()
    after = Rig(tmp_path, acknowledged)
    with closing(after.notifier):
        reply = after.notifier.take_command(sent_again(CommandKind.EVACUATE, "r2"))
        assert (reply.state, reply.awaits_wearer) == (CommandState.ACKNOWLEDGED, False)
        assert after.signals() == []


def test_the_end_of_an_order_ends_what_repeats_it(rig: Rig) -> None:
    rig.notifier.take_command(command(CommandKind.EVACUATE))
    rig.notifier.take_command(sent_again(CommandKind.EVACUATE, "r1"))
    rig.notifier.take_command(end("EVACUATE"))
    assert rig.signals() == []
    assert rig.notifier.acknowledge() == ()


def test_the_all_clear_ends_every_evacuation_and_is_acknowledged(rig: Rig) -> None:
    rig.notifier.take_command(Command(HEADER, "earlier", CommandKind.EVACUATE, "ada", 0))
    rig.notifier.take_command(command(CommandKind.EVACUATE))
    rig.notifier.take_command(sent_again(CommandKind.EVACUATE, "r1"))
    reply = rig.notifier.take_command(all_clear())
    assert (reply.state, reply.awaits_wearer) == (CommandState.RECEIVED, True)
    assert rig.signals() == [Signal.ALL_CLEAR]
    rig.outputs.played += rig.outputs.shown
    assert [one.state for one in rig.notifier.step()] == [CommandState.NOTIFIED]
    assert [one.command_id for one in rig.notifier.acknowledge()] == ["ac"]
    assert rig.signals() == []


def test_an_evacuation_that_comes_behind_its_all_clear_is_never_played(tmp_path: Path) -> None:
    """From a station that does not know of the all clear, also after a restart of the agent."""
    before = Rig(tmp_path)
    with closing(before.notifier):
        reply = before.notifier.take_command(all_clear())
    after = Rig(tmp_path, (reply,))
    with closing(after.notifier):
        for late in (command(CommandKind.EVACUATE), sent_again(CommandKind.EVACUATE, "r1")):
            assert after.notifier.take_command(late).state is CommandState.REFUSED
        assert after.signals() == [Signal.ALL_CLEAR]
        another = Command(HEADER, "another", CommandKind.EVACUATE, "ada", 0)
        after.notifier.take_command(another)
        assert Signal.EVACUATE in after.signals()


def test_locate_reports_light_then_sound_and_that_the_wearer_has_stopped_it(rig: Rig) -> None:
    rig.notifier.take_command(command(CommandKind.LOCATE))
    rig.signals()
    details = []
    for is_audible in (False, True, True):
        rig.outputs.is_audible = is_audible
        rig.outputs.played += rig.outputs.shown
        details += [one.detail for one in rig.notifier.step()]
    assert details == ["light", "sound"]
    (stopped,) = rig.notifier.acknowledge()
    assert (stopped.command_id, stopped.state) == ("LOCATE", CommandState.ACKNOWLEDGED)
    assert rig.signals() == []
