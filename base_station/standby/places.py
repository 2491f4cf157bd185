"""Places in a log, which two stations share record by record."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from base_station.past.playback import is_decision
from shared.mcap_log import is_derived

Record = tuple[int, str, bytes]  # station time, key, payload


class Place(NamedTuple):
    """Behind an event: its time, and how many events had that time so far.

    Only events count.  What a station decides follows from them, and is made again by whoever
    steps them.
    """

    t_ns: int
    events: int

    def then(self, t_ns: int) -> Place:
        """Behind the next event, of that time."""
        return Place(t_ns, self.events + 1 if t_ns == self.t_ns else 1)


BEGINNING = Place(0, 0)


def is_event(key: str) -> bool:
    return not is_decision(key) and not is_derived(key)


def events_behind(place: Place, records: Iterable[Record]) -> Iterator[Record]:
    """The events behind a place, of records that begin with its time or earlier."""
    here = BEGINNING
    for record in records:
        if is_event(record[1]):
            here = here.then(record[0])
            if here > place:
                yield record
