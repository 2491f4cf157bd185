"""Station as a unit reaches it over Zenoh."""

from __future__ import annotations

from datetime import UTC, datetime

from edge.agent.reachability_probe import ReachabilityProbe
from edge.identity import UnitConnection
from shared.bus import Bus
from shared.errors import BusError

_CONNECT_TIMEOUT_S = 2.0  # with a router that is not there; then it is tried again


class ZenohStation:
    """Station over Zenoh, which is loaded when it is needed."""

    def __init__(self, member: UnitConnection) -> None:
        self._member = member
        self._connect = member.connect  # which is tried first changes
        self._probe = ReachabilityProbe(member.connect)

    def open_bus(self) -> Bus:
        from shared.bus_zenoh import UnitEndpoint, ZenohBus  # noqa: PLC0415  # slow to load

        if len(self._member.connect) > 1:  # linked with one of the stations, else it hears double
            return self.open_listening_bus()
        return ZenohBus(UnitEndpoint(self._member.connect, self._member.identity))

    def open_listening_bus(self) -> Bus:
        """Open a bus linked with one router, which hears other units, as an endpoint for
        publishing does not.

        While it opens, Zenoh tries the first router again and again, and no other.
        """
        from shared.bus_zenoh import ClientEndpoint, ZenohBus  # noqa: PLC0415  # slow to load

        try:
            return ZenohBus(
                ClientEndpoint(self._connect, self._member.identity, _CONNECT_TIMEOUT_S)
            )
        except BusError:
            self._connect = (*self._connect[1:], self._connect[0])
            raise

    def is_reachable(self, timeout_s: float) -> bool:
        return self._probe.wait(timeout_s)

    def why_no_link(self) -> str:
        from shared.link_diagnosis import why_no_link  # noqa: PLC0415  # slow to load

        return why_no_link(self._member.connect, self._member.identity, datetime.now(UTC))
