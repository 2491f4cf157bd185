"""Names and addresses under which this machine is found."""

from __future__ import annotations

import ipaddress
import re
import socket

import psutil

from shared.errors import ConfigError

_MISTYPED_ADDRESS = re.compile(r"([^.]*\.)*[0-9]+")  # no name ends in a number
_HOST_NAME = re.compile(r"[A-Za-z0-9]([A-Za-z0-9-]*[A-Za-z0-9])?(\.[A-Za-z0-9-]+)*")


def own_hosts() -> tuple[str, ...]:
    """Addresses of the network interfaces, IPv4 first, then the machine's name."""
    found = [
        address.address
        for addresses in psutil.net_if_addrs().values()
        for address in addresses
        if address.family in (socket.AF_INET, socket.AF_INET6)
    ]
    usable = sorted({a for a in found if _is_reachable(a)}, key=lambda a: (":" in a, a))
    name = socket.gethostname()
    return (*usable, name) if _HOST_NAME.fullmatch(name) else tuple(usable)


def require_host(host: str) -> str:
    """Return ``host`` when a certificate can stand for it, else raise ConfigError."""
    try:
        address = ipaddress.ip_address(host)
    except ValueError:
        mistyped = _MISTYPED_ADDRESS.fullmatch(host) is not None
        if not mistyped and _HOST_NAME.fullmatch(host) is not None and len(host) <= 253:
            return host
    else:
        if not address.is_unspecified:  # which is where to listen, and nowhere to connect to
            return str(address)
    raise ConfigError(
        f"{host!r} is no host: give a name such as station.local or an address such as "
        "192.168.1.10, without a port"
    )


def tls_endpoint(host: str, port: int) -> str:
    return f"tls/[{host}]:{port}" if ":" in host else f"tls/{host}:{port}"


def require_endpoint(endpoint: str) -> str:
    """Return ``endpoint`` when a unit can look for its station there, else raise ConfigError."""
    host, _, port = endpoint.removeprefix("tls/").rpartition(":")
    if not endpoint.startswith("tls/") or not port.isdecimal() or not 0 < int(port) < 65_536:
        raise ConfigError(
            f"{endpoint!r} is no end of a bus: write tls/HOST:PORT, as in tls/10.0.0.1:7447"
        )
    require_host(host.removeprefix("[").removesuffix("]"))
    return endpoint


def _is_reachable(text: str) -> bool:
    if "%" in text:  # link-local with its interface
        return False
    address = ipaddress.ip_address(text)
    return not (address.is_loopback or address.is_link_local)
