"""The bus over Zenoh.  The only file that imports it."""

from __future__ import annotations

import json
import logging
import re
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from functools import partial
from queue import SimpleQueue
from threading import Thread, current_thread
from typing import Any
from weakref import WeakSet

import zenoh

from shared.bus import (
    LivelinessHandler,
    QueryHandler,
    ReplyHandler,
    SampleHandler,
    Subscription,
)
from shared.bus_handlers import HandlerGate, require_key, require_key_expression
from shared.channels import Qos
from shared.errors import BusError, PortInUseError
from shared.zenoh_settings import (
    ClientEndpoint,
    Endpoint,
    StationEndpoint,
    UnitEndpoint,
    settings_of,
)

__all__ = ["ClientEndpoint", "Endpoint", "StationEndpoint", "UnitEndpoint", "ZenohBus"]

logger = logging.getLogger(__name__)

_SAMPLES_WAITING = 65_536  # of one subscription; with more the link waits
_QUERIES_WAITING = 1024
_REPLIES_WAITING = 1024  # to one query
_PLACE_IN_ZENOH = re.compile(r"\s+at \S+\.rs:\d+\.?")  # left out of messages for people
_ENDING_S = 2.0  # for a thread to see that its channel has ended; a handler may be slow

_Samples = zenoh.handlers.Handler[zenoh.Sample]
_Queries = zenoh.handlers.Handler[zenoh.Query]
_Replies = zenoh.handlers.Handler[zenoh.Reply]


class ZenohBus:
    """``shared.bus.Bus`` over a Zenoh session.

    Close it before the program ends: an open session keeps the interpreter alive.  Never fork
    after opening.
    """

    def __init__(self, endpoint: Endpoint) -> None:
        """Raises BusError when the endpoint cannot be opened or is not valid."""
        zenoh.init_log_from_env_or("error")
        try:
            config = zenoh.Config.from_json5(json.dumps(settings_of(endpoint)))
            self._session = zenoh.open(config)
        except zenoh.ZError as error:
            raise _in_words(endpoint, error) from error
        self._publishers: dict[tuple[str, Qos, bool], zenoh.Publisher] = {}
        self._watched: dict[str, zenoh.Publisher] = {}
        self._threads: WeakSet[Thread] = WeakSet()

    def publish(self, key: str, payload: bytes, qos: Qos, *, remote_only: bool = False) -> None:
        self._require_open()
        if qos is Qos.LOCAL:
            raise BusError(f"{key!r} is the station's own and never travels on the bus")
        publisher = self._publishers.get((key, qos, remote_only))
        if publisher is None:
            publisher = self._publisher(require_key(key), qos, remote_only=remote_only)
            self._publishers[key, qos, remote_only] = publisher
        publisher.put(payload)

    def subscribe(self, key_expression: str, handler: SampleHandler) -> Subscription:
        self._require_open()
        gate = HandlerGate(require_key_expression(key_expression), handler)
        subscriber = self._session.declare_subscriber(
            key_expression, zenoh.handlers.FifoChannel(_SAMPLES_WAITING)
        )
        self._start_thread(
            "bus-samples", partial(_deliver_samples, subscriber, partial(_message, gate))
        )
        return _Declared(gate, subscriber)

    def declare_alive(self, key: str) -> Subscription:
        self._require_open()
        token = self._session.liveliness().declare_token(require_key(key))
        return _Declared(HandlerGate(key, bool), token)

    def watch_alive(self, key_expression: str, handler: LivelinessHandler) -> Subscription:
        self._require_open()
        gate = HandlerGate(require_key_expression(key_expression), handler)
        subscriber = self._session.liveliness().declare_subscriber(
            key_expression, zenoh.handlers.FifoChannel(_SAMPLES_WAITING), history=True
        )
        self._start_thread(
            "bus-tokens", partial(_deliver_samples, subscriber, partial(_token, gate))
        )
        return _Declared(gate, subscriber)

    def serve(self, key_expression: str, handler: QueryHandler) -> Subscription:
        self._require_open()
        gate = HandlerGate(require_key_expression(key_expression), handler)

        queryable = self._session.declare_queryable(
            key_expression, zenoh.handlers.FifoChannel(_QUERIES_WAITING)
        )
        # A thread of its own: making the replies must not delay other data of the link.
        self._start_thread("bus-queries", partial(_answer, queryable, gate))
        return _Declared(gate, queryable)

    def query(self, selector: str, payload: bytes, timeout_s: float) -> Iterable[bytes]:
        replies: SimpleQueue[bytes | None] = SimpleQueue()
        self.ask(selector, payload, timeout_s, replies.put)
        return iter(replies.get, None)

    def ask(
        self,
        selector: str,
        payload: bytes,
        timeout_s: float,
        on_reply: ReplyHandler,
        *,
        urgent: bool = False,
    ) -> None:
        self._require_open()
        require_key_expression(selector.partition("?")[0])
        replies = self._session.get(
            selector,
            zenoh.handlers.FifoChannel(_REPLIES_WAITING),
            target=zenoh.QueryTarget.ALL,
            consolidation=zenoh.ConsolidationMode.NONE,
            # The replies travel as the query did.  An urgent query does not wait.
            congestion_control=zenoh.CongestionControl.DROP
            if urgent
            else zenoh.CongestionControl.BLOCK,
            priority=zenoh.Priority.REAL_TIME if urgent else zenoh.Priority.BACKGROUND,
            timeout=timeout_s,
            payload=payload,
        )
        self._start_thread("bus-replies", partial(_deliver_replies, replies, on_reply))

    def is_linked(self) -> bool:
        if self._session.is_closed():
            return False
        return bool(self._session.info.routers_zid() or self._session.info.peers_zid())

    def has_subscriber(self, key: str) -> bool:
        if self._session.is_closed():
            return False
        if key not in self._watched:
            # Kept: the answer needs a round trip, and its changes come only while it stands.
            self._watched[key] = self._session.declare_publisher(
                require_key(key), allowed_destination=zenoh.Locality.REMOTE
            )
        status = self._watched[key].matching_status
        return bool(getattr(status, "matching", False))  # the stub says bool; it is an object

    def close(self) -> None:
        try:
            self._session.close()  # type: ignore[no-untyped-call]  # zenoh's stub leaves it open
        except zenoh.ZError as error:  # it waits for a link that leads nowhere, but not for ever
            logger.debug("closing the bus: %s", error)
        # One that comes back out of Zenoh while the interpreter ends would abort the program.
        for thread in tuple(self._threads):
            if thread is not current_thread():
                thread.join(_ENDING_S)

    def _publisher(self, key: str, qos: Qos, *, remote_only: bool) -> zenoh.Publisher:
        """Return the publisher of a key, which is kept as long as the session: a declared key
        travels as a number, and the router checks route and rights once, which halves its work.
        """
        urgent = qos is Qos.ALERT
        return self._session.declare_publisher(
            key,
            congestion_control=zenoh.CongestionControl.DROP,
            priority=zenoh.Priority.REAL_TIME if urgent else zenoh.Priority.DATA,
            express=urgent,
            allowed_destination=zenoh.Locality.REMOTE if remote_only else zenoh.Locality.ANY,
        )

    def _start_thread(self, name: str, target: Callable[[], None]) -> None:
        thread = Thread(target=target, name=name, daemon=True)
        self._threads.add(thread)
        thread.start()

    def _require_open(self) -> None:
        if self._session.is_closed():
            raise BusError("the bus is closed")


class _Declared:
    """Owner of a declaration: Zenoh undeclares one without references."""

    def __init__(self, gate: HandlerGate, declared: Any) -> None:
        self._gate = gate
        self._declared = declared

    def close(self) -> None:
        self._gate.close()
        if self._declared is not None:
            self._declared.undeclare()
            self._declared = None


def _message(gate: HandlerGate, sample: zenoh.Sample) -> None:
    if sample.kind == zenoh.SampleKind.PUT:
        gate(str(sample.key_expr), sample.payload.to_bytes())


def _token(gate: HandlerGate, sample: zenoh.Sample) -> None:
    gate(str(sample.key_expr), sample.kind == zenoh.SampleKind.PUT)


def _deliver_samples(
    subscriber: zenoh.Subscriber[_Samples], deliver: Callable[[zenoh.Sample], None]
) -> None:
    """Deliver samples until the subscription ends.  The link's own thread would wait for the
    interpreter at every sample, for milliseconds while another thread works, and the far end drops
    data meanwhile.  So samples are queued on this side and taken together.
    """
    samples = subscriber.handler  # the subscriber itself could not be closed while it receives
    with suppress(zenoh.ZError):
        while True:
            sample: zenoh.Sample | None = samples.recv()
            while sample is not None:
                deliver(sample)
                sample = samples.try_recv()


def _answer(queryable: zenoh.Queryable[_Queries], gate: HandlerGate) -> None:
    """Answer queries until the queryable is undeclared."""
    queries = queryable.handler  # as above
    while True:
        try:
            asked = queries.recv()
        except zenoh.ZError:
            return
        with asked as query:
            payload = b"" if query.payload is None else query.payload.to_bytes()
            key = str(query.key_expr)
            try:
                for reply in gate.replies(key, str(query.parameters), payload):
                    query.reply(key, reply)
            except zenoh.ZError as error:  # the querier or the link is gone
                logger.debug("an answer under %s does not get away: %s", key, error)


def _deliver_replies(replies: _Replies, on_reply: ReplyHandler) -> None:
    """Deliver replies until no more come, in a thread of its own for the same reason: live data
    comes over the same link.
    """
    try:
        with suppress(zenoh.ZError):
            while True:
                reply: zenoh.Reply | None = replies.recv()
                while reply is not None:
                    if reply.ok is not None:
                        on_reply(reply.ok.payload.to_bytes())
                    reply = replies.try_recv()
    finally:
        on_reply(None)  # else the caller would wait for ever


def _in_words(endpoint: Endpoint, error: zenoh.ZError) -> BusError:
    reason = _PLACE_IN_ZENOH.sub("", str(error))
    if not isinstance(endpoint, StationEndpoint):
        return BusError(f"the bus cannot be opened towards {', '.join(endpoint.connect)}: {reason}")
    in_use = "address already in use" in reason.lower()
    return cannot_listen(endpoint.listen, reason, in_use=in_use)


def cannot_listen(endpoints: Sequence[str], reason: str, *, in_use: bool) -> BusError:
    """PortInUseError where it is ``in_use``."""
    where = ", ".join(endpoints)
    if in_use:
        return PortInUseError(
            f"the bus cannot listen on {where}: another program uses this port, perhaps another "
            "station; stop it or choose another port"
        )
    return BusError(f"the bus cannot listen on {where}: {reason}")
