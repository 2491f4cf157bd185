"""Announcement of the station on its network, where that is asked for.

A unit verifies the address that it connects to by the station's certificate.  So only addresses
that the certificate stands for are announced; where it stands for none, the health page says so.
"""

from __future__ import annotations

import logging
import socket
from collections.abc import Callable, Iterable
from types import TracebackType

from base_station.app.listening_addresses import interfaces_of, reachable_addresses
from base_station.config import StationConfig, endpoint_address
from base_station.security.pki.certificates import is_valid_for_host
from base_station.security.pki.folder import PkiFolder
from base_station.security.pki.hosts import own_hosts
from shared.discovery import Announcement, Announcer
from shared.log_on_change import LogOnChange
from shared.tls import fingerprint

_log = logging.getLogger(__name__)


class StationPresence:
    """Kept as the machine's addresses and the certificate are; ``update`` now and then."""

    def __init__(
        self,
        pki: PkiFolder,
        config: StationConfig,
        own: Callable[[], Iterable[str]] = own_hosts,
    ) -> None:
        """``own``: gives the addresses of this machine."""
        self._pki = pki
        self._own = own
        self._endpoints = config.bus.secured_endpoints() if config.bus.announce else ()
        self._name = config.standby.name or socket.gethostname().partition(".")[0]
        self._fault_log = LogOnChange(_log, "the station is not announced on its network")
        self._announced: Announcement | None = None
        self._announcer: Announcer | None = None
        self._not_covered: tuple[str, ...] = ()

    def __enter__(self) -> StationPresence:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._withdraw()

    def update(self) -> None:
        """Announce what holds now; what fails is tried again the next time."""
        if not self._endpoints:
            return
        with self._fault_log:
            wanted = self._wanted()
            if wanted == self._announced:
                return
            self._withdraw()
            if wanted.addresses:
                self._announcer = Announcer(wanted, self._interfaces())
            self._announced = wanted

    def problems(self) -> tuple[str, ...]:
        """Sentences for the console."""
        if self._fault_log.fault:
            return (f"The station is not announced on its network: {self._fault_log.fault}",)
        if not self._not_covered:
            return ()
        return (
            f"Units do not discover this station at {', '.join(self._not_covered)}, as its "
            "certificate does not stand for that: make one that does with `muster pki "
            "renew-station`, and --host for each address",
        )

    def _wanted(self) -> Announcement:
        identity = self._pki.station_identity()
        hosts = self._listening_hosts()
        covered = tuple(one for one in hosts if is_valid_for_host(identity.certificate, one))
        self._not_covered = () if covered else hosts
        return Announcement(
            name=self._name,
            station=identity.common_name(),
            authority=fingerprint(identity.authority),
            port=self._port,
            addresses=covered,
        )

    @property
    def _port(self) -> int:
        return endpoint_address(self._endpoints[0])[1]

    def _listening_hosts(self) -> tuple[str, ...]:
        """Addresses at which the bus takes connections on the port that is announced."""
        given = [endpoint_address(one) for one in self._endpoints]
        return reachable_addresses([host for host, port in given if port == self._port], self._own)

    def _interfaces(self) -> tuple[str, ...]:
        """Those that the bus listens on; none: all."""
        return interfaces_of([endpoint_address(one)[0] for one in self._endpoints])

    def _withdraw(self) -> None:
        announcer, self._announcer, self._announced = self._announcer, None, None
        if announcer is not None:
            announcer.close()
