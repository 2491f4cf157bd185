"""The bus over Zenoh.  The only file that imports it; the settings were found by trying."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from queue import SimpleQueue
from typing import Any

import zenoh

from shared.bus import LivelinessHandler, QueryHandler, SampleHandler, Subscription
from shared.bus_handlers import HandlerGate, require_key, require_key_expression
from shared.channels import Qos
from shared.errors import BusError

# A lost link is noticed after the lease; each side's setting decides how fast the other notices.
_LEASE_MS = 3000
_KEEP_ALIVES_A_LEASE = 4


@dataclass(frozen=True, slots=True)
class TlsFiles:
    """Mutual TLS: both sides show a certificate signed by ``root_ca``."""

    root_ca: Path
    certificate: Path
    private_key: Path


@dataclass(frozen=True, slots=True)
class StationEndpoint:
    """The embedded router.  With ``tls`` the endpoints begin with ``tls/``."""

    listen: tuple[str, ...] = ("tcp/0.0.0.0:7447",)
    tls: TlsFiles | None = None


@dataclass(frozen=True, slots=True)
class UnitEndpoint:
    """A unit of one station: opens without a link, connects when the station is there."""

    connect: tuple[str, ...]
    tls: TlsFiles | None = None


class ZenohBus:
    """``shared.bus.Bus`` over a Zenoh session.

    Close it before the program ends: an open session keeps the interpreter alive.  Never fork
    after opening.
    """

    def __init__(self, endpoint: StationEndpoint | UnitEndpoint) -> None:
        """Raises BusError when the endpoint cannot be listened on or makes no sense."""
        zenoh.init_log_from_env_or("error")
        try:
            config = zenoh.Config.from_json5(json.dumps(_settings(endpoint)))
            self._session = zenoh.open(config)
        except zenoh.ZError as error:
            raise BusError(_in_words(endpoint, str(error))) from error

    def publish(self, key: str, payload: bytes, qos: Qos) -> None:
        self._require_open()
        if qos is Qos.LOCAL:
            raise BusError(f"{key!r} is the station's own and never travels on the bus")
        urgent = qos is Qos.ALERT
        self._session.put(
            require_key(key),
            payload,
            congestion_control=zenoh.CongestionControl.DROP,
            priority=zenoh.Priority.REAL_TIME if urgent else zenoh.Priority.DATA,
            express=urgent,
        )

    def subscribe(self, key_expression: str, handler: SampleHandler) -> Subscription:
        self._require_open()
        gate = HandlerGate(require_key_expression(key_expression), handler)

        def on_sample(sample: zenoh.Sample) -> None:
            if sample.kind == zenoh.SampleKind.PUT:
                gate(str(sample.key_expr), sample.payload.to_bytes())

        return _Declared(gate, self._session.declare_subscriber(key_expression, _direct(on_sample)))

    def declare_alive(self, key: str) -> Subscription:
        self._require_open()
        token = self._session.liveliness().declare_token(require_key(key))
        return _Declared(HandlerGate(key, bool), token)

    def watch_alive(self, key_expression: str, handler: LivelinessHandler) -> Subscription:
        self._require_open()
        gate = HandlerGate(require_key_expression(key_expression), handler)

        def on_sample(sample: zenoh.Sample) -> None:
            gate(str(sample.key_expr), sample.kind == zenoh.SampleKind.PUT)

        return _Declared(
            gate,
            self._session.liveliness().declare_subscriber(
                key_expression, _direct(on_sample), history=True
            ),
        )

    def serve(self, key_expression: str, handler: QueryHandler) -> Subscription:
        self._require_open()
        gate = HandlerGate(require_key_expression(key_expression), handler)

        def on_query(query: zenoh.Query) -> None:
            with query:
                payload = b"" if query.payload is None else query.payload.to_bytes()
                key = str(query.key_expr)
                for reply in gate.replies(key, str(query.parameters), payload):
                    query.reply(key, reply)

        # A thread of its own: making the replies must not hold up what else the link brings.
        return _Declared(
            gate, self._session.declare_queryable(key_expression, zenoh.handlers.Callback(on_query))
        )

    def query(self, selector: str, payload: bytes, timeout_s: float) -> Iterable[bytes]:
        self._require_open()
        require_key_expression(selector.partition("?")[0])
        replies: SimpleQueue[zenoh.Reply | None] = SimpleQueue()
        self._session.get(
            selector,
            zenoh.handlers.Callback(replies.put, drop=lambda: replies.put(None), indirect=False),
            target=zenoh.QueryTarget.ALL,
            consolidation=zenoh.ConsolidationMode.NONE,
            congestion_control=zenoh.CongestionControl.BLOCK,
            priority=zenoh.Priority.BACKGROUND,  # the replies travel as the query did
            timeout=timeout_s,
            payload=payload,
        )
        return _payloads(replies)

    def is_linked(self) -> bool:
        if self._session.is_closed():
            return False
        return bool(self._session.info.routers_zid() or self._session.info.peers_zid())

    def close(self) -> None:
        self._session.close()  # type: ignore[no-untyped-call]  # zenoh's stub leaves it open

    def _require_open(self) -> None:
        if self._session.is_closed():
            raise BusError("the bus is closed")


class _Declared:
    """Keeps what was declared: Zenoh undeclares what nobody refers to."""

    def __init__(self, gate: HandlerGate, declared: Any) -> None:
        self._gate = gate
        self._declared = declared

    def close(self) -> None:
        self._gate.close()
        if self._declared is not None:
            self._declared.undeclare()
            self._declared = None


def _direct(callback: Callable[[zenoh.Sample], None]) -> Any:
    """Called in the thread that receives: the shortest way."""
    return zenoh.handlers.Callback(callback, indirect=False)


def _payloads(replies: SimpleQueue[zenoh.Reply | None]) -> Iterator[bytes]:
    while (reply := replies.get()) is not None:
        if reply.ok is not None:
            yield reply.ok.payload.to_bytes()


def _settings(endpoint: StationEndpoint | UnitEndpoint) -> dict[str, Any]:
    link: dict[str, Any] = {"tx": {"lease": _LEASE_MS, "keep_alive": _KEEP_ALIVES_A_LEASE}}
    settings: dict[str, Any] = {
        # With gossip, units link to each other and go round the station's access rules.
        "scouting": {
            "multicast": {"enabled": False},
            "gossip": {"enabled": False},
            "delay": 0,  # nobody is scouted for: do not wait half a second for them
        },
        "transport": {"link": link, "shared_memory": {"enabled": False}},
    }
    if isinstance(endpoint, StationEndpoint):
        settings |= {
            "mode": "router",
            "listen": {"endpoints": list(endpoint.listen)},
            "timestamping": {"enabled": True},
        }
    else:
        settings |= {
            "mode": "peer",
            "listen": {"endpoints": []},
            "connect": {
                "endpoints": list(endpoint.connect),
                "timeout_ms": -1,
                "exit_on_failure": False,
                "retry": {
                    "period_init_ms": 200,
                    "period_max_ms": 1000,
                    "period_increase_factor": 1.5,
                },
            },
        }
    if endpoint.tls is not None:
        role = "listen" if isinstance(endpoint, StationEndpoint) else "connect"
        link["protocols"] = ["tls"]
        link["tls"] = {
            "root_ca_certificate": str(endpoint.tls.root_ca),
            f"{role}_certificate": str(endpoint.tls.certificate),
            f"{role}_private_key": str(endpoint.tls.private_key),
            "enable_mtls": True,
            "close_link_on_expiration": True,
        }
    return settings


def _in_words(endpoint: StationEndpoint | UnitEndpoint, reason: str) -> str:
    if isinstance(endpoint, UnitEndpoint):
        return f"the bus cannot be opened towards {', '.join(endpoint.connect)}: {reason}"
    where = ", ".join(endpoint.listen)
    if "address already in use" in reason.lower():
        return (
            f"the bus cannot listen on {where}: another program uses this port, perhaps another "
            "station; stop it or choose another port"
        )
    return f"the bus cannot listen on {where}: {reason}"
