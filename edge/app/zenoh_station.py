"""Station as a unit reaches it over Zenoh."""

from __future__ import annotations

import time
from collections.abc import Callable
from datetime import UTC, datetime

from edge.agent.reachability_probe import ReachabilityProbe
from edge.identity import UnitConnection
from shared.bus import Bus
from shared.errors import BusError

_CONNECT_TIMEOUT_S = 2.0  # with a router that is not there; then it is tried again
_SEARCH_EVERY_S = 10.0  # it takes three; in between, the known places are probed

Find = Callable[[], tuple[str, ...]]


class ZenohStation:
    """Station over Zenoh, which is loaded when it is needed."""

    def __init__(self, member: UnitConnection, find: Find | None = None) -> None:
        """``find``: finds further endpoints, which prove themselves by their certificate like all;
        else as ``member`` says.
        """
        self._member = member
        self._connect = member.connect  # which is tried first changes
        self._probe = ReachabilityProbe(member.connect)
        self._find = find or (_finder(member) if member.discovers else None)
        self._searched_s: float | None = None
        self._is_probed = False  # there is one at a known place

    def open_bus(self) -> Bus:
        from shared.bus_zenoh import UnitEndpoint, ZenohBus  # noqa: PLC0415  # slow to load

        # Linked with one of several stations, else it receives every message twice.
        if self._find is not None or len(self._member.connect) > 1:
            return self.open_listening_bus()
        return ZenohBus(UnitEndpoint(self._member.connect, self._member.identity))

    def open_listening_bus(self) -> Bus:
        """Open a bus linked with one router.

        It receives the messages of other units; an endpoint for publishing does not.

        While it opens, Zenoh tries the first router again and again, and no other.
        """
        from shared.bus_zenoh import ClientEndpoint, ZenohBus  # noqa: PLC0415  # slow to load

        if not self._is_probed:
            self._search()
        self._is_probed = False
        connect = self._connect
        try:
            return ZenohBus(ClientEndpoint(connect, self._member.identity, _CONNECT_TIMEOUT_S))
        except BusError:
            self._connect = (*connect[1:], connect[0])
            raise

    def is_reachable(self, timeout_s: float) -> bool:
        self._is_probed = self._probe.wait(timeout_s)
        if not self._is_probed:
            self._search()
        return self._is_probed

    def link_failure_reason(self) -> str:
        from shared.link_diagnosis import link_failure_reason  # noqa: PLC0415  # slow to load

        return link_failure_reason(self._connect, self._member.identity, datetime.now(UTC))

    def _search(self) -> None:
        """Take over the addresses of the stations that are announced now.  The addresses in the
        enrolment stay, whatever is announced.
        """
        now_s = time.monotonic()
        is_fresh = self._searched_s is not None and now_s - self._searched_s < _SEARCH_EVERY_S
        if self._find is None or is_fresh:
            return
        known = dict.fromkeys((*self._member.connect, *self._find()))
        self._searched_s = time.monotonic()
        if known.keys() != set(self._connect):
            self._connect = tuple(known)
            self._probe.close()
            self._probe = ReachabilityProbe(self._connect)


def _finder(member: UnitConnection) -> Find:
    from edge.app.station_finder import StationFinder  # noqa: PLC0415  # few units discover

    assert member.identity is not None  # else there is nothing to prove a station by
    return StationFinder(member.identity.authority).find
