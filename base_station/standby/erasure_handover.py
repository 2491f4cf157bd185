"""Hand-over of erasures: an erasure is ordered in the log, and only the station that leads writes
there.  What was requested of a station that follows by now is fetched, and ordered, by the leader.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from threading import Event

import msgspec

from base_station.standby.protocol import pack, unpack
from base_station.standby.rpc import RpcServer, ask
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
    """Takes over the other station's waiting erasures in rounds, each once."""

    def __init__(
        self, bus: Bus, other: Callable[[], str | None], take: Callable[[str], None]
    ) -> None:
        """``other``: the station that follows this one; None: this one does not lead, or is alone.
        ``take`` receives "person ID" or "incident ID", and again if it raises.
        """
        self._bus = bus
        self._other = other
        self._take = take
        self._taken: set[str] = set()  # by request

    def look(self, _stop: Event) -> None:
        """One round.  Raises MusterError where the other station's answer makes no sense."""
        station = self._other()
        if station is None:
            return
        for answer in ask(self._bus, station, "erasures"):
            one = unpack(answer, WaitingErasure)
            if one.request_id not in self._taken:
                self._take(f"{one.kind} {one.subject_id}")
                self._taken.add(one.request_id)
