"""A mayday survives the sudden end of a unit, and not an orderly one."""

from __future__ import annotations

import itertools
import sqlite3
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import pytest

from edge.agent import restore_state
from edge.agent.command_handler import REMEMBERED, CommandHandler
from edge.agent.fitted_sensor import FittedSensor
from edge.agent.pipeline import TrackerPipeline, UnitIdentity
from edge.agent.restore_state import answers_before, mayday_before, position_rate_before
from edge.samples import SensorDescription
from edge.storage.journal import journal as journal_module
from edge.storage.journal import schema as rows_module
from edge.storage.journal.journal import Journal, JournalRow
from edge.tracker.choice.one_sensor import OneSensorTracker
from edge.tracker.registry import make_tracker
from shared.channels import EVENT, REPLY, channel_of
from shared.clock import ManualClock
from shared.codec import encode
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
from shared.messages.event import FAILED

STARTED, STOPPED = EventKind.STARTED, EventKind.STOPPED
MAYDAY, CANCELLED, FALL = EventKind.MAYDAY, EventKind.MAYDAY_CANCELLED, EventKind.FALL
BOOTS = itertools.count(1)
PAGE_BYTES = 4096


def boot(path: Path, *kinds: EventKind) -> bool:
    """A boot with these messages; returns whether it knew of a mayday at its begin."""
    journal = Journal(path / "journal.sqlite", BOOTS.__next__, 0, 10**8)
    known = mayday_before(journal)
    header_factory = HeaderFactory("u1", journal.boot_id, ManualClock())
    events = [UnitEvent(header_factory.header(), kind) for kind in kinds]
    journal.append([JournalRow(e.header.seq, EVENT, 0, encode(e)) for e in events])
    journal.close()
    return known


@pytest.mark.parametrize(
    ("messages", "latched"),
    [
        ((STARTED,), False),
        ((STARTED, MAYDAY), True),
        ((STARTED, MAYDAY, FALL), True),
        ((STARTED, MAYDAY, CANCELLED), False),
        ((STARTED, MAYDAY, CANCELLED, MAYDAY), True),
        ((STARTED, MAYDAY, STOPPED), False),
    ],
)
def test_last_message_of_the_last_boot_counts(tmp_path, messages, latched):
    assert not boot(tmp_path, *messages)
    assert boot(tmp_path, STARTED) is latched


def test_unit_that_reported_its_failure_was_not_stopped(tmp_path):
    """Its service starts it again within a second, and its wearer still waits for help."""
    journal = Journal(tmp_path / "journal.sqlite", BOOTS.__next__, 0, 10**8)
    header_factory = HeaderFactory("u1", journal.boot_id, ManualClock())
    events = [
        UnitEvent(header_factory.header(), MAYDAY),
        UnitEvent(header_factory.header(), STOPPED, FAILED),
    ]
    journal.append([JournalRow(e.header.seq, EVENT, 0, encode(e)) for e in events])
    journal.close()
    assert boot(tmp_path, STARTED)


def test_unreadable_message_prevents_no_start(tmp_path):
    """Damage, or a message of a newer program that has been removed."""
    boot(tmp_path, STARTED, MAYDAY)
    path = tmp_path / "journal.sqlite"
    with closing(sqlite3.connect(path)) as connection, connection:
        for number, suffix in enumerate((EVENT.suffix, REPLY.suffix)):
            connection.execute(
                "INSERT INTO message SELECT worth, boot, seq + 5 + ?, ?, 0, x'ff' FROM message "
                "WHERE seq = 2",
                (number, suffix),
            )
    journal = Journal(path, BOOTS.__next__, 0, 10**8)
    assert mayday_before(journal)
    assert answers_before(journal) == []
    journal.close()


@pytest.mark.parametrize(("at_last", "latched"), [(MAYDAY, True), (FALL, False)])
def test_damage_inside_the_journal_prevents_no_start(tmp_path, at_last, latched):
    """Messages behind the damaged part are known all the same."""
    boot(tmp_path, MAYDAY, *[FALL] * 1000, at_last)
    path = tmp_path / "journal.sqlite"
    content = path.read_bytes()
    middle = len(content) // 2 // PAGE_BYTES * PAGE_BYTES
    path.write_bytes(content[:middle] + b"\xff" * PAGE_BYTES + content[middle + PAGE_BYTES :])
    journal = Journal(path, BOOTS.__next__, 0, 10**8)
    assert mayday_before(journal) is latched
    assert answers_before(journal) == []
    journal.close()


def test_mayday_from_before_is_sent_again_first():
    sensor = SensorDescription("s", 100.0)
    pipeline = TrackerPipeline(
        UnitIdentity("", "", "eskf", (FittedSensor(sensor),)),
        OneSensorTracker(make_tracker("eskf", sensor)),
        HeaderFactory("u1", 1, ManualClock()),
        5.0,
        mayday=True,
    )
    events = [message for message in pipeline.start() if isinstance(message, UnitEvent)]
    assert [event.kind for event in events] == [STARTED, MAYDAY]


class DeskBoot:
    """A boot whose handler answers into the journal; ``rates`` are those that it has set."""

    def __init__(self, path: Path) -> None:
        self.journal = Journal(path / "journal.sqlite", BOOTS.__next__, 0, 10**8)
        self.rates: list[float] = []
        header_factory = HeaderFactory("u1", self.journal.boot_id, ManualClock())
        self.command_handler = CommandHandler(
            header_factory, self.rates.append, answers_before(self.journal)
        )

    def take(self, command_id: str, kind: CommandKind) -> CommandReply:
        header = Header("station", 1, 1, 0)
        reply = self.command_handler.take(
            Command(header, command_id, kind, "anna", 0, position_rate_hz=10.0)
        )
        self.keep(reply)
        return reply

    def keep(self, *replies: CommandReply) -> None:
        self.journal.append([JournalRow(r.header.seq, REPLY, 0, encode(r)) for r in replies])


def test_command_done_before_a_restart_is_not_done_again(tmp_path):
    first = DeskBoot(tmp_path)
    first.take("c1", CommandKind.SET_POSITION_RATE)
    assert first.rates == [10.0]
    first.journal.close()
    second = DeskBoot(tmp_path)
    reply = second.take("c1", CommandKind.SET_POSITION_RATE)
    assert reply.state is CommandState.RECEIVED
    assert second.rates == []
    second.journal.close()


def test_unacknowledged_command_is_still_open_after_a_restart(tmp_path):
    first = DeskBoot(tmp_path)
    first.take("c1", CommandKind.EVACUATE)
    first.keep(*first.command_handler.acknowledge())
    first.take("c2", CommandKind.EVACUATE)
    first.journal.close()
    second = DeskBoot(tmp_path)
    assert second.take("c1", CommandKind.EVACUATE).state is CommandState.ACKNOWLEDGED
    assert [reply.command_id for reply in second.command_handler.acknowledge()] == ["c2"]
    second.journal.close()


class RateBoot:
    """A boot of a machine that has been on for ``on_s``; its agent received these rates."""

    def __init__(self, path: Path, on_s: float, *rates_hz: float, detail: str = "") -> None:
        """``detail`` of a stop in order, or of one that failed; none: it came to a sudden end."""
        journal = Journal(path / "journal.sqlite", BOOTS.__next__, 0, 10**8)
        clock = ManualClock()
        clock.advance(on_s)
        self.known_hz = position_rate_before(journal, clock.monotonic_ns())
        header_factory = HeaderFactory("u1", journal.boot_id, clock)
        command_handler = CommandHandler(header_factory, lambda _: None, answers_before(journal))
        messages: list[UnitEvent | CommandReply] = [UnitEvent(header_factory.header(), STARTED)]
        for rate_hz in rates_hz:
            clock.advance(60.0)
            for kind in (CommandKind.SET_POSITION_RATE, CommandKind.LOCATE):
                name, header = f"{journal.boot_id} {kind} {rate_hz}", Header("station", 1, 1, 0)
                command = Command(header, name, kind, "anna", 0, position_rate_hz=rate_hz)
                messages.append(command_handler.take(command))
        if detail:
            messages.append(UnitEvent(header_factory.header(), STOPPED, detail))
        journal.append(
            [JournalRow(one.header.seq, channel_of(one), 0, encode(one)) for one in messages]
        )
        journal.close()


def test_set_rate_holds_until_the_agent_is_stopped(tmp_path):
    """It fails and is started again within a second: the station would not know."""
    assert RateBoot(tmp_path, 30.0, 2.0, 0.125, 51.0).known_hz is None
    assert RateBoot(tmp_path, 500.0).known_hz == 0.125
    assert RateBoot(tmp_path, 600.0, detail=FAILED).known_hz == 0.125
    assert RateBoot(tmp_path, 700.0, 20.0).known_hz == 0.125
    assert RateBoot(tmp_path, 800.0, detail="stopped by a signal").known_hz == 20.0
    assert RateBoot(tmp_path, 900.0).known_hz is None
    assert RateBoot(tmp_path, 1000.0).known_hz is None


def test_set_rate_is_reset_when_the_unit_was_switched_off(tmp_path):
    """However long it is on by then: it may be another incident, and another commander."""
    RateBoot(tmp_path, 30.0, 2.0)
    assert RateBoot(tmp_path, 40.0).known_hz is None
    assert RateBoot(tmp_path, 7200.0).known_hz is None
    RateBoot(tmp_path, 7300.0, 3.0)
    RateBoot(tmp_path, 9000.0)
    RateBoot(tmp_path, 50.0)
    assert RateBoot(tmp_path, 20_000.0).known_hz is None


def test_boot_without_events_gives_no_rate(tmp_path):
    RateBoot(tmp_path, 30.0, 2.0)
    path = tmp_path / "journal.sqlite"
    with closing(sqlite3.connect(path)) as connection, connection:
        connection.execute("DELETE FROM message WHERE suffix = ?", (EVENT.suffix,))
    assert RateBoot(tmp_path, 500.0).known_hz is None


@pytest.mark.slow
def test_newest_answers_are_kept_across_boots(tmp_path):
    first = DeskBoot(tmp_path)
    for number in range(2 * REMEMBERED + 5):
        first.take(f"c{number}", CommandKind.LOCATE)
    first.journal.close()
    second = DeskBoot(tmp_path)
    given = answers_before(second.journal)
    assert given[-1].command_id == f"c{2 * REMEMBERED + 4}"
    assert len(given) == 2 * REMEMBERED
    second.journal.close()


def stated_by_many_boots(path: Path, starts: int, after_s: float) -> ManualClock:
    """A program that fails within a second and is restarted, as its journal shows."""
    Journal(path / "journal.sqlite", BOOTS.__next__, 0, 10**9).close()
    clock = ManualClock()
    clock.advance(after_s)
    with closing(sqlite3.connect(path / "journal.sqlite")) as connection, connection:
        for _ in range(starts):
            clock.advance(1.0)
            header_factory = HeaderFactory("u1", next(BOOTS), clock)
            made = connection.execute(
                "INSERT INTO boot (boot_id, started_utc_ns) VALUES (?, 0)",
                (header_factory.boot_id,),
            )
            for kind in (STARTED, MAYDAY, FALL):
                event = UnitEvent(header_factory.header(), kind)
                connection.execute(
                    "INSERT INTO message VALUES (3, ?, ?, ?, 0, ?)",
                    (made.lastrowid, event.header.seq, EVENT.suffix, encode(event)),
                )
    return clock


def test_thousands_of_starts_are_not_read_one_by_one(tmp_path, monkeypatch):
    """The wearer waits for it meanwhile."""
    RateBoot(tmp_path, 0.0, 2.0)
    clock = stated_by_many_boots(tmp_path, 3000, after_s=0.0)
    journal = Journal(tmp_path / "journal.sqlite", BOOTS.__next__, 0, 10**9)
    opened, bounds_read, decoded = [0], [0], [0]
    for module, name, counted in (
        (journal_module, "connect", opened),
        (rows_module, "bounds", bounds_read),
        (restore_state, "decode", decoded),
    ):
        monkeypatch.setattr(module, name, counting(getattr(module, name), counted))
    assert mayday_before(journal)
    assert decoded[0] == 2
    assert len(answers_before(journal)) == 2
    assert decoded[0] == 4
    assert bounds_read[0] == 0
    assert position_rate_before(journal, clock.monotonic_ns()) is None  # switched off since
    assert opened[0] <= 4
    journal.close()


def counting(function: Callable[..., object], counted: list[int]) -> Callable[..., object]:
    def call(*arguments: object) -> object:
        counted[0] += 1
        return function(*arguments)

    return call


def test_rate_from_before_thousands_of_starts_still_holds(tmp_path):
    RateBoot(tmp_path, 30.0, 2.0)
    clock = stated_by_many_boots(tmp_path, 300, after_s=1000.0)
    journal = Journal(tmp_path / "journal.sqlite", BOOTS.__next__, 0, 10**9)
    assert position_rate_before(journal, clock.monotonic_ns()) == 2.0
    journal.close()


def test_damage_in_one_boot_hides_no_answer_of_another(tmp_path):
    """A command that was done is not done again."""
    for number in range(6):
        one = DeskBoot(tmp_path)
        for each in range(40):  # some pages of each
            one.take(f"c{number}.{each}", CommandKind.RESET_ALARM)
        one.journal.close()
    path = tmp_path / "journal.sqlite"
    whole = len(answers_before(Journal(path, BOOTS.__next__, 0, 10**8)))
    content = path.read_bytes()
    at = content.index(b"c3.20") // PAGE_BYTES * PAGE_BYTES
    path.write_bytes(content[:at] + b"\xff" * PAGE_BYTES + content[at + PAGE_BYTES :])
    journal = Journal(path, BOOTS.__next__, 0, 10**8)
    names = {answer.command_id for answer in answers_before(journal)}
    journal.close()
    assert len(names) < whole
    for number in (0, 1, 5):
        assert {f"c{number}.{each}" for each in range(40)} <= names
