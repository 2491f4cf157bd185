"""Backfill: the station fetches exactly the missing messages, once, and acknowledges what it
has.
"""

from __future__ import annotations

from collections import Counter
from contextlib import closing
from threading import Event
from typing import cast

import pytest

from base_station.unit_sync.adaptive_chunk_size import LEAST_BYTES
from base_station.unit_sync.backfill import AT_ONCE, Backfill, Report
from base_station.unit_sync.journal_client import Held
from edge.storage.journal.journal import Journal, JournalRow
from edge.storage.journal.server import JournalServer
from shared.bus import Bus, ReplyHandler
from shared.bus_memory import MemoryRouter
from shared.channels import EVENT, POSITION, backfilled_key, parse_unread_key
from shared.clock import ManualClock
from shared.codec import encode, header_of
from shared.messages import (
    Header,
    JournalBoot,
    JournalChunk,
    JournalEntry,
    JournalIndex,
    Temperature,
)
from shared.sequence_set import Run
from tests.rig.waiting import PATIENCE_S, until

BOOT = 77


def tell(backfill: Backfill, report: Report, *, alerts_only: bool = False) -> None:
    """Reports in quick succession are merged; the test needs each of them."""
    backfill.report(report, alerts_only=alerts_only)
    until(lambda: backfill._report is None, "the report is looked at")


def reported(number: int) -> bytes:
    """A message of which only the identity counts here."""
    return encode(Temperature(Header("FF-01", BOOT, number, number), 20.0))


class Bench:
    """A unit's journal of ten messages, and a station that backfills from it."""

    def __init__(self, folder, numbers, may_forget=lambda: True):
        router = MemoryRouter()
        self.unit_bus = router.attach_unit()
        self.journal = Journal(folder / "journal.sqlite", lambda: BOOT, 0, 10**9)
        self.journal.append([JournalRow(n, POSITION, n, reported(n)) for n in numbers])
        server = JournalServer("FF-01", self.journal)
        self.questions: list[str] = []  # for ranges
        self.acknowledged: list[str] = []
        self.alert_questions = 0

        def replies(key: str, parameters: str, payload: bytes):
            self.alert_questions += key.endswith("/urgent")
            if key.endswith("/range"):
                self.questions.append(parameters)
            if key.endswith("/acknowledge"):
                self.acknowledged.append(parameters)
            return server.replies(key, parameters, payload)

        self.unit_bus.serve(server.key_expression, replies)
        self.delivered: list[tuple[str, bytes]] = []
        self.clock = ManualClock()
        self.backfill = Backfill(
            router.attach_station(),
            lambda *record: self.delivered.append(record),
            self.clock,
            may_forget,
        )
        self.backfill.start()

    def report(self, *runs: Run, alerts_only: bool = False) -> None:
        tell(self.backfill, {"FF-01": (Held(BOOT, runs),)}, alerts_only=alerts_only)

    @property
    def totals(self) -> list[int]:
        """Bytes of each request."""
        asked = [dict(pair.split("=") for pair in one.split(";")) for one in self.questions]
        return [int(one["total"]) for one in asked]

    @property
    def numbers(self) -> list[int]:
        assert all(key == backfilled_key("FF-01", "up/position") for key, _ in self.delivered)
        headers = [header_of(payload) for _, payload in self.delivered]
        return [header.seq for header in headers if header is not None]


@pytest.fixture
def bench(tmp_path):
    bench = Bench(tmp_path, range(1, 11))
    yield bench
    bench.backfill.close()
    bench.journal.close()


def test_missing_messages_come_newest_gap_first_and_once(tmp_path):
    bench = Bench(tmp_path, range(1, 21))
    bench.report(Run(1, 2), Run(6, 17))
    until(lambda: bench.alert_questions, "the index was taken: numbers up to 20 are known of")
    for _ in range(3):
        bench.report(Run(1, 2), Run(6, 17))
    until(lambda: len(bench.delivered) == 6)
    for _ in range(3):
        bench.report(Run(1, 2), Run(6, 17))
    bench.backfill.close()
    bench.journal.close()
    assert bench.numbers == [18, 19, 20, 3, 4, 5]
    assert bench.backfill.fetched == 6


def test_messages_in_transit_are_not_requested(bench):
    bench.report(Run(1, 4), Run(6, 10))
    for _ in range(3):
        bench.report(Run(1, 10))
    assert bench.delivered == []


def test_alert_is_fetched_though_the_stations_disk_refuses_writes(tmp_path):
    bench = Bench(tmp_path, [1, 2, 3, 5, 6])
    bench.journal.append([JournalRow(4, EVENT, 4, reported(4))])
    for _ in range(4):
        bench.report(Run(1, 2), Run(6, 6), alerts_only=True)
    until(lambda: bench.delivered, "the alert")
    bench.report(Run(1, 2), Run(4, 4), Run(6, 6), alerts_only=True)
    bench.backfill.close()
    bench.journal.close()
    assert bench.delivered == [(backfilled_key("FF-01", EVENT.suffix), reported(4))]
    assert (bench.questions, bench.acknowledged) == ([], [])


def test_complete_station_acknowledges_to_the_unit(bench):
    for _ in range(3):
        bench.report(Run(1, 10))
    until(lambda: bench.journal.pending == 0)


def test_unit_gets_no_acknowledgement_before_it_is_allowed(tmp_path):
    """The standby does not have the message, for example."""
    may_forget: list[bool] = []
    bench = Bench(tmp_path, range(1, 11), lambda: bool(may_forget))
    for _ in range(8):
        bench.report(Run(1, 10))
    assert bench.acknowledged == []
    may_forget.append(True)
    bench.report(Run(1, 10))
    until(lambda: bench.journal.pending == 0)
    bench.backfill.close()
    bench.journal.close()


def test_message_that_the_log_refused_is_requested_again_once():
    """Also where the next report came before the one that reported it was handled."""
    backfill = Backfill(cast("Bus", StubBus()), lambda *_: None, ManualClock())
    starts_over: list[bool] = []
    for reports in (1, 2, 1, 1):
        for _ in range(reports):
            backfill.report({}, refused=min(len(starts_over), 1))
        starts_over.append(backfill._next().start_over)
    assert starts_over == [False, True, False, False]


def test_boot_without_received_messages_is_fetched(bench):
    for _ in range(3):
        tell(bench.backfill, {"FF-01": ()})
    until(lambda: sorted(bench.numbers) == list(range(1, 11)))


def test_numbers_missing_in_the_journal_are_counted_and_not_requested_again(tmp_path):
    bench = Bench(tmp_path, [1, 2, 5, 6])
    for _ in range(5):
        bench.report(Run(1, 2))
    until(lambda: bench.numbers == [5, 6])

    def is_acknowledged() -> bool:
        bench.clock.advance(10.0)
        bench.report(Run(1, 2), Run(5, 6))
        return bench.journal.pending == 0

    until(is_acknowledged)
    assert bench.backfill.gone == 2
    bench.backfill.close()
    bench.journal.close()


def test_first_request_is_small_and_later_ones_grow_with_quick_answers(tmp_path):
    bench = Bench(tmp_path, range(1, 301))
    for _ in range(4):
        bench.report(Run(1, 1))
    until(lambda: len(bench.delivered) == 299)
    bench.backfill.close()
    bench.journal.close()
    totals = bench.totals
    assert totals == [LEAST_BYTES * 2**number for number in range(len(totals))]
    assert len(totals) > 1
    assert sorted(bench.numbers) == list(range(2, 301))


def test_unit_back_from_a_lost_link_gets_a_small_request_first(tmp_path):
    """Its link was good before, and may now be in a cellar."""
    bench = Bench(tmp_path, range(1, 301))
    for _ in range(4):
        bench.report(Run(1, 1))
    until(lambda: len(bench.delivered) == 299)
    before = len(bench.totals)
    tell(bench.backfill, {})
    bench.journal.append([JournalRow(n, POSITION, n, reported(n)) for n in range(301, 402)])
    for _ in range(4):
        bench.report(Run(1, 300), Run(401, 401))
    until(lambda: len(bench.delivered) == 399)
    bench.backfill.close()
    bench.journal.close()
    assert before > 1
    assert bench.totals[before] == LEAST_BYTES


def test_alert_comes_before_the_backlog_that_contains_it(tmp_path):
    bench = Bench(tmp_path, [1])
    entries = [JournalRow(n, POSITION, n, reported(n)) for n in range(2, 1001)]
    entries[498] = JournalRow(500, EVENT, 500, reported(500))
    bench.journal.append(entries)
    for _ in range(4):
        bench.report(Run(1, 1), Run(1000, 1000))
    until(lambda: len(bench.delivered) == 998)
    bench.backfill.close()
    bench.journal.close()
    assert bench.delivered.pop(0) == (backfilled_key("FF-01", "alert/event"), reported(500))
    assert sorted(bench.numbers) == [n for n in range(2, 1000) if n != 500]


class StubBus:
    """A bus that answers when the test lets it."""

    def __init__(self) -> None:
        self.asked: dict[str, ReplyHandler] = {}  # by unit; requests in progress
        self.most = 0
        self.questions: list[tuple[str, str]] = []
        self.first_asked: dict[str, int] = {}  # sequence number, by unit
        self.newest_asked: list[int] = []  # runs in an index request

    def ask(self, selector, payload, timeout_s, on_reply, *, urgent=False):
        unit_id, what = selector.split("/")[2], selector.split("/")[4].partition("?")[0]
        assert unit_id not in self.asked, "one question at a time"
        self.questions.append((unit_id, what))
        self.asked[unit_id] = on_reply
        values = dict(pair.split("=") for pair in selector.partition("?")[2].split(";") if pair)
        self.first_asked[unit_id] = int(values.get("from", 0))
        if what == "index":
            self.newest_asked.append(int(values["newest"]))
        self.most = max(self.most, len(self.asked))

    def answer(self, unit_id: str, *replies: bytes) -> None:
        on_reply = self.asked.pop(unit_id)
        for reply in replies:
            on_reply(reply)
        on_reply(None)


@pytest.fixture
def crowd():
    """Many units, each with a backlog of 100 messages."""
    bus = StubBus()
    backfill = Backfill(cast("Bus", bus), lambda *_: None, ManualClock())
    backfill.start()
    units = [f"FF-{number:02}" for number in range(40)]

    def report() -> None:
        tell(backfill, {unit_id: (Held(BOOT, (Run(101, 101),)),) for unit_id in units})

    report()
    until(lambda: len(bus.asked) == 40)
    index = JournalIndex((JournalBoot(BOOT, 1, 101, 0, 0),)).to_bytes()
    for unit_id in units:
        bus.answer(unit_id, index)
    until(lambda: len(bus.asked) == 40)
    for unit_id in units:
        bus.answer(unit_id, JournalChunk(BOOT, 1, 100, (), urgent_only=True).to_bytes())
    report()
    yield bus, report
    backfill.close()


def test_small_requests_go_to_all_at_once_and_backlogs_to_some(crowd):
    bus, _ = crowd
    assert [what for _, what in bus.questions[:80]] == ["index"] * 40 + ["urgent"] * 40
    until(lambda: len(bus.asked) == AT_ONCE)
    assert {what for _, what in bus.questions[80:]} == {"range"}


def test_units_take_turns_and_a_silent_one_delays_none(crowd):
    bus, _ = crowd
    until(lambda: len(bus.asked) == AT_ONCE)
    silent = next(iter(bus.asked))
    for _ in range(200):
        until(lambda: len(bus.asked) == AT_ONCE)
        unit_id = next(one for one in bus.asked if one != silent)
        first = bus.first_asked[unit_id]
        piece = JournalEntry(first, "up/position", b"one")
        bus.answer(unit_id, JournalChunk(BOOT, first, first, (piece,)).to_bytes())
    turns = Counter(unit_id for unit_id, what in bus.questions if what == "range")
    assert turns.pop(silent) == 1
    assert len(turns) == 39
    assert max(turns.values()) - min(turns.values()) <= 1


def test_unit_without_answer_is_asked_again_at_the_next_report(crowd):
    bus, report = crowd
    until(lambda: len(bus.asked) == AT_ONCE)
    unit_id = next(iter(bus.asked))
    bus.answer(unit_id)
    before = bus.questions.count((unit_id, "range"))
    until(lambda: len(bus.asked) == AT_ONCE, "another one has its turn")
    assert bus.questions.count((unit_id, "range")) == before
    report()
    while unit_id not in bus.asked:
        until(lambda: len(bus.asked) == AT_ONCE)
        if unit_id not in bus.asked:
            bus.answer(next(iter(bus.asked)))
    assert bus.questions.count((unit_id, "range")) == before + 1


def test_alert_overtakes_answers_that_wait_for_delivery():
    bus, go, delivered = StubBus(), Event(), []

    def deliver(key: str, payload: bytes) -> None:
        delivered.append(payload)
        if payload == b"old":
            go.wait()

    def chunk(unit_id: str, payload: bytes, suffix: str, *, urgent_only: bool) -> bytes:
        first = bus.first_asked[unit_id]
        entries = (JournalEntry(first, suffix, payload),)
        return JournalChunk(BOOT, first, 100, entries, urgent_only=urgent_only).to_bytes()

    def report() -> None:
        tell(backfill, {unit_id: (Held(BOOT, (Run(101, 101),)),) for unit_id in "ABC"})

    backfill = Backfill(cast("Bus", bus), deliver, ManualClock())
    backfill.start()
    report()
    until(lambda: len(bus.asked) == 3)
    for unit_id in "ABC":
        bus.answer(unit_id, JournalIndex((JournalBoot(BOOT, 1, 101, 0, 0),)).to_bytes())
    until(lambda: len(bus.asked) == 3)
    for unit_id in "AB":
        bus.answer(unit_id, JournalChunk(BOOT, 1, 100, (), urgent_only=True).to_bytes())
    report()
    until(lambda: [what for _, what in bus.questions].count("range") == 2)
    bus.answer("A", chunk("A", b"old", "up/position", urgent_only=False))
    until(lambda: delivered == [b"old"])
    bus.answer("B", chunk("B", b"old too", "up/position", urgent_only=False))
    bus.answer("C", chunk("C", b"fall", "alert/event", urgent_only=True))
    go.set()
    until(lambda: len(delivered) == 3)
    backfill.close()
    assert delivered == [b"old", b"fall", b"old too"]


def test_answer_time_of_a_unit_depends_on_its_link_alone():
    """While the station also delivers answers of others."""
    handing_over, is_done = Event(), Event()

    def deliver(_key: str, _payload: bytes) -> None:
        handing_over.set()
        assert is_done.wait(PATIENCE_S)

    bus, clock = StubBus(), ManualClock()
    backfill = Backfill(cast("Bus", bus), deliver, clock)
    backfill.start()
    with closing(backfill):
        tell(backfill, {"A": (Held(BOOT, (Run(1, 1), Run(3, 3))),), "B": (Held(32, (Run(1, 1),)),)})
        until(lambda: len(bus.asked) == 2)
        bus.answer("A", JournalIndex((JournalBoot(BOOT, 1, 3, 0, 0),)).to_bytes())
        until(lambda: ("A", "urgent") in bus.questions and "A" in bus.asked)
        fell = JournalEntry(2, "alert/event", b"fell")
        bus.answer("A", JournalChunk(BOOT, 2, 2, (fell,), urgent_only=True).to_bytes())
        assert handing_over.wait(PATIENCE_S)
        boots = tuple(JournalBoot(number, 1, 1, 0, 10**18) for number in range(1, 33))
        bus.answer("B", JournalIndex(boots).to_bytes())
        clock.advance(5.0)
        is_done.set()
        until(lambda: "B" in bus.asked)
        bus.asked.pop("B")(None)

        def asked_again() -> bool:
            tell(backfill, {"B": (Held(32, (Run(1, 1),)),)})
            return "B" in bus.asked

        until(asked_again)
    assert bus.newest_asked == [32, 32, 64]


def test_message_without_header_is_identified_by_its_key(tmp_path):
    bench = Bench(tmp_path, [1])
    rotten = {2: b"rotten", 3: reported(77), 4: b""}
    bench.journal.append([JournalRow(n, POSITION, n, rotten[n]) for n in rotten])
    for _ in range(4):
        bench.report(Run(1, 1))
    until(lambda: len(bench.delivered) == 3)
    bench.backfill.close()
    bench.journal.close()
    keys = {parse_unread_key(key): payload for key, payload in bench.delivered}
    assert keys == {("FF-01", BOOT, n): rotten[n] for n in rotten}


def test_answer_far_beyond_the_request_is_not_kept(monkeypatch):
    monkeypatch.setattr("base_station.unit_sync.backfill._LEAST_KEPT_BYTES", 1000)
    monkeypatch.setattr("base_station.unit_sync.backfill._MOST_CAME", 1)
    bus, delivered = StubBus(), []
    backfill = Backfill(cast("Bus", bus), lambda *one: delivered.append(one), ManualClock())
    backfill.start()
    report = {"A": (Held(BOOT, (Run(101, 101),)),)}
    tell(backfill, report)
    until(lambda: len(bus.asked) == 1)
    bus.answer("A", JournalIndex((JournalBoot(BOOT, 1, 101, 0, 0),)).to_bytes())
    until(lambda: len(bus.asked) == 1)
    chunks = [
        JournalChunk(BOOT, n, n, (JournalEntry(n, "alert/event", bytes(100)),), urgent_only=True)
        for n in range(1, 100)
    ]
    bus.answer("A", *(one.to_bytes() for one in chunks))
    until(lambda: len(bus.questions) == 3, "it is asked for the rest")
    backfill.close()
    assert 0 < len(delivered) < 10
    assert bus.first_asked["A"] == len(delivered) + 1


def test_units_silent_on_alert_requests_block_no_backlog():
    bus = StubBus()
    backfill = Backfill(cast("Bus", bus), lambda *_: None, ManualClock())
    backfill.start()
    units = [f"FF-{number:02}" for number in range(AT_ONCE + 1)]
    index = JournalIndex((JournalBoot(BOOT, 1, 101, 0, 0),)).to_bytes()

    def report() -> None:
        tell(backfill, {unit_id: (Held(BOOT, (Run(101, 101),)),) for unit_id in units})

    report()
    until(lambda: len(bus.asked) == len(units))
    for unit_id in units:
        bus.answer(unit_id, index)
    until(lambda: len(bus.asked) == len(units))
    bus.answer("FF-00", JournalChunk(BOOT, 1, 100, (), urgent_only=True).to_bytes())
    report()
    until(lambda: ("FF-00", "range") in bus.questions)
    backfill.close()


def test_single_failure_of_the_bus_ends_no_backfill(monkeypatch):
    bus, failures = StubBus(), [RuntimeError("can't start new thread")]
    ask = bus.ask

    def fail_once(*arguments, **named) -> None:
        if failures:
            raise failures.pop()
        ask(*arguments, **named)

    monkeypatch.setattr(bus, "ask", fail_once)
    backfill = Backfill(cast("Bus", bus), lambda *_: None, ManualClock())
    backfill.start()
    for _ in range(2):
        tell(backfill, {"A": (Held(BOOT, (Run(101, 101),)),)})
    until(lambda: bus.questions == [("A", "index")])
    backfill.close()
