"""The bus's router, a process of its own beside the station; ``process`` keeps it running.

Zenoh reads access rules when it opens, so enrolling or revoking somebody means opening the
router again.  In its own process that costs everybody's link half a second, and the station
keeps its session, its subscriptions and what it knows.
"""

from __future__ import annotations

import logging
import secrets
import time
from pathlib import Path

from base_station.config import endpoint_address
from base_station.pki.access import access_control, seldom_asked
from base_station.pki.certificates import stands_for
from base_station.pki.folder import PkiFolder
from base_station.router.neighbour import Neighbour, listens
from shared.bus_zenoh import ClientEndpoint, StationEndpoint, ZenohBus
from shared.errors import BusError, ConfigError, MusterError, PortInUseError

logger = logging.getLogger(__name__)

_LOOKS_ALONE = 3  # at least, before the link to the other router is taken for lost
_PROBE_S = 1.0
_OPEN_ATTEMPTS = 10
_ATTEMPT_EVERY_S = 0.3


def endpoint_of(
    data: Path, listen: tuple[str, ...], links: tuple[str, ...] = ()
) -> StationEndpoint:
    """What the router opens: over TLS with the authority's rules, over plain TCP without any.

    Raises ConfigError where there is no authority, or plain and TLS are mixed.
    """
    if not _is_secure((*listen, *links)):
        return StationEndpoint(listen, links=links)
    pki = PkiFolder(data)
    registry = pki.registry()
    rules, seldom = access_control(registry), seldom_asked(registry)
    return StationEndpoint(listen, pki.station_identity(), rules, links, seldom)


def station_endpoint(data: Path, listen: tuple[str, ...]) -> ClientEndpoint:
    """How the station itself joins its router; over TLS with a right to everything.

    Raises ConfigError where it could not: Zenoh would only say that time ran out.
    """
    own = listen[0].replace("/0.0.0.0:", "/127.0.0.1:").replace("/[::]:", "/[::1]:")
    if not _is_secure(listen):
        return ClientEndpoint((own,))
    identity, (host, _) = PkiFolder(data).station_identity(), endpoint_address(own)
    if not stands_for(identity.certificate, host):
        raise ConfigError(
            f"the station's certificate does not stand for {host}, where the bus listens: listen "
            "on all addresses, tls/0.0.0.0:PORT, or make one that does with `muster pki "
            f"renew-station --host {host}`, with a --host for each other address that units use"
        )
    return ClientEndpoint((own,), identity)


class Router:
    """Open from the start; ``refresh`` opens it again when the authority's folder has changed."""

    def __init__(self, data: Path, listen: tuple[str, ...], links: tuple[str, ...] = ()) -> None:
        """``links``: another station's router.  Raises MusterError when it cannot open."""
        self._data = data
        self._listen = listen
        self._links = links
        self._endpoint = endpoint_of(data, listen, links)
        self._bus = _open(self._endpoint)
        self._neighbour = Neighbour(self._bus)
        self._told = ""
        self._alone = 0  # looks in a row at which the other router listened and did not answer
        self._patience = _patience()

    def refresh(self) -> None:
        """What cannot be read leaves the rules as they were, and says so once.

        Raises BusError when the port cannot be listened on again.
        """
        self._link_again()
        if self._endpoint.tls is None:
            return
        try:
            wanted = endpoint_of(self._data, self._listen, self._links)
        except MusterError as error:
            if str(error) != self._told:
                logger.error("access rules stay as they were: %s", error)
            self._told = str(error)
            return
        self._told = ""
        if wanted != self._endpoint:
            self._open_again(wanted)
            logger.info("open again with the changed certificates and rules")

    def close(self) -> None:
        self._neighbour.close()
        self._bus.close()

    def _link_again(self) -> None:
        """Zenoh may give a link up for good, or keep one that is deaf, when two routers open at
        once and each finds the other half open.  Where the other one lets in others and does not
        answer over the link, this one opens again; after a while of its own, so that they do not
        meet like that another time.  One that has only just begun to listen is left to link.
        """
        linked = not self._links or self._neighbour.answers()
        self._alone = self._alone + 1 if not linked and listens(self._links) else 0
        if self._alone >= self._patience:
            self._alone, self._patience = 0, _patience()
            if not self._other_lets_in():
                return
            logger.warning("no answer from the other station's router, which runs: open again")
            self._open_again(self._endpoint)

    def _open_again(self, endpoint: StationEndpoint) -> None:
        self.close()
        self._bus = _open(endpoint)
        self._neighbour = Neighbour(self._bus)
        self._endpoint = endpoint

    def _other_lets_in(self) -> bool:
        asking = ClientEndpoint(self._links, self._endpoint.tls, _PROBE_S)
        try:
            ZenohBus(asking).close()
        except BusError:
            return False
        return True


def _patience() -> int:
    """In looks; two routers that are patient for as long would meet half open again."""
    return _LOOKS_ALONE + secrets.randbelow(_LOOKS_ALONE)


def _is_secure(listen: tuple[str, ...]) -> bool:
    secure = [endpoint.startswith("tls/") for endpoint in listen]
    if any(secure) and not all(secure):
        raise ConfigError(
            f"{', '.join(listen)}: the bus is either secure or not; listen on tls/ only, or on "
            "tcp/ only"
        )
    return all(secure)


def _open(endpoint: StationEndpoint) -> ZenohBus:
    """The port takes a moment to come free after the router before this one."""
    for _ in range(_OPEN_ATTEMPTS - 1):
        try:
            return ZenohBus(endpoint)
        except PortInUseError:
            time.sleep(_ATTEMPT_EVERY_S)
    return ZenohBus(endpoint)
