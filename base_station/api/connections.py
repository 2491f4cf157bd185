"""Limits of connections to the console, by network: none takes all of the station's."""

from __future__ import annotations

import contextlib
import socket
from collections import Counter
from collections.abc import Callable
from typing import Any

from base_station.security.networks import network_of

MAX_CONNECTIONS = 2000
MAX_ANONYMOUS = 1000  # all networks together from which no user is logged in
MAX_PER_NETWORK = 500  # place: a proxy, or two hundred consoles behind one router
MAX_PER_ANONYMOUS_NETWORK = (
    100  # two dozen consoles behind one router, where no user is logged in yet
)


class ConnectionLimitedSocket(socket.socket):
    """Listening socket that counts connections from the moment they are accepted: over TLS it takes
    a while until a client can send a request, and a connection needs memory all the time.

    When all connections for anonymous networks are in use, the oldest of the network with the most
    is closed.  So a browser can always connect, however many connections are held without a
    request.
    """

    def __init__(
        self, family: int = -1, kind: int = -1, protocol: int = -1, fileno: int | None = None
    ) -> None:
        super().__init__(family, kind, protocol, fileno)
        self.is_known: Callable[[str], bool] = lambda _: True  # of a place: logged in from there
        self._networks: dict[socket.socket, str] = {}  # in the order of coming
        self._count_of: Counter[str] = Counter()  # by network, with those just gone

    def accept(self) -> tuple[socket.socket, Any]:
        """Accept a connection; one above the limit is closed, with ConnectionAbortedError."""
        accepted, address = super().accept()
        network = network_of(address[0])
        if self._is_full(network):  # some of its connections may have gone
            self._remove_closed()
        known = self.is_known(network)
        if len(self._networks) >= MAX_CONNECTIONS or self._count_of[network] >= _max_per_network(
            known=known
        ):
            accepted.close()
            raise ConnectionAbortedError
        if not known and self._anonymous_count() >= MAX_ANONYMOUS:
            self._drop_oldest_anonymous()
        self._networks[accepted] = network
        self._count_of[network] += 1
        return accepted, address

    def _is_full(self, network: str) -> bool:
        known = self.is_known(network)
        return (
            len(self._networks) >= MAX_CONNECTIONS
            or self._count_of[network] >= _max_per_network(known=known)
            or (not known and self._anonymous_count() >= MAX_ANONYMOUS)
        )

    def _remove_closed(self) -> None:
        self._networks = {
            one: network for one, network in self._networks.items() if one.fileno() >= 0
        }
        self._count_of = Counter(self._networks.values())

    def _anonymous_count(self) -> int:
        return sum(count for network, count in self._count_of.items() if not self.is_known(network))

    def _drop_oldest_anonymous(self) -> None:
        anonymous = [one for one in self._count_of if not self.is_known(one)]
        largest = max(anonymous, key=lambda one: self._count_of[one])
        oldest = next(one for one, network in self._networks.items() if network == largest)
        del self._networks[oldest]
        self._count_of[largest] -= 1
        with contextlib.suppress(OSError):  # it has just gone
            oldest.shutdown(socket.SHUT_RDWR)  # its transport closes it then


def _max_per_network(*, known: bool) -> int:
    return MAX_PER_NETWORK if known else MAX_PER_ANONYMOUS_NETWORK


class KnownNetworks:
    """Networks from which a user is logged in, or was since the station started."""

    def __init__(self, max_size: int = 1000) -> None:
        self._max_size = max_size
        self._networks: dict[str, None] = {}  # in the order of requests, the newest last

    def add(self, address: str) -> None:
        """Add the network from which a logged-in user has sent a request."""
        network = network_of(address)
        self._networks.pop(network, None)
        self._networks[network] = None
        if len(self._networks) > self._max_size:
            self._networks.pop(next(iter(self._networks)), None)

    def __contains__(self, network: str) -> bool:
        return network in self._networks
