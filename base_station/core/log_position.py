"""Places in a log, which two stations share record by record."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from base_station.core.events import is_decision
from shared.mcap_log.schemas import is_derived

Record = tuple[int, str, bytes]  # station time, key, payload


class LogPosition(NamedTuple):
    """Behind an event: its time, and how many events had that time so far.

    Only events count.  Decisions of a station follow from them, and are made again when they are
    stepped.
    """

    t_ns: int
    events: int

    def next(self, t_ns: int) -> LogPosition:
        """Behind the next event, of that time."""
        return LogPosition(t_ns, self.events + 1 if t_ns == self.t_ns else 1)


START = LogPosition(0, 0)


def is_event(key: str) -> bool:
    return not is_decision(key) and not is_derived(key)


def events_after(place: LogPosition, records: Iterable[Record]) -> Iterator[Record]:
    """The events behind a place, of records that begin with its time or earlier."""
    here = START
    for record in records:
        if is_event(record[1]):
            here = here.next(record[0])
            if here > place:
                yield record
