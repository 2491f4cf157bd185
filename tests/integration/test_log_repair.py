"""A log with flipped bits is found, reported, and repaired from the other station's."""

from __future__ import annotations

import random
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from threading import Event

import pytest

from base_station.core.log_position import is_event
from base_station.engine.log_feed import FolderFeed
from base_station.standby.log_repair import EventServer, LogRepair
from base_station.storage.integrity_checker import IntegrityChecker
from base_station.storage.recorder import Recorder
from shared.bus_memory import MemoryRouter
from shared.channels import FUSED, POSITION
from shared.clock import SystemClock
from shared.coded_text import Term
from shared.errors import LogError
from shared.mcap_log import LogRecord, SegmentPolicy, read_log
from shared.messages import STATION_ID

T0 = 1_800_000_000 * 10**9
POLICY = SegmentPolicy(segment_s=1.0, chunk_bytes=4096)
KEY, DECISION = POSITION.key("anna"), FUSED.key(STATION_ID)


def records(luck: int = 1) -> list[LogRecord]:
    """Five seconds: five segments.  Several events have one time, and a decision follows some."""
    chance = random.Random(luck)
    made: list[LogRecord] = []
    for number in range(1000):
        t_ns = T0 + number // 3 * 15_000_000
        made.append((t_ns, KEY, number.to_bytes(4, "big") + chance.randbytes(60)))
        if chance.random() < 0.3:
            made.append((t_ns, DECISION, chance.randbytes(20)))
    return made


class PairedLogs:
    """The logs of two stations, written alike."""

    def __init__(self, folder: Path, closing_all: ExitStack) -> None:
        router = MemoryRouter()
        self.mine, self.theirs = (Recorder(folder / name, SystemClock(), POLICY) for name in "ab")
        for recorder in (self.mine, self.theirs):
            closing_all.callback(recorder.close)
        disk = FolderFeed(self.theirs.folder, self.theirs.flush)
        server = EventServer("b", router.attach_station(), disk)
        closing_all.callback(server.close)
        self.check = IntegrityChecker(Term("restore", "It is mended."))
        self.mended_ns: list[int] = []
        self.other: str | None = "b"
        self.mending = LogRepair(
            router.attach_station(), self.mine, self.check, lambda: self.other,
            self.mended_ns.append,
        )  # fmt: skip

    def write(self, mine: list[LogRecord], theirs: list[LogRecord]) -> None:
        for recorder, all_of in ((self.mine, mine), (self.theirs, theirs)):
            for record in all_of:
                recorder.write(*record)
            recorder.flush()

    def look_at_all(self) -> None:
        for _ in self.mine.segments():
            self.check.check_next_segment(self.mine.segments())

    def events(self) -> list[LogRecord]:
        return [one for one in read_log(self.mine.folder) if is_event(one[1])]

    def damage(self, number: int, at: float, count: int = 1) -> None:
        """Flip bits of the records of a complete segment, from a part of its length on."""
        path = self.mine.segments()[number].path
        content = bytearray(path.read_bytes())
        begin = 100 + int(at * (len(content) * 0.6 - 100))
        for offset in range(begin, begin + count):
            content[offset] ^= 0x10
        path.write_bytes(content)


@pytest.fixture
def pair(tmp_path: Path) -> Iterator[PairedLogs]:
    with ExitStack() as stack:
        yield PairedLogs(tmp_path, stack)


@pytest.mark.parametrize("at", [0.0, 0.3, 0.6, 0.99])
@pytest.mark.parametrize("number", [0, 2])
def test_damaged_segment_is_repaired_from_the_other_station(
    pair: PairedLogs, number: int, at: float
) -> None:
    written = records()
    pair.write(written, written)
    events = [one for one in written if is_event(one[1])]
    pair.damage(number, at, 3000)
    assert pair.events() != events
    pair.look_at_all()
    (reported,) = pair.check.problems()
    assert pair.mine.segments()[number].path.name in reported
    pair.mending.run_round(Event())
    assert pair.events() == events
    assert pair.mended_ns == [pair.mine.segments()[number].end_ns]
    pair.look_at_all()
    assert pair.check.problems() == ()


def test_unopenable_segment_is_replaced_from_the_other_station(pair: PairedLogs) -> None:
    written = records()
    pair.write(written, written)
    path = pair.mine.segments()[1].path
    path.unlink()
    path.symlink_to(path.name)
    pair.look_at_all()
    pair.mending.run_round(Event())
    assert pair.events() == [one for one in written if is_event(one[1])]
    assert pair.check.problems() == ()


def test_log_is_not_repaired_from_another_log(pair: PairedLogs) -> None:
    pair.write(records(), records(luck=2))
    pair.damage(1, 0.3)
    pair.look_at_all()
    before = pair.mine.segments()[1].path.read_bytes()
    with pytest.raises(LogError, match="not the same"):
        pair.mending.run_round(Event())
    assert pair.mine.segments()[1].path.read_bytes() == before
    assert len(pair.check.problems()) == 1


def test_unrepairable_segment_does_not_prevent_other_repairs(pair: PairedLogs) -> None:
    written = records()
    others = [(t_ns, key, b"another") if t_ns < T0 + 10**9 else (t_ns, key, payload)
              for t_ns, key, payload in written]  # fmt: skip
    pair.write(written, others)
    pair.damage(0, 0.3)
    pair.damage(2, 0.3)
    pair.look_at_all()
    whole = [one for one in written if is_event(one[1]) and one[0] >= T0 + 10**9]
    with pytest.raises(LogError, match="not the same"):
        pair.mending.run_round(Event())
    assert not list(pair.mine.folder.glob("*.recovering")), "the room is for the log"
    pair.mending.run_round(Event())
    assert [one for one in pair.events() if one[0] >= T0 + 10**9] == whole
    assert pair.check.damaged == (pair.mine.segments()[0].path,)


def test_consecutive_repaired_segments_contain_every_event_once(pair: PairedLogs) -> None:
    written = records()
    pair.write(written, written)
    for number in (1, 2):
        pair.damage(number, 0.6, 3000)
    pair.look_at_all()
    assert len(pair.check.damaged) == 2
    for _ in range(2):
        pair.mending.run_round(Event())
    assert pair.events() == [one for one in written if is_event(one[1])]
    assert pair.check.problems() == ()


def test_repair_waits_for_the_other_station(pair: PairedLogs) -> None:
    pair.write(records(), records())
    pair.damage(1, 0.3)
    pair.look_at_all()
    pair.other = None
    before = pair.events()
    pair.mending.run_round(Event())
    assert (pair.events(), pair.mended_ns) == (before, [])
