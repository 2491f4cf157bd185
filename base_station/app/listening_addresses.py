"""Addresses at which other machines reach the servers of this one."""

from __future__ import annotations

import ipaddress
from collections.abc import Callable, Iterable, Sequence


def reachable_addresses(hosts: Sequence[str], own: Callable[[], Iterable[str]]) -> tuple[str, ...]:
    """Addresses for which the listening ``hosts`` stand; names among them are left out.

    ``own`` returns the names and addresses of this machine, for which a wildcard stands.
    """
    given = own() if any(_is_wildcard(host) for host in hosts) else hosts
    return tuple(one for one in given if _is_address(one))


def interfaces_of(hosts: Sequence[str]) -> tuple[str, ...]:
    """Addresses of the interfaces that are listened on; none if it is all of them, or not known."""
    is_any = any(not _is_address(host) or _is_wildcard(host) for host in hosts)
    return () if is_any else tuple(hosts)


def _is_address(host: str) -> bool:
    try:
        ipaddress.ip_address(host)
    except ValueError:
        return False
    return True


def _is_wildcard(host: str) -> bool:
    return _is_address(host) and ipaddress.ip_address(host).is_unspecified
