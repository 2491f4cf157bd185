"""Announcement of the station on its network, if the settings have it.

A unit verifies the address to which it connects by the station's certificate.  So only addresses in
the certificate are announced; if it has none of this machine, the health page shows it.
"""

from __future__ import annotations

import logging
import socket
from collections.abc import Callable, Iterable

from base_station.app.listening_addresses import interfaces_of, reachable_addresses
from base_station.app.service_announcement import ServiceAnnouncement
from base_station.config import StationConfig, endpoint_address
from base_station.security.pki.certificates import is_valid_for_host
from base_station.security.pki.folder import PkiFolder
from base_station.security.pki.hosts import own_hosts
from shared.coded_text import coded
from shared.discovery import Announcement
from shared.tls import fingerprint

_log = logging.getLogger(__name__)


class StationPresence(ServiceAnnouncement):
    """Announcement that follows the machine's addresses and the certificate; ``update`` is to be
    called regularly.
    """

    def __init__(
        self,
        pki: PkiFolder,
        config: StationConfig,
        own: Callable[[], Iterable[str]] = own_hosts,
    ) -> None:
        """``own`` returns the addresses of this machine."""
        super().__init__(_log, "the station is not announced on its network")
        self._pki = pki
        self._own = own
        self._endpoints = config.bus.secured_endpoints() if config.bus.announce else ()
        self._name = config.standby.name or socket.gethostname().partition(".")[0]
        self._not_covered: tuple[str, ...] = ()

    def update(self) -> None:
        """Announce the present state; after a failure the next call tries again."""
        if not self._endpoints:
            return
        self.keep(self._wanted, self._interfaces)

    def problems(self) -> tuple[str, ...]:
        """Sentences about problems, for the console."""
        if self.fault:
            text = coded(
                "station-not-announced",
                "The station is not announced on its network: {error}",
                error=self.fault,
            )
            return (text,)
        if not self._not_covered:
            return ()
        text = coded(
            "station-not-certified",
            "Units do not discover this station at {addresses}, as its certificate does not stand "
            "for that: make one that does with `muster pki renew-station`, and --host for each "
            "address",
            addresses=", ".join(self._not_covered),
        )
        return (text,)

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
        """Addresses at which the bus accepts connections on the announced port."""
        given = [endpoint_address(one) for one in self._endpoints]
        return reachable_addresses([host for host, port in given if port == self._port], self._own)

    def _interfaces(self) -> tuple[str, ...]:
        """Interfaces on which the bus listens; none if it is all of them."""
        return interfaces_of([endpoint_address(one)[0] for one in self._endpoints])
