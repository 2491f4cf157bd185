"""Log sender: answers the other station with the log's ancestry, and with its next records."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from itertools import islice

from base_station.core.log_position import LogPosition, Record, events_after
from base_station.engine.log_feed import LogFeed
from base_station.standby.protocol import Batch, LogAncestry, pack
from base_station.standby.rpc import RpcServer
from base_station.standby.shared_log import SharedLog
from shared.bus import Bus

logger = logging.getLogger(__name__)

_BATCH_BYTES = 512 * 1024
_FROM_DISK = 2000  # events in a batch
_WAIT_S = 0.3  # for new events
_GATHER_S = 0.01  # events in quick succession are sent together


class DiskReader:
    """Reader that continues where it stopped, if positions are read in order; for one thread."""

    def __init__(self, disk: LogFeed) -> None:
        self._disk = disk
        self._reading: tuple[LogPosition, Iterator[Record]] | None = None

    def behind(self, place: LogPosition) -> list[Record]:
        """Some of the events behind a place; none: that is all there is."""
        if self._reading is None or self._reading[0] != place:
            self._reading = place, events_after(place, self._disk.records(place.t_ns))
        reader = self._reading[1]
        records = list(islice(reader, _FROM_DISK))
        if not records:  # look for those since it was opened
            reader = events_after(place, self._disk.records(place.t_ns))
            records = list(islice(reader, _FROM_DISK))
        for t_ns, _, _ in records:
            place = place.next(t_ns)
        self._reading = place, reader
        return records


class LogSender(RpcServer):
    def __init__(
        self, station: str, bus: Bus, log: SharedLog, disk: LogFeed, leads: Callable[[], bool]
    ) -> None:
        self._log = log
        self._disk = DiskReader(disk)
        self._leads = leads
        super().__init__(station, bus, {"history": self._history, "records": self._records})

    def _history(self, _key: str, _parameters: str, _payload: bytes) -> Iterator[bytes]:
        if self._leads():
            yield pack(LogAncestry(self._log.log_id, self._log.take_overs, self._log.place))

    def _records(self, _key: str, parameters: str, _payload: bytes) -> Iterator[bytes]:
        """Events behind ``t`` and ``n``; waits a moment for them.  None of a standby."""
        if not self._leads():
            return
        place = place_of(parameters)
        if place is None or place > self._log.place:
            logger.warning("a station asks for what this log does not have: %s", parameters)
            return
        if self._log.wait_beyond(place, _WAIT_S):
            self._log.wait_beyond(self._log.place, _GATHER_S)
        records = self._log.behind(place, _BATCH_BYTES)
        if records is None:
            records = self._disk.behind(place)
        yield pack(Batch(tuple(records)))


def place_of(parameters: str) -> LogPosition | None:
    """``t=TIME;n=EVENTS``; None: it is no place."""
    try:
        values = dict(pair.split("=", 1) for pair in parameters.split(";"))
        return LogPosition(int(values["t"]), int(values["n"]))
    except (KeyError, ValueError):
        return None
