"""Hand-over of erasures: an erasure is ordered in the log, and only the station that leads writes
there.  What was requested of a station that follows by now is fetched, and ordered, by the leader;
and what a leader that is lost has ordered and not finished is ordered again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from threading import Event

import msgspec

from base_station.standby.protocol import pack, unpack
from base_station.standby.rpc import RpcServer, ask
from base_station.storage.db.unfinished_erasures import UnfinishedErasure
from shared.bus import Bus


class WaitingErasure(msgspec.Struct, frozen=True):
    """Erasure that was requested of a station that cannot order it."""

    request_id: str
    kind: str  # "person" or "incident"
    subject_id: str


class ErasureServer(RpcServer):
    """Serves ``erasures``: those that wait here for a leader."""

    def __init__(
        self, station: str, bus: Bus, waiting: Callable[[], Iterable[WaitingErasure]]
    ) -> None:
        self._waiting = waiting
        super().__init__(station, bus, {"erasures": self._erasures})

    def _erasures(self, _key: str, _parameters: str, _payload: bytes) -> Iterator[bytes]:
        for one in self._waiting():
            yield pack(one)


class ErasureHandover:
    """Takes over the erasures that another station has not finished, in rounds, each once."""

    def __init__(
        self,
        bus: Bus,
        leads: Callable[[], bool],
        other: Callable[[], str | None],
        unfinished: Callable[[], Iterable[UnfinishedErasure]],
        take: Callable[[str], None],
    ) -> None:
        """``other``: the other station, where it answers.  ``unfinished``: orders of former
        leaders, as the log has them.  ``take`` receives "person ID" or "incident ID", and again if
        it raises.
        """
        self._bus = bus
        self._leads = leads
        self._other = other
        self._unfinished = unfinished
        self._take = take
        self._taken: set[str] = set()  # by request or order

    def run_round(self, _stop: Event) -> None:
        """Take over each new request and order.  Raises MusterError where a store fails,
        or the other station's answer makes no sense.
        """
        if not self._leads():
            return
        for left in self._unfinished():
            self._take_once(left.order_id, left.subject)
        station = self._other()
        if station is None:
            return
        for answer in ask(self._bus, station, "erasures"):
            one = unpack(answer, WaitingErasure)
            self._take_once(one.request_id, f"{one.kind} {one.subject_id}")

    def _take_once(self, request_id: str, subject: str) -> None:
        if request_id not in self._taken:
            self._take(subject)
            self._taken.add(request_id)
