"""Fetches from the units' journals what the radio lost (protocol: docs/journal.md).

The drive says about once a second which sequence numbers it has (``report``); a thread of
this module asks the units for the rest, one query at a time, so that live data is never held up
behind it, and hands what comes to the feed, in order.  What the station has safely on its own
disk is acknowledged, so that the unit may forget it when it needs the room.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator, Mapping
from threading import Condition, Thread
from typing import NamedTuple

from base_station.pace import Pace
from shared.bus import Bus
from shared.channels import ROOT, backfilled_key
from shared.clock import NS_PER_S, Clock
from shared.errors import BusError, WireError
from shared.messages import JournalChunk, JournalIndex
from shared.sequence_set import Run, SequenceSet

logger = logging.getLogger(__name__)

_INDEX_EVERY_NS = 30 * NS_PER_S
_SETTLED_REPORTS = 2  # a number missing in so many reports in a row is lost, not under way
_TIMEOUT_S = 10.0
_REPLY_BYTES = 8192  # at most, so that what comes first can be stored first

Deliver = Callable[[str, bytes], None]  # key, payload; waits while the feed is full


class Held(NamedTuple):
    """What the station has of one boot of one unit."""

    boot_id: int
    runs: tuple[Run, ...]


Report = Mapping[str, tuple[Held, ...]]  # by unit, of units that are linked


class Gap(NamedTuple):
    unit_id: str
    boot_id: int
    first: int
    last: int


class Backfill:
    """``start`` it with a bus; ``report`` may be called from any thread and never waits."""

    def __init__(self, bus: Bus, deliver: Deliver, clock: Clock) -> None:
        self._bus = bus
        self._deliver = deliver
        self._journals: dict[str, _Journal] = {}
        self._clock = clock
        self._news = Condition()
        self._report: Report | None = None
        self._closed = False
        self._thread = Thread(target=self._run, name="backfill", daemon=True)
        self.fetched = 0  # messages brought so far
        self.gone = 0  # numbers that no journal has any more

    def start(self) -> None:
        self._thread.start()

    def report(self, report: Report) -> None:
        """Say what the station has now; an older report that was not looked at is forgotten."""
        with self._news:
            self._report = report
            self._news.notify()

    def close(self) -> None:
        with self._news:
            self._closed = True
            self._news.notify()
        self._thread.join()

    def _run(self) -> None:
        while (report := self._next_report()) is not None:
            for unit_id, held in report.items():
                if self._closed:
                    return
                try:
                    self._serve(unit_id, held)
                except (BusError, WireError) as error:
                    logger.warning("the journal of %s cannot be read: %s", unit_id, error)

    def _next_report(self) -> Report | None:
        with self._news:
            while self._report is None and not self._closed:
                self._news.wait()
            report, self._report = self._report, None
            return None if self._closed else report

    def _serve(self, unit_id: str, held: tuple[Held, ...]) -> None:
        journal = self._journals.setdefault(unit_id, _Journal(unit_id))
        now_ns = self._clock.monotonic_ns()
        if journal.is_due(held, now_ns):
            for reply in self._ask(unit_id, "index", {}):
                journal.learn(JournalIndex.from_bytes(reply), now_ns)
        for gap in journal.settled_gaps(held):
            self._fetch(journal, gap)
        for boot_id, last in journal.safe(held):
            for reply in self._ask(unit_id, "acknowledge", {"epoch": boot_id, "to": last}):
                journal.learn(JournalIndex.from_bytes(reply), now_ns)

    def _fetch(self, journal: _Journal, gap: Gap) -> None:
        first = gap.first
        while first <= gap.last:
            asked_from = first
            question = {"epoch": gap.boot_id, "from": first, "to": gap.last}
            total = journal.pace.answer_bytes
            limits = {"total": total, "bytes": min(total, _REPLY_BYTES)}
            asked_ns = self._clock.monotonic_ns()
            for reply in self._ask(gap.unit_id, "range", question | limits):
                chunk = JournalChunk.from_bytes(reply)
                for entry in chunk.entries:
                    self._deliver(backfilled_key(gap.unit_id, entry.suffix), entry.payload)
                self.fetched += len(chunk.entries)
                self.gone += journal.account(chunk)
                first = chunk.to_seq + 1
            if first == asked_from:
                journal.pace.note_nothing()
                return  # the unit has gone again; what is still missing stands in a later report
            if self._closed:
                return
            journal.pace.note(self._clock.monotonic_ns() - asked_ns)

    def _ask(self, unit_id: str, what: str, parameters: Mapping[str, int]) -> Iterator[bytes]:
        question = ";".join(f"{name}={value}" for name, value in parameters.items())
        selector = f"{ROOT}/{unit_id}/journal/{what}" + (f"?{question}" if question else "")
        yield from self._bus.query(selector, b"", _TIMEOUT_S)


class _Journal:
    """What is known of one unit's journal."""

    def __init__(self, unit_id: str) -> None:
        self.pace = Pace()
        self._unit_id = unit_id
        self._index = JournalIndex(())
        self._asked_ns: int | None = None
        self._accounted: dict[int, SequenceSet] = {}  # fetched or gone, by boot
        self._gaps_before: list[set[Gap]] = []
        self._complete_before: dict[int, int] = {}
        self._acknowledged: dict[int, int] = {}

    def is_due(self, held: tuple[Held, ...], now_ns: int) -> bool:
        """The index is asked for now and then, and when the unit's program has started again."""
        known = {boot.boot_id for boot in self._index.boots}
        if self._asked_ns is None or any(one.boot_id not in known for one in held):
            return True
        return now_ns - self._asked_ns >= _INDEX_EVERY_NS

    def learn(self, index: JournalIndex, now_ns: int) -> None:
        self._index, self._asked_ns = index, now_ns

    def account(self, chunk: JournalChunk) -> int:
        """Note what a reply accounts for; how many of its numbers are gone for ever."""
        accounted = self._accounted.setdefault(chunk.boot_id, SequenceSet())
        accounted.add_run(Run(chunk.from_seq, chunk.to_seq))
        return chunk.to_seq - chunk.from_seq + 1 - len(chunk.entries)

    def settled_gaps(self, held: tuple[Held, ...]) -> list[Gap]:
        """What was missing in this report and in those before it, oldest boot first."""
        gaps = list(self._gaps(held))
        self._gaps_before = [*self._gaps_before[-_SETTLED_REPORTS + 1 :], set(gaps)]
        if len(self._gaps_before) < _SETTLED_REPORTS:
            return []
        return [gap for gap in gaps if all(gap in before for before in self._gaps_before)]

    def safe(self, held: tuple[Held, ...]) -> list[tuple[int, int]]:
        """Boots and the number up to which all of it was there a report ago, so on disk by now;
        only what was not acknowledged yet.
        """
        complete = {one.boot_id: self._complete_to(one) for one in held}
        safe = [
            (boot_id, min(last, self._complete_before.get(boot_id, 0)))
            for boot_id, last in complete.items()
        ]
        self._complete_before = complete
        news = [(boot, last) for boot, last in safe if last > self._acknowledged.get(boot, 0)]
        self._acknowledged.update(news)
        return news

    def _gaps(self, held: tuple[Held, ...]) -> Iterator[Gap]:
        runs_of = {one.boot_id: one.runs for one in held}
        for boot in self._index.boots:
            runs = runs_of.get(boot.boot_id, ())
            newest = max(boot.last_seq, runs[-1].last if runs else 0)
            have = self._have(boot.boot_id, runs)
            for run in have.missing(boot.first_seq, newest):
                yield Gap(self._unit_id, boot.boot_id, run.first, run.last)

    def _complete_to(self, one: Held) -> int:
        return self._have(one.boot_id, one.runs).complete_to(1)

    def _have(self, boot_id: int, runs: tuple[Run, ...]) -> SequenceSet:
        have = SequenceSet([run.first for run in runs], [run.last for run in runs])
        for run in self._accounted.get(boot_id, SequenceSet()).runs():
            have.add_run(run)
        return have
