"""Positions in a log, which are the same on both stations of a pair."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from base_station.core.events import is_decision
from shared.mcap_log.schemas import is_derived

Record = tuple[int, str, bytes]  # station time, key, payload


class LogPosition(NamedTuple):
    """Position behind an event: its time, and the number of events so far with that time.  Only
    events count: a station's decisions are computed from them again.
    """

    t_ns: int
    events: int

    def next(self, t_ns: int) -> LogPosition:
        """Return the position behind the next event, which has that time."""
        return LogPosition(t_ns, self.events + 1 if t_ns == self.t_ns else 1)


START = LogPosition(0, 0)


def is_event(key: str) -> bool:
    return not is_decision(key) and not is_derived(key)


def events_after(place: LogPosition, records: Iterable[Record]) -> Iterator[Record]:
    """Yield the events behind a position, of records that begin at its time or earlier."""
    here = START
    for record in records:
        if is_event(record[1]):
            here = here.next(record[0])
            if here > place:
                yield record
