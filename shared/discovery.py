"""Finding a station by multicast DNS service discovery (RFC 6762 and 6763), as ``_muster._tcp``,
and its console by a name such as ``muster.local``.

An announcement proves nothing: every machine on the network can make any.  It is only a hint where
to connect; the station's certificate proves the rest, as at any address.
"""

from __future__ import annotations

import ipaddress
import secrets
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from queue import Empty, SimpleQueue

import zeroconf

from shared.errors import BusError

SERVICE = "_muster._tcp.local."
VERSION = "1"
_CONSOLE_SERVICE = "_https._tcp.local."
_PLAIN_CONSOLE_SERVICE = "_http._tcp.local."
_RESOLVE_MS = 1000
_NAME_ASKED_MS = 3000  # an answer that was sent to another host is not repeated for a second
_LINGER_S = 0.5  # for further stations, once there is one
_MOST_LABEL = 50  # a label of DNS has 63 bytes
_MOST_NAMES = 32  # a machine that makes up more is not listened to
_MOST_ADDRESSES = 8  # of one station


@dataclass(frozen=True, slots=True)
class Announcement:
    """Announcement of a station on its network."""

    name: str  # of the station, for people; as received, with letters that distinguish two
    station: str  # common name of its certificate
    authority: str  # fingerprint of its authority's certificate
    port: int  # of the bus
    addresses: tuple[str, ...]

    def endpoints(self) -> tuple[str, ...]:
        """Endpoints of a bus with TLS at these addresses."""
        hosts = (f"[{one}]" if ":" in one else one for one in self.addresses)
        return tuple(f"tls/{host}:{self.port}" for host in hosts)


@dataclass(frozen=True, slots=True)
class ConsoleAnnouncement:
    """Name on the network under which browsers find the console of a station."""

    host: str  # without .local
    port: int
    is_secure: bool  # served over TLS
    addresses: tuple[str, ...]

    @property
    def name(self) -> str:
        return f"{self.host}.local"


class Announcer:
    """Announces a station, or its console, until it is closed."""

    def __init__(
        self,
        announcement: Announcement | ConsoleAnnouncement,
        interfaces: Sequence[str] = (),
    ) -> None:
        """``interfaces``: by their addresses; none: all.  Takes two seconds, in which others may
        object to the name.  Raises BusError, also where another machine has the console's name.
        """
        with ExitStack() as cleanup:
            try:
                link = _open(interfaces)
                cleanup.callback(link.close)
                link.register_service(_service_of(announcement, link))
            except (OSError, zeroconf.Error) as error:
                raise BusError(f"the station cannot be announced: {_reason(error)}") from error
            self._cleanup = cleanup.pop_all()

    def close(self) -> None:
        """Takes the announcement back."""
        self._cleanup.close()


def find_announcements(
    is_wanted: Callable[[Announcement], bool], timeout_s: float, interfaces: Sequence[str] = ()
) -> list[Announcement]:
    """Ask who announces a station, until one that is wanted has answered and those beside it had
    time to, or the time is over.  Raises BusError where there is no network to ask.
    """
    names: SimpleQueue[str] = SimpleQueue()

    def note(name: str, state_change: zeroconf.ServiceStateChange, **_: object) -> None:
        if state_change is not zeroconf.ServiceStateChange.Removed:
            names.put(name)

    found: dict[str, Announcement] = {}
    asked: set[str] = set()
    end_s = time.monotonic() + timeout_s
    with ExitStack() as cleanup:
        try:
            link = _open(interfaces)
            cleanup.callback(link.close)
            cleanup.callback(zeroconf.ServiceBrowser(link, SERVICE, handlers=[note]).cancel)
        except (OSError, zeroconf.Error) as error:
            raise BusError(f"no station can be looked for: {_reason(error)}") from error
        while (left_s := end_s - time.monotonic()) > 0.0 and len(asked) < _MOST_NAMES:
            try:
                name = names.get(timeout=left_s)
            except Empty:
                break
            asked.add(name)
            announcement = _resolved(link, name)
            if announcement is not None:
                found[name] = announcement
                if is_wanted(announcement):
                    end_s = min(end_s, time.monotonic() + _LINGER_S)
    return list(found.values())


def _open(interfaces: Sequence[str]) -> zeroconf.Zeroconf:
    return zeroconf.Zeroconf(interfaces=list(interfaces) or zeroconf.InterfaceChoice.All)


def _service_of(
    announcement: Announcement | ConsoleAnnouncement, link: zeroconf.Zeroconf
) -> zeroconf.ServiceInfo:
    if isinstance(announcement, ConsoleAnnouncement):
        return _console_of(announcement, link)
    return _station_of(announcement)


def _console_of(announcement: ConsoleAnnouncement, link: zeroconf.Zeroconf) -> zeroconf.ServiceInfo:
    """Service of a console's page.  Raises BusError where another machine has the name: mDNS
    resolves no conflict of host names here, as it does of services, and browsers would reach now
    the one and now the other.
    """
    server = f"{announcement.name}."
    holder = zeroconf.AddressResolver(server)  # type: ignore[attr-defined]  # left out of __all__
    if holder.request(link, _NAME_ASKED_MS):
        others = set(holder.parsed_addresses()) - set(announcement.addresses)
        if others:
            raise BusError(
                f"another machine on the network is {announcement.name} already "
                f"({', '.join(sorted(others))}); set another local_name"
            )
    service = _CONSOLE_SERVICE if announcement.is_secure else _PLAIN_CONSOLE_SERVICE
    return zeroconf.ServiceInfo(
        service,
        f"Muster {announcement.host}.{service}",
        port=announcement.port,
        server=server,
        parsed_addresses=list(announcement.addresses),
    )


def _station_of(announcement: Announcement) -> zeroconf.ServiceInfo:
    # Two that begin at once do not notice that they have one name, and are then found as one.
    token = secrets.token_hex(4)
    label = f"{announcement.name.replace('.', '-')[:_MOST_LABEL]}-{token}"
    return zeroconf.ServiceInfo(
        SERVICE,
        f"{label}.{SERVICE}",
        port=announcement.port,
        properties={
            "version": VERSION,
            "authority": announcement.authority,
            "station": announcement.station,
        },
        # A host of its own: the machine's name may be announced by another program, or machine.
        server=f"muster-{token}.local.",
        parsed_addresses=list(announcement.addresses),
    )


def _resolved(link: zeroconf.Zeroconf, name: str) -> Announcement | None:
    """None: it does not answer, or with what this version cannot read."""
    try:
        info = link.get_service_info(SERVICE, name, timeout=_RESOLVE_MS)
    except (OSError, zeroconf.Error):  # a name that is none
        return None
    if info is None or not info.port:
        return None
    properties = info.decoded_properties
    addresses = tuple(one for one in info.parsed_addresses() if _is_usable(one))
    if properties.get("version") != VERSION or not addresses:
        return None
    return Announcement(
        name=name.removesuffix(f".{SERVICE}"),
        station=properties.get("station") or "",
        authority=properties.get("authority") or "",
        port=info.port,
        addresses=addresses[:_MOST_ADDRESSES],
    )


def _is_usable(text: str) -> bool:
    address = ipaddress.ip_address(text.partition("%")[0])
    return not (address.is_multicast or address.is_unspecified or address.is_link_local)


def _reason(error: Exception) -> str:
    return str(error) or type(error).__name__
