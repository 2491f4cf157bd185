"""Backfill: fetches messages that the radio lost from the units' journals (protocol:
docs/journal.md).  The engine reports its sequence numbers about once a second (``report``).  One
thread queries the units for the rest in turn: one query a unit, a bounded number of units at once.
Replies go to the feed as they come.  Live data never waits for them: replies travel behind live
data, and enter the feed only while it is nearly empty.
"""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Callable, Mapping
from functools import partial
from threading import Lock
from typing import NamedTuple

from base_station.unit_sync.journal_client import Held, JournalClient, Question
from base_station.unit_sync.journal_rate_limit import JournalRateLimit
from shared.bus import Bus
from shared.channels import ROOT, backfilled_key, unread_key
from shared.clock import Clock
from shared.codec import header_of
from shared.errors import WireError
from shared.messages import JournalEntry
from shared.worker import UNTIL_WOKEN, Worker

logger = logging.getLogger(__name__)

AT_ONCE = 16  # units that are asked for a backlog; of each at most Pace's MOST_BYTES are asked
_TIMEOUT_S = 10.0
_MOST_CAME = 8  # times the requested size; the rest of a longer reply is dropped
_LEAST_KEPT_BYTES = 131_072  # of a reply, also of one to a small query

_URGENT = "urgent"  # a query for alerts alone
_FETCHING = ("range", _URGENT)  # queries for messages
_ALERT = "alert/"  # a key behind the unit begins so

Deliver = Callable[[str, bytes], None]  # key, payload; waits while the feed is full
Report = Mapping[str, tuple[Held, ...]]  # by unit, of units that are linked


class _Request(NamedTuple):
    """A question under way."""

    unit_id: str
    question: Question
    requested_ns: int


class _Input(NamedTuple):
    """Input of the thread since its last round."""

    report: Report | None
    alerts_only: bool  # is to be fetched
    replies: list[tuple[_Request, bytes | None]]  # None: no more come
    start_over: bool


class Backfill:
    """``start`` it with a bus; ``report`` may be called from any thread and never waits."""

    def __init__(
        self,
        bus: Bus,
        deliver: Deliver,
        clock: Clock,
        may_forget: Callable[[], bool] = lambda: True,
    ) -> None:
        """``may_forget``: True if reported messages are durable here, and may be acknowledged."""
        self._bus = bus
        self._may_forget = may_forget
        self._deliver = deliver
        self._clock = clock
        self._journals: dict[str, JournalClient] = {}
        self.share = JournalRateLimit(clock)
        self._turns: deque[str] = deque()  # units that may have something to be asked, by turns
        self._reported: Report = {}
        self._asking: dict[str, _Request] = {}
        self._backlogs = 0  # of these, questions behind live data
        self._came_bytes: dict[str, int] = {}  # of the answer to a unit's question
        self._ended_ns: dict[str, int] = {}  # when such an answer was over, by unit
        self._lock = Lock()  # guards the fields below
        self._report: Report | None = None
        self._urgent: list[tuple[_Request, bytes | None]] = []
        self._replies: deque[tuple[_Request, bytes | None]] = deque()
        self._alerts_only = False
        self._starts_over = False
        self._refused = 0
        self._worker = Worker("backfill", self._step, "messages are not fetched from journals")
        self.fetched = 0  # messages brought so far

    @property
    def gone(self) -> int:
        """Numbers that no journal has any more."""
        return sum(journal.gone for journal in self._journals.values())

    def start(self) -> None:
        self._worker.start()

    def report(self, report: Report, refused: int = 0, *, alerts_only: bool = False) -> None:
        """Report the messages that the station has now; it replaces an unread older report.

        ``refused``: number of records its log has not taken so far.  Where it has grown, fetched
        messages may not have come into the log.  ``alerts_only``: its disk takes nothing, and new
        records may be in memory only.
        """
        with self._lock:
            self._report, self._alerts_only = report, alerts_only
            self._starts_over |= refused > self._refused
            self._refused = refused
        self._worker.wake()

    def close(self) -> None:
        self._worker.close()

    def _step(self) -> float:
        """Take a report and replies, and ask for more."""
        received = self._next()
        if received.start_over:
            for journal in self._journals.values():
                journal.start_over()
        if received.report is not None:
            self._take_report(received.report, alerts_only=received.alerts_only)
        for request, reply in received.replies:
            if self._worker.stopping.is_set():
                return 0.0
            if reply is None:
                self._end(request)
            else:
                self._take(request, reply)
        self._ask_by_turns()
        return 0.0 if self._replies else UNTIL_WOKEN

    def _next(self) -> _Input:
        """Return what is new.  Of replies, all the urgent ones, and one of the others: handing
        that over may take its time.
        """
        with self._lock:
            received = _Input(self._report, self._alerts_only, self._urgent, self._starts_over)
            self._report, self._urgent, self._starts_over = None, [], False
            if self._replies:
                received.replies.append(self._replies.popleft())
            return received

    def _take_report(self, report: Report, *, alerts_only: bool) -> None:
        before, self._reported = self._reported, report
        now_ns = self._clock.monotonic_ns()
        for unit_id, held in report.items():
            journal = self._journals.setdefault(unit_id, JournalClient())
            if unit_id not in before:
                journal.note_new_link()
            journal.report(held, now_ns, alerts_only=alerts_only)
        waiting = [one for one in self._turns if one in report]
        idle = [one for one in report if one not in waiting and one not in self._asking]
        self._turns = deque([*waiting, *idle])

    def _take(self, request: _Request, reply: bytes) -> None:
        journal, is_urgent = self._journals[request.unit_id], request.question.what == _URGENT
        try:
            chunk = journal.take(request.question, reply, self._clock.monotonic_ns())
        except WireError as error:
            logger.warning("the journal of %s cannot be read: %s", request.unit_id, error)
            self.share.note(request.unit_id, len(reply), 0, 0, urgent=is_urgent)
            return
        entries = () if chunk is None else chunk.entries
        alerts = sum(entry.suffix.startswith(_ALERT) for entry in entries)
        self.share.note(request.unit_id, len(reply), len(entries), alerts, urgent=is_urgent)
        if chunk is not None:
            for entry in chunk.entries:
                self._deliver(_key_of(request.unit_id, chunk.boot_id, entry), entry.payload)
            self.fetched += len(chunk.entries)

    def _end(self, request: _Request) -> None:
        del self._asking[request.unit_id]
        self._backlogs -= not request.question.urgent
        # The time of handing over counts, too: it limits the rate of questions.
        now_ns = self._clock.monotonic_ns()
        ended_ns = self._ended_ns[request.unit_id] if request.question.urgent else now_ns
        took_ns = ended_ns - request.requested_ns
        self._journals[request.unit_id].end(request.question, took_ns)
        if request.unit_id in self._reported:
            self._turns.append(request.unit_id)

    def _ask_by_turns(self) -> None:
        """Query for alerts at once, and for a backlog while not too many are being fetched."""
        for _ in range(len(self._turns)):
            unit_id = self._turns.popleft()
            question = self._journals[unit_id].next_question()
            if question is None or (question.what == "acknowledge" and not self._may_forget()):
                continue
            is_held_back = question.what in _FETCHING and not self.share.may_ask(
                unit_id, urgent=question.what == _URGENT
            )
            if is_held_back:
                self._turns.append(unit_id)
            elif question.urgent or self._backlogs < AT_ONCE:
                self._ask(unit_id, question)
            else:
                self._turns.append(unit_id)

    def _ask(self, unit_id: str, question: Question) -> None:
        request = _Request(unit_id, question, self._clock.monotonic_ns())
        self._asking[unit_id] = request
        self._backlogs += not question.urgent
        with self._lock:
            self._came_bytes[unit_id] = 0
        try:
            self._bus.ask(
                f"{ROOT}/{unit_id}/journal/{question.selector}",
                b"",
                _TIMEOUT_S,
                partial(self._note_reply, request),
                urgent=question.urgent,
            )
        except Exception as error:  # noqa: BLE001  # else no journal is asked any more
            logger.warning("the journal of %s cannot be asked: %s", unit_id, error)
            self._note_reply(request, None)

    def _note_reply(self, request: _Request, reply: bytes | None) -> None:
        """Called by a thread of the bus."""
        with self._lock:
            self._ended_ns[request.unit_id] = self._clock.monotonic_ns()
            self._came_bytes[request.unit_id] += len(reply or b"")
            max_bytes = max(_LEAST_KEPT_BYTES, _MOST_CAME * request.question.max_bytes)
            if reply is not None and self._came_bytes[request.unit_id] > max_bytes:
                return  # far more than was asked for
            (self._urgent if request.question.urgent else self._replies).append((request, reply))
        self._worker.wake()


def _key_of(unit_id: str, boot_id: int, entry: JournalEntry) -> str:
    """Key of a fetched message.  One whose header does not identify it carries boot and number in
    its key: else it would be missing again whenever the station starts.
    """
    header = header_of(entry.payload)
    name = None if header is None else (header.unit_id, header.boot_id, header.seq)
    if name == (unit_id, boot_id, entry.seq):
        return backfilled_key(unit_id, entry.suffix)
    return unread_key(unit_id, boot_id, entry.seq, entry.suffix)
