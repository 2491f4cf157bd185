"""The bus's router, a process of its own beside the station; ``process`` keeps it running.

Zenoh reads access rules when it opens, so an enrolment or revocation means opening the router
again.  In its own process that costs each link half a second, and the station keeps its session,
its subscriptions and its state.
"""

from __future__ import annotations

import logging
import secrets
import time
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

from base_station.config import endpoint_address
from base_station.security.pki.certificates import is_valid_for_host
from base_station.security.pki.folder import PkiFolder
from base_station.security.router.listening import free_port
from base_station.security.router.peer_router_probe import PeerRouterProbe, accepts_connections
from base_station.security.router.refusals import RefusalSummary
from base_station.security.router.secure_front import SecureFront
from shared.bus_zenoh import ClientEndpoint, StationEndpoint, ZenohBus
from shared.errors import BusError, ConfigError, MusterError, PortInUseError

logger = logging.getLogger(__name__)

_MIN_CHECKS_WITHOUT_PEER = 3  # at least, before the link to the other router is taken for lost
_PROBE_S = 1.0
_OPEN_ATTEMPTS = 10
_ATTEMPT_EVERY_S = 0.3


def station_endpoint(data: Path, listen: tuple[str, ...]) -> ClientEndpoint:
    """Endpoint with which the station itself joins its router; over TLS with a right to everything.

    Raises ConfigError where it could not: Zenoh would only report a timeout.
    """
    own = listen[0].replace("/0.0.0.0:", "/127.0.0.1:").replace("/[::]:", "/[::1]:")
    if not _is_secure(listen):
        return ClientEndpoint((own,))
    identity, (host, _) = PkiFolder(data).station_identity(), endpoint_address(own)
    if not is_valid_for_host(identity.certificate, host):
        raise ConfigError(
            f"the station's certificate does not stand for {host}, where the bus listens: listen "
            "on all addresses, tls/0.0.0.0:PORT, or make one that does with `muster pki "
            f"renew-station --host {host}`, with a --host for each other address that units use"
        )
    return ClientEndpoint((own,), identity)


class Router:
    """Open from the start; ``refresh`` applies changes of the authority's folder.

    Over TLS an acceptor stands in front of it.  It handles revocations and the station's renewed
    certificate; only for a new enrolment the router opens again.
    """

    def __init__(
        self,
        data: Path,
        listen: tuple[str, ...],
        links: tuple[str, ...] = (),
        station: tuple[str, ...] = (),
    ) -> None:
        """``links``: another station's router; ``station``: where the station itself joins.

        Raises MusterError when it cannot open.
        """
        self._listen = listen
        self._station = station
        self._links = links
        self._front = SecureFront(data, listen) if _is_secure((*listen, *links)) else None
        with ExitStack() as undo:
            if self._front is not None:
                undo.callback(self._front.close)
            self._endpoint = self._current_endpoint()
            self._bus = self._open(self._endpoint)
            undo.pop_all()
        self._peer_probe = PeerRouterProbe(self._bus)
        self._logged_error = ""
        self._checks_without_peer = (
            0  # looks in a row at which the other router listened and did not answer
        )
        self._random_check_limit = _random_check_limit()

    def refresh(self) -> None:
        """Follows the folder; what cannot be read leaves the rules as they were, logged once.

        Raises BusError when the port cannot be listened on again.
        """
        self._reopen_if_link_lost()
        if self._front is None:
            return
        try:
            lacks_rules = self._front.reload()
        except MusterError as error:
            if str(error) != self._logged_error:
                logger.error("access rules stay as they were: %s", error)
            self._logged_error = str(error)
            return
        self._logged_error = ""
        if lacks_rules or self._current_endpoint().links_tls != self._endpoint.links_tls:
            self._reopen()
            logger.info("open again with the changed certificates and rules")

    def refused(self) -> RefusalSummary:
        """Connections that were not let in; none are counted over plain TCP."""
        return RefusalSummary() if self._front is None else self._front.refused()

    def ban(self, sender_id: str, seconds: float) -> None:
        """Ends the links of ``sender_id``, and refuses new ones for a while."""
        if self._front is not None:
            self._front.ban(sender_id, seconds)

    def close(self) -> None:
        if self._front is not None:
            self._front.close()
        self._peer_probe.close()
        self._bus.close()

    def _reopen_if_link_lost(self) -> None:
        """Zenoh may give a link up for good, or keep one that is deaf, when two routers open at
        once and each finds the other half open.  Where the other one lets in others and does not
        answer over the link, this one opens again; after a while of its own, so that they do not
        meet like that another time.  One that has only just begun to listen is left to link.
        """
        linked = not self._links or self._peer_probe.responds()
        self._checks_without_peer = (
            self._checks_without_peer + 1 if not linked and accepts_connections(self._links) else 0
        )
        if self._checks_without_peer >= self._random_check_limit:
            self._checks_without_peer, self._random_check_limit = 0, _random_check_limit()
            if not self._peer_accepts_links():
                return
            logger.warning("no answer from the other station's router, which runs: open again")
            self._reopen()

    def _reopen(self) -> None:
        if self._front is not None:
            self._front.pause()
        self._peer_probe.close()
        self._bus.close()
        self._endpoint = self._current_endpoint()
        self._bus = self._open(self._endpoint)
        self._peer_probe = PeerRouterProbe(self._bus)

    def _current_endpoint(self) -> StationEndpoint:
        if self._front is None:
            return StationEndpoint((*self._listen, *self._station), links=self._links)
        return self._front.router_endpoint(self._links)

    def _open(self, endpoint: StationEndpoint) -> ZenohBus:
        """The port takes a moment to come free after the router before this one."""
        for _ in range(_OPEN_ATTEMPTS - 1):
            try:
                return self._open_once(endpoint)
            except PortInUseError:
                time.sleep(_ATTEMPT_EVERY_S)
        return self._open_once(endpoint)

    def _open_once(self, endpoint: StationEndpoint) -> ZenohBus:
        if self._front is None:
            return ZenohBus(endpoint)
        port = free_port()
        listen = (f"tls/127.0.0.1:{port}", *self._station)
        bus = ZenohBus(replace(endpoint, listen=listen))
        self._front.resume(port)
        return bus

    def _peer_accepts_links(self) -> bool:
        tls = None if self._front is None else self._front.identity
        probe = ClientEndpoint(self._links, tls, _PROBE_S)
        try:
            ZenohBus(probe).close()
        except BusError:
            return False
        return True


def _random_check_limit() -> int:
    """In looks; two routers that are patient for as long would meet half open again."""
    return _MIN_CHECKS_WITHOUT_PEER + secrets.randbelow(_MIN_CHECKS_WITHOUT_PEER)


def _is_secure(listen: tuple[str, ...]) -> bool:
    secure = [endpoint.startswith("tls/") for endpoint in listen]
    if any(secure) and not all(secure):
        raise ConfigError(
            f"{', '.join(listen)}: the bus is either secure or not; listen on tls/ only, or on "
            "tcp/ only"
        )
    return all(secure)
