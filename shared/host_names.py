"""Names of machines, checked without a name server."""

from __future__ import annotations

import ipaddress


def can_be_looked_up(host: str) -> bool:
    """True if it is a name at all; the name server may not know it yet.

    Of what is none, ``socket`` says a UnicodeError and no OSError.
    """
    try:
        host.encode("idna")
    except UnicodeError:
        return False
    return True


def is_loopback(host: str) -> bool:
    """True if ``host``, a name or an address, is this machine and no other can connect there."""
    try:
        address = ipaddress.ip_address(host)
    except ValueError:
        return host == "localhost"
    return (getattr(address, "ipv4_mapped", None) or address).is_loopback
