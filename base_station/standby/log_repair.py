"""Repair of the log from the other station, whose disk has the lost events.

Only events are fetched: a replay makes the decisions from them again.
"""

from __future__ import annotations

import logging
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager
from itertools import pairwise
from pathlib import Path
from threading import Event
from typing import Protocol

from base_station.core.log_position import START, LogPosition, Record, is_event
from base_station.engine.log_feed import LogFeed
from base_station.standby.log_sender import DiskReader, place_of
from base_station.standby.protocol import Batch, pack, unpack
from base_station.standby.rpc import RpcServer, ask
from base_station.storage.integrity_checker import IntegrityChecker
from shared.bus import Bus
from shared.errors import BusError, LogError
from shared.mcap_log import SegmentReader, own_segments, rewrite_segment

logger = logging.getLogger(__name__)


class SharedLogFiles(Protocol):
    """The log as files, while a station writes it."""

    @property
    def folder(self) -> Path: ...

    @property
    def rewriting(self) -> AbstractContextManager[object]:
        """Entered while a complete segment is exchanged."""
        ...

    def note_rewritten(self, path: Path) -> None:
        """This segment has another content now."""
        ...


class EventServer(RpcServer):
    """Serves ``events``: this station's log behind a place, whichever station leads."""

    def __init__(self, station: str, bus: Bus, disk: LogFeed) -> None:
        self._disk = DiskReader(disk)
        super().__init__(station, bus, {"events": self._events})

    def _events(self, _key: str, parameters: str, _payload: bytes) -> Iterator[bytes]:
        place = place_of(parameters)
        if place is not None:
            yield pack(Batch(tuple(self._disk.behind(place))))


class LogRepair:
    """Fills in damaged segments in rounds, one a round, while the other station is there."""

    def __init__(
        self,
        bus: Bus,
        files: SharedLogFiles,
        check: IntegrityChecker,
        other: Callable[[], str | None],
        on_mended: Callable[[int], None],
    ) -> None:
        """``on_mended`` receives the end time of a segment that is whole again."""
        self._on_mended = on_mended
        self._bus = bus
        self._files = files
        self._check = check
        self._other = other
        self._tries: Counter[Path] = Counter()
        self._without_events: set[Path] = set()  # nothing that the other one has is missing in them

    def run_round(self, stop: Event) -> None:
        """Repair one damaged segment; ``stop`` ends it early.  Raises MusterError on failure."""
        damaged = {one for one in self._check.damaged if one not in self._without_events}
        station = self._other()
        if not damaged or station is None:
            return
        paths, _ = own_segments(self._files.folder)
        # The start of a segment is known from the one before it.  The segment with the fewest tries
        # is repaired first, so that one that cannot be repaired does not block the others.
        known = {one for before, one in pairwise([None, *paths]) if before not in damaged}
        path = min(damaged & known, key=lambda one: (self._tries[one], one), default=None)
        if path is None:
            return  # a person has moved it away
        behind = _first_event(paths[paths.index(path) + 1 :])
        if behind is None:
            return  # its end is not known yet
        self._tries[path] += 1
        before = _last_place(paths[: paths.index(path)])
        filling = MissingRecordMerger(self._events(station, before, stop), behind)
        with self._files.rewriting:
            changed = rewrite_segment(path, filling, filling.rest)
        if not changed:
            self._without_events.add(path)
            return
        self._files.note_rewritten(path)
        self._check.note_mended(path)
        del self._tries[path]
        logger.warning("%s is mended: what was lost came from %s", path.name, station)
        with SegmentReader(path) as reader:
            self._on_mended(reader.info().end_ns)

    def _events(self, station: str, place: LogPosition, stop: Event) -> Iterator[Record]:
        while not stop.is_set():
            question = f"events?t={place.t_ns};n={place.events}"
            answer = next(iter(ask(self._bus, station, question)), None)
            if answer is None:
                break
            records = unpack(answer, Batch).records
            if not records:
                return
            for record in records:
                place = place.next(record[0])
                yield record
        raise BusError(f"{station} does not answer")


class MissingRecordMerger:
    """Called with each remaining record of a segment, returns it preceded by the events that are
    missing before it; ``rest`` returns those after the last one.
    """

    def __init__(self, theirs: Iterator[Record], behind: Record) -> None:
        """``theirs``: the other log's events from the start of the segment; ``behind``: the first
        event after its end.
        """
        self._theirs = theirs
        self._behind = behind

    def __call__(self, record: Record) -> Sequence[Record]:
        return [*self._up_to(record), record] if is_event(record[1]) else [record]

    def rest(self) -> Sequence[Record]:
        return self._up_to(self._behind)

    def _up_to(self, mine: Record) -> list[Record]:
        missing: list[Record] = []
        for record in self._theirs:
            if record == mine:
                return missing
            if record[0] > mine[0]:
                break
            missing.append(record)
        raise LogError("the other station's log is not the same as this one's: nothing is mended")


def _first_event(paths: Sequence[Path]) -> Record | None:
    for path in paths:
        with SegmentReader(path) as reader:
            for record in reader.records():
                if is_event(record[1]):
                    return record
    return None


def _last_place(paths: Sequence[Path]) -> LogPosition:
    """Behind the last event of the newest of these segments that has any."""
    for path in reversed(paths):
        place = START
        with SegmentReader(path) as reader:
            for t_ns, key, _ in reader.records():
                if is_event(key):
                    place = place.next(t_ns)
        if place != START:
            return place
    return START
