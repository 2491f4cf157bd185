"""Client of one unit's journal: received messages, and the next query.  Pure: input are reports and
replies, output are queries.  The index of the journal is queried for the newest runs of the unit's
program, then for more, in sizes that the link carries: there may be thousands.  Alerts are queried
as soon as a number is missing; other messages when they have been missing for a whole report,
newest first and in pieces that the link carries.  Messages that are durable on the station's disk
are acknowledged, so that the unit may delete them when it needs the room.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import msgspec

from base_station.core.state.message_stream import BOOTS_KEPT
from base_station.unit_sync.adaptive_chunk_size import LEAST_BYTES, AdaptiveChunkSize
from shared.clock import NS_PER_S
from shared.errors import WireError
from shared.messages import JournalChunk, JournalEntry, JournalIndex
from shared.sequence_set import Run, SequenceSet

_INDEX_EVERY_NS = 30 * NS_PER_S
_INDEX_MORE_NS = NS_PER_S  # where the journal may have more runs than were queried
_INDEXED_BYTES = 32  # of each run in an index
_ACKNOWLEDGE_EVERY_NS = 10 * NS_PER_S  # of one run; the answer names all of them
_SAFE_REPORTS = 3  # complete for so many reports: on the disk, of both stations where there are two
_REPLY_BYTES = 8192  # at most, so that the first messages can be stored first
_NUMBER_BYTES = 100.0  # of a message, assumed before the first reply
_EVICTED_BYTES = 0.1  # where the journal has none of them any more
_OVERHEAD_BYTES = 24  # beside its payload, as the unit counts them
_PIECE_SHARE = 0.8  # of a reply; the rest takes another query
_LEARN_SHARE = 0.02
_BRIDGED = 4  # received messages between two gaps, repeated instead of another query


class Held(NamedTuple):
    """Messages of one boot of one unit that the station has."""

    boot_id: int
    runs: tuple[Run, ...]


class Question(NamedTuple):
    what: str
    parameters: tuple[tuple[str, int], ...] = ()
    urgent: bool = False

    @property
    def max_bytes(self) -> int:
        """Limit of the bytes of messages in the reply."""
        return dict(self.parameters).get("total", 0)

    @property
    def selector(self) -> str:
        """Behind ``muster/v1/{unit}/journal/``."""
        parameters = ";".join(f"{name}={value}" for name, value in self.parameters)
        return f"{self.what}?{parameters}" if parameters else self.what


class _Boot:
    """One run of the unit's program."""

    def __init__(self) -> None:
        self.held = SequenceSet()  # by the last report
        self._fetched = SequenceSet()  # or gone for ever
        self._evicted = SequenceSet()  # those of these that the journal has no more
        self._without_alert = SequenceSet()  # all alerts among them were fetched
        self._have = SequenceSet()  # held or fetched
        self._known = SequenceSet()  # held, fetched or without an alert
        self.first = 1  # the oldest that the journal has
        self.newest = 0  # that is known of
        self._settled_to = 0  # a number up to here that is missing is lost, not under way
        self.unanswered: int | None = None  # start of the last query for alerts without reply
        self.complete: deque[int] = deque(maxlen=_SAFE_REPORTS)
        self.acknowledged = 0
        self.acknowledge_due_ns = 0

    def report(self, runs: tuple[Run, ...], *, safe: bool) -> None:
        self.held = SequenceSet([run.first for run in runs], [run.last for run in runs])
        self._have = _union(self.held, self._fetched)
        self._known = _union(self._have, self._without_alert)
        self._settled_to = self.newest
        self.newest = max(self.newest, runs[-1].last if runs else 0)
        if safe:
            # Fetched messages may still wait to be written, and are held by a later report.
            self.complete.append(_union(self.held, self._evicted).complete_to(self.first))

    def note_fetched(self, run: Run) -> None:
        """Note that all messages of the run in the journal were received."""
        for one in (self._fetched, self._have, self._known):
            one.add_run(run)

    def note_evicted(self, run: Run, entries: tuple[JournalEntry, ...]) -> None:
        """Note the numbers that the journal still has; all others of the run are lost."""
        there = SequenceSet()
        for entry in entries:
            there.add(entry.seq)
        for gone in there.missing(run.first, run.last):
            self._evicted.add_run(gone)

    def new(self, entries: tuple[JournalEntry, ...]) -> tuple[JournalEntry, ...]:
        """Return the numbers that were not received yet."""
        return tuple(one for one in entries if one.seq not in self._have)

    def note_without_alert(self, run: Run) -> None:
        """Note that all alerts of the run in the journal were received."""
        for one in (self._without_alert, self._known):
            one.add_run(run)

    def piece(self, count: int) -> Run | None:
        """Return the newest missing range that is not under way, with a bounded number of messages;
        it may include a few received ones instead of a query for each gap.
        """
        lost = self._have.newest_missing(self.first, self._answered_to(self._settled_to))
        if lost is None:
            return None
        last, least = lost.last, lost.last - count + 1
        first = max(lost.first, least)
        while first > least:
            lost = self._have.newest_missing(self.first, first - 1)
            if lost is None or lost.last < max(first - 1 - _BRIDGED, least):
                break
            first = max(lost.first, least)
        return Run(first, last)

    def start_over(self) -> None:
        """Forget fetched messages, because not all of them are in the log."""
        self._fetched = SequenceSet()
        self._evicted = SequenceSet()
        self._without_alert = SequenceSet()
        self._have = _union(self.held, self._fetched)
        self._known = _union(self.held, self._fetched)
        self.complete.clear()

    def may_have_alerts(self) -> Run | None:
        """Range in which an alert may be missing.  An alert is sent ahead of all but other alerts.
        So a missing number before any received one is lost, and so are numbers sent long ago, such
        as the last ones of a run that ended without a link.
        """
        last = max(self.held.lasts[-1], self._settled_to) if self.held.lasts else self.newest
        newest = self._known.newest_missing(self.first, self._answered_to(last))
        if newest is None:
            return None
        return Run(self._known.complete_to(self.first) + 1, newest.last)

    def _answered_to(self, last: int) -> int:
        return last if self.unanswered is None else min(last, self.unanswered - 1)


class JournalClient:
    """Call ``report`` with the received messages, send the ``next_question``, and pass its replies
    to ``take`` and ``end``.
    """

    def __init__(self) -> None:
        self._boots: dict[int, _Boot] = {}
        self._indexed: dict[int, None] = {}  # oldest boot first
        self._reported_ns = 0
        self._index_due_ns = 0
        self._pace = AdaptiveChunkSize()
        self._index_pace = AdaptiveChunkSize()
        self._number_bytes = _NUMBER_BYTES
        self._came_bytes = 0  # in answer to the question that is being answered
        self._has_more = False  # the journal may have more runs than the last index
        self._valid_replies = 0  # to that query
        self._silent = False  # no valid reply: no query before the next report
        self._acknowledging: tuple[_Boot, int] | None = None
        self._alerts_only = False
        self.gone = 0  # numbers that no journal has any more

    def report(self, held: tuple[Held, ...], now_ns: int, *, alerts_only: bool = False) -> None:
        """Take a report of the station.  ``held``: the running run last; ``now_ns``: monotonic.
        The index is queried at intervals, and until it has the running run.  ``alerts_only``: the
        station's disk is full or hangs, so no backlog is fetched.
        """
        self._silent = False
        self._alerts_only = alerts_only
        self._reported_ns = now_ns
        runs_of = {one.boot_id: one.runs for one in held}
        known = dict.fromkeys((*self._indexed, *runs_of))
        self._boots = {boot_id: self._boots.get(boot_id) or _Boot() for boot_id in known}
        for boot_id, boot in self._boots.items():
            boot.report(runs_of.get(boot_id, ()), safe=not alerts_only)
        is_new = bool(held) and held[-1].boot_id not in self._indexed
        if now_ns >= self._index_due_ns or is_new:
            self._index_due_ns = 0

    def note_new_link(self) -> None:
        """Note a new link, whose capacity is unknown."""
        self._pace, self._index_pace = AdaptiveChunkSize(), AdaptiveChunkSize()

    def start_over(self) -> None:
        """Forget fetched messages: only reported ones count from now on."""
        for boot in self._boots.values():
            boot.start_over()

    def next_question(self) -> Question | None:
        """Return the next query; None: none before the next report."""
        if self._silent:
            return None
        if self._index_due_ns == 0:
            return Question("index", (("newest", self._indexed_at_once),), urgent=True)
        asked = self._ask_missing() or self._ask_unanswered()
        return asked if asked or self._alerts_only else self._acknowledge()

    def take(self, question: Question, reply: bytes, now_ns: int) -> JournalChunk | None:
        """Take one reply; returns the messages to keep.  Raises WireError where it is not valid, or
        no reply to this query.
        """
        if question.what in ("index", "acknowledge"):
            index = JournalIndex.from_bytes(reply)
            if question.what == "index":
                self._came_bytes += len(reply)
                self._learn(index, now_ns, dict(question.parameters)["newest"])
            self._valid_replies += 1
            return None
        chunk = JournalChunk.from_bytes(reply)
        if not _answers(question, chunk):
            raise WireError(f"boot {chunk.boot_id:x} from {chunk.from_seq} was not asked for")
        self._valid_replies += 1
        boot = self._boots.setdefault(chunk.boot_id, _Boot())
        run, new = Run(chunk.from_seq, chunk.to_seq), boot.new(chunk.entries)
        if chunk.urgent_only:
            boot.note_without_alert(run)
            for entry in chunk.entries:
                boot.note_fetched(Run(entry.seq, entry.seq))
        else:
            boot.note_fetched(run)
            boot.note_evicted(run, chunk.entries)
            self._note_size(chunk)
        return msgspec.structs.replace(chunk, entries=new)

    def end(self, question: Question, took_ns: int) -> None:
        """End a query: no more replies come."""
        valid, self._valid_replies = self._valid_replies, 0
        came_bytes, self._came_bytes = self._came_bytes, 0
        self._note_answered(question, valid)
        if question.what == "index":
            self._note_index(question, came_bytes, took_ns)
        if not valid:
            self._silent = True
            if question.what == "range":
                self._pace.note_timeout()
        elif question.what == "range":
            self._pace.note(came_bytes, took_ns)
        elif question.what == "acknowledge" and self._acknowledging is not None:
            boot, last = self._acknowledging
            boot.acknowledged = last
            boot.acknowledge_due_ns = self._reported_ns + _ACKNOWLEDGE_EVERY_NS
        self._acknowledging = None

    def _note_size(self, chunk: JournalChunk) -> None:
        numbers = chunk.to_seq - chunk.from_seq + 1
        came_bytes = sum(len(entry.payload) + _OVERHEAD_BYTES for entry in chunk.entries)
        share = 1.0 - (1.0 - _LEARN_SHARE) ** numbers
        learnt = self._number_bytes + share * (came_bytes / numbers - self._number_bytes)
        self._number_bytes = max(learnt, _EVICTED_BYTES)
        self._came_bytes += came_bytes
        self.gone += numbers - len(chunk.entries)

    @property
    def _indexed_at_once(self) -> int:
        return min(self._index_pace.answer_bytes // _INDEXED_BYTES, BOOTS_KEPT)

    def _note_index(self, question: Question, came_bytes: int, took_ns: int) -> None:
        if not came_bytes:
            self._index_pace.note_timeout()
            return
        self._index_pace.note(came_bytes, took_ns)
        if self._has_more and self._indexed_at_once > dict(question.parameters)["newest"]:
            self._index_due_ns = self._reported_ns + _INDEX_MORE_NS

    def _learn(self, index: JournalIndex, now_ns: int, asked: int) -> None:
        """Take an index of runs.  Two machines under one name both reply.  An index has no runs
        older than those of the query.
        """
        self._index_due_ns = now_ns + _INDEX_EVERY_NS
        has_more, is_first = len(index.boots) >= asked, self._valid_replies == 0
        self._has_more = has_more or (self._has_more and not is_first)
        before = self._indexed if has_more or not is_first else {}
        newest = index.boots[-BOOTS_KEPT:]
        named = {one.boot_id: None for one in newest}
        known = [*(one for one in before if one not in named), *named]
        self._indexed = dict.fromkeys(known[-BOOTS_KEPT:])
        for one in newest:
            boot = self._boots.setdefault(one.boot_id, _Boot())
            boot.first = one.first_seq
            boot.newest = max(boot.newest, one.last_seq)

    def _newest_first(self) -> Iterator[tuple[int, _Boot]]:
        return ((boot_id, self._boots[boot_id]) for boot_id in reversed(self._indexed))

    def _note_answered(self, question: Question, valid: int) -> None:
        """Note a reply to a query for alerts.  A unit may have messages that its disk does not take
        yet, and can send them only later.  So a query without a reply is followed by one for
        earlier numbers.
        """
        asked = dict(question.parameters)
        boot = self._boots.get(asked["epoch"]) if "from" in asked else None
        if boot is not None:
            boot.unanswered = None if valid or question.what != "urgent" else asked["from"]

    def _ask_missing(self) -> Question | None:
        asked = self._ask_alerts()
        return asked if asked or self._alerts_only else self._ask_piece()

    def _ask_unanswered(self) -> Question | None:
        """Query again for alerts without a reply; there is nothing else to query."""
        for boot in self._boots.values():
            boot.unanswered = None
        return self._ask_missing()

    def _ask_alerts(self) -> Question | None:
        for boot_id, boot in self._newest_first():
            span = boot.may_have_alerts()
            if span is not None:
                return _range("urgent", boot_id, span, LEAST_BYTES, urgent=True)
        return None

    def _ask_piece(self) -> Question | None:
        """Query for the newest piece of the newest boot, because the latest actions matter most."""
        total = self._pace.answer_bytes
        count = max(1, int(_PIECE_SHARE * total / self._number_bytes))
        for boot_id, boot in self._newest_first():
            piece = boot.piece(count)
            if piece is not None:
                return _range("range", boot_id, piece, total)
        return None

    def _acknowledge(self) -> Question | None:
        for boot_id, boot in self._newest_first():
            is_due = self._reported_ns >= boot.acknowledge_due_ns
            safe = min(boot.complete) if is_due and len(boot.complete) == _SAFE_REPORTS else 0
            if safe > boot.acknowledged:
                self._acknowledging = boot, safe
                parameters = (("epoch", boot_id), ("to", safe), ("newest", 0))
                return Question("acknowledge", parameters)
        return None


def _range(what: str, boot_id: int, run: Run, total: int, *, urgent: bool = False) -> Question:
    parameters = {"epoch": boot_id, "from": run.first, "to": run.last, "total": total}
    parameters["bytes"] = min(total, _REPLY_BYTES)
    return Question(what, tuple(parameters.items()), urgent)


def _answers(question: Question, chunk: JournalChunk) -> bool:
    asked = dict(question.parameters)
    run = asked["from"] <= chunk.from_seq <= chunk.to_seq <= asked["to"]
    seqs = [chunk.from_seq - 1, *(entry.seq for entry in chunk.entries), chunk.to_seq + 1]
    in_order = all(one < other for one, other in pairwise(seqs))
    return chunk.boot_id == asked["epoch"] and run and in_order


def _union(one: SequenceSet, other: SequenceSet) -> SequenceSet:
    both = SequenceSet([*one.firsts], [*one.lasts])
    for run in other.runs():
        both.add_run(run)
    return both
