"""Hand-over of erasures: an erasure is ordered in the log, and only the station that leads writes
there.  What was requested of a station that follows by now is fetched, and ordered, by the leader.
Of a leader that is lost, what it has ordered and not finished is ordered again, and what it has not
ordered yet, which the one that follows has copied.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from threading import Event

import msgspec

from base_station.standby.leader_requests import LeaderRequests, WaitingErasure
from base_station.standby.protocol import pack, unpack
from base_station.standby.rpc import RpcServer, ask
from base_station.storage.db.unfinished_erasures import UnfinishedErasure
from shared.bus import Bus


class WaitingErasures(msgspec.Struct, frozen=True):
    """All requests that wait at a station, in one answer: none is another answer than silence."""

    waiting: tuple[WaitingErasure, ...]


class ErasureServer(RpcServer):
    """Serves what was requested here and is not done: ``erasures``, one by one and only while this
    station follows, for the leader to order; ``erasure_requests``, all at once, to be copied.
    """

    def __init__(
        self,
        station: str,
        bus: Bus,
        leads: Callable[[], bool],
        waiting: Callable[[], Iterable[WaitingErasure]],
    ) -> None:
        self._leads = leads
        self._waiting = waiting
        served = {"erasures": self._erasures, "erasure_requests": self._requests}
        super().__init__(station, bus, served)

    def _erasures(self, _key: str, _parameters: str, _payload: bytes) -> Iterator[bytes]:
        for one in () if self._leads() else self._waiting():
            yield pack(one)

    def _requests(self, _key: str, _parameters: str, _payload: bytes) -> Iterator[bytes]:
        yield pack(WaitingErasures(tuple(self._waiting())))


class ErasureHandover:
    """Takes over the erasures that another station has not finished, in rounds, each once."""

    def __init__(
        self,
        bus: Bus,
        leads: Callable[[], bool],
        other: Callable[[], str | None],
        unfinished: Callable[[], Iterable[UnfinishedErasure]],
        leader_requests: LeaderRequests,
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
        self._leader_requests = leader_requests
        self._take = take
        self._taken: set[str] = set()  # by request or order

    def run_round(self, _stop: Event) -> None:
        """Take over each new request and order; at a station that follows, copy the leader's
        requests.  Raises MusterError where a store fails, or the other station's answer makes no
        sense.
        """
        station = self._other()
        if not self._leads():
            for answer in () if station is None else ask(self._bus, station, "erasure_requests"):
                self._leader_requests.replace(unpack(answer, WaitingErasures).waiting)
            return
        for left in self._unfinished():
            self._take_once(left.order_id, left.subject)
        for one in self._leader_requests.all():
            self._take_once(one.request_id, one.subject)
        self._leader_requests.replace(())
        for answer in () if station is None else ask(self._bus, station, "erasures"):
            one = unpack(answer, WaitingErasure)
            self._take_once(one.request_id, one.subject)

    def _take_once(self, request_id: str, subject: str) -> None:
        if request_id not in self._taken:
            self._take(subject)
            self._taken.add(request_id)
