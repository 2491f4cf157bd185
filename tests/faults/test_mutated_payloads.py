"""A million random and mutated payloads on every channel stop neither the station nor an agent."""

from __future__ import annotations

import random
import threading
from contextlib import closing, suppress
from pathlib import Path

import pytest

from base_station.core.events import DECODER_FAILED, Rejected, event_of
from base_station.core.pipeline import StationPipeline
from base_station.engine.engine import StationEngine
from base_station.engine.ports import Record
from base_station.replay.playback import compare
from base_station.views.wire import HealthView
from edge.agent.command_handler import CommandHandler
from edge.clocks.station import StationClock
from edge.storage.journal.journal import Journal
from edge.storage.journal.server import JournalServer
from shared.channels import (
    CHANNELS,
    COMMAND,
    IMU,
    POSITION,
    Channel,
    Direction,
    backfilled_key,
    parse_key,
    tracker_id,
)
from shared.clock import ManualClock
from shared.codec import decode, encode
from shared.errors import UnknownChannelError, WireError
from shared.header_factory import HeaderFactory
from shared.mcap_log import is_derived
from shared.messages import (
    Command,
    JournalBoot,
    JournalChunk,
    JournalEntry,
    JournalIndex,
    RawImu,
)
from shared.messages.clock import ClockAnswer
from shared.messages.station import RegisterUnit
from tests.rig.fuzz import RandomPayloads, mutated
from tests.rig.live_station import Screen, make_pipeline, ports_of
from tests.rig.waiting import PATIENCE_S

pytestmark = pytest.mark.begun_first

COUNT = 1_000_000
FEWER = 6000  # all of them are remembered and stepped again
AT_ONCE = 200
QUIET_TURNS = 60  # at the end: 3 s in which health is told
UNITS = ("FF-01", "FF-02", "stranger")


class MutatedFeed:
    """A ``Feed`` of mutated messages, with time going on."""

    follows = False

    def __init__(self, clock: ManualClock, seed: int, count: int) -> None:
        self._clock = clock
        self._chance = random.Random(seed)
        self._payloads = RandomPayloads(self._chance)
        self._left = count
        self._quiet = 0
        self.done = threading.Event()
        self.left_alone = 0  # of no channel that is kept, or the station's own

    def take(self, timeout_s: float) -> list[Record]:
        self._clock.advance(0.05)
        if self._left == 0:
            self._quiet += 1
            if self._quiet > QUIET_TURNS:
                self.done.set()
            return []
        count = min(self._left, AT_ONCE)
        self._left -= count
        return [self._record() for _ in range(count)]

    def wake(self) -> None:
        pass

    def _record(self) -> Record:
        chance = self._chance
        channel, unit_id = chance.choice(CHANNELS), chance.choice(UNITS)
        whole = self._payloads.next(channel, unit_id, chance.randrange(10**6))
        payload = mutated(chance, whole)
        key = self._key(channel, unit_id)
        self.left_alone += is_left_alone(key)
        return self._clock.utc_ns(), key, payload

    def _key(self, channel: Channel, unit_id: str) -> str:
        match self._chance.randrange(8):
            case 0:
                return backfilled_key(unit_id, channel.suffix)
            case 1:
                return channel.key(tracker_id(unit_id))
            case 2:
                return self._chance.choice(CHANNELS).key(self._chance.choice(UNITS))
            case 3:
                return f"muster/v1/{unit_id}/up/{self._chance.randrange(10**6)}"
            case _:
                return channel.key(unit_id)


class CountingLog:
    """A ``Log`` that counts, and keeps the records if it is to."""

    problem = low_disk_space = ""
    is_behind = refuses = False

    def __init__(self, *, keeps: bool) -> None:
        self.from_bus = 0
        self.unreadable = 0
        self.records: list[Record] = []
        self._keeps = keeps

    def write(self, t_ns: int, key: str, payload: bytes) -> bool:
        if self._keeps:
            self.records.append((t_ns, key, payload))
        if not is_derived(key) and not key.startswith("muster/v1/station/"):
            self.from_bus += 1
            self.unreadable += isinstance(event_of(t_ns, key, payload), Rejected)
        return True

    def flush(self) -> bool:
        return True


def is_left_alone(key: str) -> bool:
    try:
        channel = parse_key(key)[1]
    except UnknownChannelError:
        return False
    return channel.direction is Direction.STATION or not channel.logged


@pytest.fixture(autouse=True)
def any_boot(monkeypatch: pytest.MonkeyPatch) -> None:
    """One boot id is as good as another here."""
    monkeypatch.setattr("base_station.core.state.message_stream.RESTART_STORM_NS", 0)


@pytest.mark.timeout(1800)  # a million, beside all other tests
def test_mutated_messages_are_logged_and_counted(tmp_path: Path) -> None:
    log, screen, pipeline = CountingLog(keeps=False), Screen(), make_pipeline()
    feed = say(COUNT, log, screen, pipeline, tmp_path)
    state = pipeline.state
    own_mistakes = {"station|drive", "station|pipeline"} & set(state.alarms)
    assert not own_mistakes, [state.alarms[name].text for name in own_mistakes]
    assert DECODER_FAILED not in state.counts.last_undecodable
    health = last_health(screen)
    assert log.from_bus + health.repeated + feed.left_alone == COUNT
    assert health.undecodable == state.counts.undecodable == log.unreadable > 0


def test_replay_of_mutated_messages_makes_the_same_decisions(tmp_path: Path) -> None:
    log = CountingLog(keeps=True)
    say(FEWER, log, Screen(), make_pipeline(), tmp_path)
    assert len(log.records) > FEWER / 2
    assert list(compare(log.records, make_pipeline())) == []


def say(
    count: int, log: CountingLog, screen: Screen, pipeline: StationPipeline, folder: Path
) -> MutatedFeed:
    """To a station; returns when it has heard all."""
    clock = ManualClock()
    feed = MutatedFeed(clock, 4, count)
    drive = StationEngine(pipeline, ports_of(feed, log, screen, folder, clock))
    registered = drive.submit("chief", RegisterUnit("FF-01", "one"))
    drive.start()
    assert registered.result(PATIENCE_S).refused is None
    feed.done.wait(PATIENCE_S + count / 1000)  # a third of a core does some 2,500 a second
    drive.stop()
    assert feed.done.is_set()
    return feed


def last_health(screen: Screen) -> HealthView:
    return next(delta.health for delta in reversed(screen.deltas) if delta.health is not None)


def test_agent_answers_readable_commands_and_counts_the_rest() -> None:
    chance = random.Random(5)
    payloads = RandomPayloads(chance)
    desk = CommandHandler(HeaderFactory("FF-01", 1, ManualClock()), lambda _: None)
    answered = unreadable = 0
    for number in range(COUNT // 4):
        payload = mutated(chance, payloads.next(COMMAND, "station", number))
        try:
            command = decode(COMMAND, payload)
        except WireError:
            unreadable += 1
            continue
        assert isinstance(command, Command)
        assert encode(desk.take(command))
        answered += 1
    assert answered > 0
    assert unreadable > 0


def test_mutated_raw_batch_gives_finite_samples_or_none() -> None:
    chance = random.Random(6)
    payloads = RandomPayloads(chance)
    for number in range(COUNT // 8):
        payload = mutated(chance, payloads.next(IMU, "FF-01", number))
        try:
            raw = decode(IMU, payload)
        except WireError:
            continue
        assert isinstance(raw, RawImu)


def test_mutated_clock_answer_leaves_a_valid_estimate() -> None:
    chance, machine = random.Random(7), ManualClock()
    clock = StationClock(machine)
    good = ClockAnswer(10**18, 10**18 + 1).to_bytes()
    for _ in range(COUNT // 8):
        machine.advance(60.0)
        clock.turn(lambda take: take(mutated(chance, good)))
        estimate = clock.estimate()
        assert estimate is None or estimate.std_s >= 0.0


def test_mutated_query_leaves_the_journal_intact(tmp_path: Path) -> None:
    chance = random.Random(8)
    with closing(Journal(tmp_path / "journal.sqlite", lambda: 1, 0, 10**7)) as journal:
        server = JournalServer("FF-01", journal)
        good = b"epoch=1;from=1;to=9;max=10;bytes=100"
        for _ in range(COUNT // 20):
            what = chance.choice(("index", "range", "urgent", "acknowledge", "what?"))
            parameters = mutated(chance, good).decode("latin-1")
            list(server.replies(f"muster/v1/FF-01/journal/{what}", parameters, b""))
        [index] = server.replies("muster/v1/FF-01/journal/index", "", b"")
        assert JournalIndex.from_bytes(index).boots == ()


def test_mutated_reply_leaves_the_backfill_intact() -> None:
    chance = random.Random(9)
    entries = tuple(JournalEntry(seq, POSITION.suffix, b"x" * 20) for seq in range(1, 4))
    chunk = JournalChunk(7, 1, 3, entries).to_bytes()
    index = JournalIndex((JournalBoot(7, 1, 3, 0, 0),)).to_bytes()
    for _ in range(COUNT // 4):
        for kind, good in ((JournalChunk, chunk), (JournalIndex, index)):
            with suppress(WireError):
                kind.from_bytes(mutated(chance, good))
