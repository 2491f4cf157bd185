"""Moves a pipeline through a recorded window of the log.  No threads and no clock.

A playback only reads: it has a pipeline of its own, and nothing of what that decides goes to the
log, the store or the bus.  ``compare`` steps a log and holds what comes out against what the
live station had decided, one by one.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import takewhile

import msgspec

from base_station.core.checkpoint import Checkpoint, read_checkpoint
from base_station.core.events import Output, Received, StationEvent, event_of, is_decision
from base_station.core.pipeline import StationPipeline
from base_station.replay.record_gaps import LONGEST_NS, RecordGap, UnrecordedTime
from base_station.storage.checkpoints import Checkpoints, SavedState
from shared.codec import encode
from shared.coded_text import NO_CODE
from shared.messages import AlarmChange, FusedPosition
from shared.messages.alarm import NO_PARAMETERS

Record = tuple[int, str, bytes]  # station time, key, payload
OpenLog = Callable[[int], Iterable[Record]]  # from a station time on, in the order of writing
# From a log time on, until before another one; topics, or None: all that happened and was decided.
ReadLog = Callable[[int, int | None, Collection[str] | None], Iterator[Record]]
MakePipeline = Callable[[Checkpoint | None], StationPipeline]
# The returned function gives True if the log was rewritten since.
Watch = Callable[[], Callable[[], bool]]
Decision = FusedPosition | AlarmChange

BURST = 1000  # events
SAVED_APART = 100_000  # events; a seek backwards steps at most so many, in some seconds


@dataclass(frozen=True)
class Archive:
    """Sources of a playback: log, checkpoints, and the pipeline's factory."""

    open_log: OpenLog
    checkpoints: Checkpoints
    make_pipeline: MakePipeline
    watch: Watch = lambda: lambda: False
    own: Checkpoints | None = None  # where a playback saves the states that it comes by
    # Differences to the original log that are known so far, in words.
    flaws: Callable[[], Sequence[str]] = tuple
    # Checks a little more of the log for defects; False: all of it is checked.
    check_next_chunk: Callable[[], bool] = lambda: False
    note: Callable[[str], object] = lambda _: None  # a defect that another reader has found
    console: ReadLog | None = None  # recorded content of consoles; None: it is computed again
    has_lost: Callable[[int], bool] = lambda _: False  # whether the log had records of that time

    def latest(self, until_ns: int | None = None, after_ns: int = -1) -> SavedState | None:
        """The newest state that was saved of this log, as ``Checkpoints.latest``: its place is
        there, or is known to have been.  Beside a log that was put back from a backup there may be
        later ones, or another's.
        """
        while (saved := self._saved(until_ns, after_ns)) is not None:
            if self._has(saved) or self.has_lost(saved.t_ns):
                return saved
            until_ns = saved.t_ns - 1
        return None

    def resume(self, until_ns: int) -> tuple[StationPipeline, Iterable[Record]]:
        """A pipeline of the newest state at or before ``until_ns``, and the records behind that."""
        saved = self.latest(until_ns)
        if saved is None:
            return self.make_pipeline(None), self.open_log(0)
        records = self.open_log(saved.t_ns)
        pipeline = self.make_pipeline(saved.pipeline)
        return pipeline, _records_behind(records, saved.t_ns, saved.events_at_t)

    def _saved(self, until_ns: int | None, after_ns: int) -> SavedState | None:
        found = self.checkpoints.latest(until_ns, after_ns)
        own = None
        if self.own is not None:
            own = self.own.latest(until_ns, after_ns if found is None else found.t_ns)
        return own or found

    def _has(self, saved: SavedState) -> bool:
        there = takewhile(lambda record: record[0] == saved.t_ns, self.open_log(saved.t_ns))
        return sum(not is_decision(key) for _, key, _ in there) >= saved.events_at_t


class Playback:
    """A pipeline at some time of the log."""

    def __init__(self, archive: Archive) -> None:
        self._archive = archive
        self._pipeline: StationPipeline
        self._events: Iterator[StationEvent]
        self._next: StationEvent | None
        self._at_ns: int
        self._place: tuple[int, int]  # of the last event in the log: its time, and which of that
        self._saved_ns: int  # checkpoints are saved up to there
        self._unsaved: int  # events since
        self._unrecorded: UnrecordedTime | None  # what of it is shown
        self._begin(None)

    @property
    def pipeline(self) -> StationPipeline:
        """Another one after a ``seek``."""
        return self._pipeline

    def seek(self, t_ns: int) -> Iterator[None]:
        """Go to ``t_ns``, back or forth, pausing now and then so that it can be given up."""
        saved = self._archive.latest(t_ns, self._at_ns if t_ns >= self._at_ns else -1)
        if t_ns < self._at_ns or saved is not None:
            self._begin(saved)
        while self.advance(t_ns) is not None:
            yield

    def advance(self, t_ns: int) -> list[Output] | None:
        """Outputs of the next events until ``t_ns``, a burst at most; None: all is done."""
        if self._next is None or self._next.t_ns > t_ns:
            self._at_ns = max(self._at_ns, t_ns)
            return None
        outputs = self._end_unrecorded()
        for _ in range(BURST):
            if self._next is None or self._next.t_ns > t_ns:
                break
            outputs += self._pipeline.step(self._next)
            at_ns = self._at_ns = self._next.t_ns
            self._place = at_ns, self._place[1] + 1 if self._place[0] == at_ns else 1
            self._unsaved += 1
            self._next = next(self._events, None)
        if self._unsaved >= SAVED_APART:
            self._save()
        return outputs

    @property
    def at_ns(self) -> int:
        return self._at_ns

    @property
    def gap(self) -> RecordGap | None:
        """Gap of the record in which the playback stands, or None."""
        from_ns, until_ns = self._place[0], None if self._next is None else self._next.t_ns
        is_one = (self._at_ns if until_ns is None else until_ns) - from_ns > LONGEST_NS
        return RecordGap(from_ns, until_ns) if is_one and self._at_ns > from_ns else None

    def branch(self) -> tuple[StationPipeline, Iterable[Record]] | None:
        """A pipeline of its own that stands where this one does, and the records from there on,
        with decisions that it has made already; None while time is shown that has no records.
        """
        if self._unrecorded is not None:
            return None
        t_ns, events_at_t = self._place
        state = read_checkpoint(self._pipeline.checkpoint())
        return (
            self._archive.make_pipeline(state),
            _records_behind(self._archive.open_log(t_ns), t_ns, events_at_t),
        )

    def show_unrecorded(self) -> list[Output]:
        """In a gap: show everything as old as it is by now, until the next record is stepped."""
        if self.gap is None or self._place[0] == 0:
            return []
        self._unrecorded = self._unrecorded or UnrecordedTime(self._pipeline)
        return self._unrecorded.advance_time(self._at_ns)

    def _end_unrecorded(self) -> list[Output]:
        unrecorded, self._unrecorded = self._unrecorded, None
        return [] if unrecorded is None else unrecorded.roll_back()

    def _begin(self, saved: SavedState | None) -> None:
        """Again, from a checkpoint or from the beginning of the log."""
        self._pipeline = self._archive.make_pipeline(saved.pipeline if saved else None)
        self._place = (saved.t_ns, saved.events_at_t) if saved else (0, 0)
        self._at_ns, skip = self._place
        self._saved_ns, self._unsaved = self._at_ns, 0
        self._unrecorded = None
        self._events = _events(self._archive.open_log(self._at_ns), self._at_ns, skip)
        self._next = next(self._events, None)

    def _save(self) -> None:
        """Save a checkpoint if there is none since the last one."""
        own, since_ns = self._archive.own, self._saved_ns
        self._saved_ns, self._unsaved = self._at_ns, 0
        if own is None or own.is_refused or own.has_any(since_ns, self._at_ns):
            return
        own.save_if_it_can(*self._place, self._pipeline.checkpoint())


@dataclass(frozen=True)
class Difference:
    """Difference between a decision of the replay and that of the live station."""

    logged: Decision | None
    replayed: Decision | None


class Comparison:
    """Steps a log record by record, and holds what is decided against what was."""

    def __init__(self, pipeline: StationPipeline) -> None:
        self._pipeline = pipeline
        self._replayed: deque[Decision] = deque()

    def step(self, record: Record) -> Difference | None:
        """A decision that is not as it was logged."""
        event = event_of(*record)
        if isinstance(event, Received) and isinstance(event.message, Decision):
            again = self._replayed.popleft() if self._replayed else None
            is_same = again is not None and (
                encode(again) == record[2] or _is_older(event.message, again)
            )
            return None if is_same else Difference(event.message, again)
        self._replayed += [o for o in self._pipeline.step(event) if isinstance(o, Decision)]
        return None

    def rest(self) -> Iterator[Difference]:
        """Decisions that were not logged."""
        return (Difference(None, again) for again in self._replayed)


def _is_older(logged: Decision, again: Decision) -> bool:
    """True for the same decision, logged by a version that had not all of today's codes."""
    if isinstance(logged, AlarmChange) and isinstance(again, AlarmChange):
        if logged.code and not logged.reason:  # the station's own reasons had no code
            return msgspec.structs.replace(again, reason="") == logged
        return not logged.code and _as_before_codes(logged, again) == logged
    if isinstance(logged, FusedPosition) and isinstance(again, FusedPosition):
        older = msgspec.structs.replace(again, quality_code=NO_CODE)
        return logged.quality_code == NO_CODE and encode(older) == encode(logged)
    return False


def _as_before_codes(logged: AlarmChange, again: AlarmChange) -> AlarmChange:
    """As of a version whose alarms had other words, no code, no parameters, no reason and no peak;
    the note stood behind the name.
    """
    return msgspec.structs.replace(
        again,
        text=logged.text,
        by=f"{again.by}: {again.note}" if again.note else again.by,
        code="",
        parameters=NO_PARAMETERS,
        reason="",
        note="",
        peak=None,
    )


def compare(records: Iterable[Record], pipeline: StationPipeline) -> Iterator[Difference]:
    """Step a log from its beginning; yields every decision that is not as it was logged."""
    comparison = Comparison(pipeline)
    for record in records:
        difference = comparison.step(record)
        if difference is not None:
            yield difference
    yield from comparison.rest()


def _events(records: Iterable[Record], from_ns: int, skip: int) -> Iterator[StationEvent]:
    """The events behind a checkpoint that has stepped ``skip`` of those at ``from_ns``."""
    behind = _records_behind(records, from_ns, skip)
    return (event_of(*record) for record in behind if not is_decision(record[1]))


def _records_behind(records: Iterable[Record], from_ns: int, skip: int) -> Iterator[Record]:
    for record in records:
        if record[0] == from_ns and skip > 0 and not is_decision(record[1]):
            skip -= 1
        else:
            yield record
