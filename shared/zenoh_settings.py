"""The ends of the bus, and how Zenoh is set for each; the settings were found by trying."""

from __future__ import annotations

import base64
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from shared.channels import ROOT
from shared.tls import TlsIdentity

# A lost link is noticed after the lease; each side's setting decides how fast the other notices.
_LEASE_MS = 3000
LOCAL_LINK = "unixsock-stream"  # a socket in a folder of this machine, which is its owner's alone
_KEEP_ALIVES_A_LEASE = 4
_RETRY = {"period_init_ms": 200, "period_max_ms": 1000, "period_increase_factor": 1.5}
# Larger messages are refused from every sender. So much may be unfinished of one link in each of
# Zenoh's eight priorities.
MOST_BYTES = 2 * 1024 * 1024
# Messages and answers of units are far smaller: larger ones are dropped at the router.
MOST_PUBLISHED_BYTES = 64 * 1024
MOST_ANSWERED_BYTES = 1024 * 1024  # twice the size of a request
_LARGEST = (
    ("published", "put", MOST_PUBLISHED_BYTES, ("*/up/**", "*/alert/**", "*/heartbeat")),
    ("answered", "reply", MOST_ANSWERED_BYTES, ("**",)),
)
# Connections to the router without a session yet: all units at once, when it opens again.
_UNICAST = {"accept_pending": 1000}
_QUERY_HZ = 5.0  # a unit asks for the time once a second at most
# Batches of 64 KiB towards each neighbour, made when needed: 1 MB of live data outlasts a second
# in which a busy machine runs no other process. With two batches, the default, it was dropped.
_ROUTER_QUEUES = {
    "control": 2,
    "real_time": 4,
    "interactive_high": 2,
    "interactive_low": 2,
    "data_high": 2,
    "data": 16,
    "data_low": 2,
    "background": 2,
}


@dataclass(frozen=True, slots=True)
class StationEndpoint:
    """The router.  With ``tls``, which is mutual, the endpoints begin with ``tls/``.

    ``access_control``: Zenoh's section of that name, read once, when the bus is opened.
    ``rate_limited_queries``: of questions under each of these keys a few a second go through.
    ``links_tls``: with what it joins other stations' routers, where that is another identity.
    """

    listen: tuple[str, ...] = ("tcp/0.0.0.0:7447",)
    tls: TlsIdentity | None = None
    access_control: Mapping[str, Any] | None = None
    links: tuple[str, ...] = ()  # other stations' routers, which it joins
    rate_limited_queries: tuple[str, ...] = ()
    links_tls: TlsIdentity | None = None


@dataclass(frozen=True, slots=True)
class UnitEndpoint:
    """A unit of one station: opens without a link, connects when the station is there."""

    connect: tuple[str, ...]
    tls: TlsIdentity | None = None


@dataclass(frozen=True, slots=True)
class ClientEndpoint:
    """A station beside its router, or an onlooker: opening waits for the router.

    Once open, it finds a router that was away by itself.  It is a client because without
    gossip a router passes nothing from peer to peer.
    """

    connect: tuple[str, ...]
    tls: TlsIdentity | None = None
    patience_s: float = 10.0


Endpoint = StationEndpoint | UnitEndpoint | ClientEndpoint


def settings_of(endpoint: Endpoint) -> dict[str, Any]:
    """Zenoh's configuration."""
    link: dict[str, Any] = {"tx": {"lease": _LEASE_MS, "keep_alive": _KEEP_ALIVES_A_LEASE}}
    if isinstance(endpoint, StationEndpoint):
        link["tx"]["queue"] = {"size": _ROUTER_QUEUES}
        link["rx"] = {"max_message_size": MOST_BYTES}
    if endpoint.tls is not None:
        link["protocols"] = ["tls", LOCAL_LINK]
        link["tls"] = _tls_settings(_tls_roles(endpoint, endpoint.tls))
    return {
        # With gossip, units link to each other and go round the station's access rules.
        "scouting": {
            "multicast": {"enabled": False},
            "gossip": {"enabled": False},
            "delay": 0,  # without scouting there is no answer to wait half a second for
        },
        "transport": {"link": link, "shared_memory": {"enabled": False}, "unicast": _UNICAST},
    } | _role_settings(endpoint)


def _role_settings(endpoint: Endpoint) -> dict[str, Any]:
    if isinstance(endpoint, StationEndpoint):
        settings: dict[str, Any] = {
            "mode": "router",
            "listen": {"endpoints": list(endpoint.listen)},
            "timestamping": {"enabled": True},
            "low_pass_filter": [
                {
                    "id": name,
                    "flows": ["ingress"],
                    "messages": [kind],
                    "key_exprs": [f"{ROOT}/{keys}" for keys in under],
                    "size_limit": max_bytes,
                }
                for name, kind, max_bytes, under in _LARGEST
            ],
        }
        if endpoint.rate_limited_queries:
            settings["downsampling"] = [
                {
                    "id": "asked",
                    "flows": ["ingress"],
                    "messages": ["query"],
                    "rules": [
                        {"key_expr": k, "freq": _QUERY_HZ} for k in endpoint.rate_limited_queries
                    ],
                }
            ]
        if endpoint.access_control is not None:
            settings["access_control"] = dict(endpoint.access_control)
        if endpoint.links:
            settings["connect"] = {
                "endpoints": list(endpoint.links),
                "timeout_ms": -1,
                "exit_on_failure": False,
                "retry": _RETRY,
            }
        return settings
    patience_s = endpoint.patience_s if isinstance(endpoint, ClientEndpoint) else None
    return {
        "mode": "peer" if patience_s is None else "client",
        "listen": {"endpoints": []},
        "connect": {
            "endpoints": list(endpoint.connect),
            "timeout_ms": -1 if patience_s is None else round(patience_s * 1000),
            "exit_on_failure": patience_s is not None,
            "retry": _RETRY,
        },
    }


def _tls_roles(endpoint: Endpoint, tls: TlsIdentity) -> dict[str, TlsIdentity]:
    if not isinstance(endpoint, StationEndpoint):
        return {"connect": tls}
    return {"listen": tls} | ({"connect": endpoint.links_tls or tls} if endpoint.links else {})


def _tls_settings(roles: Mapping[str, TlsIdentity]) -> dict[str, Any]:
    """Inline rather than as paths: an enrolment is one file, and its key is on disk once."""
    own: dict[str, str] = {}
    for role, identity in roles.items():
        own |= {
            f"{role}_certificate_base64": _base64(identity.certificate),
            f"{role}_private_key_base64": _base64(identity.private_key),
        }
    authorities = dict.fromkeys(identity.authority for identity in roles.values())
    return own | {
        "root_ca_certificate_base64": _base64(b"".join(authorities)),
        "enable_mtls": True,
        "close_link_on_expiration": True,
    }


def _base64(pem: bytes) -> str:
    return base64.b64encode(pem).decode()
