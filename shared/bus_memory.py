"""Bus inside one process, for tests and rehearsals, with a fixed order of deliveries."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from enum import Enum, auto
from threading import Lock

from shared.bus import (
    LivelinessHandler,
    QueryHandler,
    ReplyHandler,
    SampleHandler,
    Subscription,
)
from shared.bus_handlers import (
    HandlerGate,
    intersects,
    require_key,
    require_key_expression,
)
from shared.channels import Qos
from shared.errors import BusError


class EndpointRole(Enum):
    """Declaration of an endpoint."""

    SUBSCRIBER = auto()
    TOKEN = auto()
    WATCHER = auto()
    SERVER = auto()


@dataclass(slots=True, eq=False)
class Declaration:
    """Declaration of an endpoint, as the router keeps it."""

    owner: MemoryBus
    role: EndpointRole
    expression: str
    gate: HandlerGate
    alive: set[str] = field(default_factory=set)  # of a watcher: the tokens it was notified of


class MemoryRouter:
    """Router that connects the endpoints attached to it.

    Deliveries go in the order of publishing, then of subscribing.  A router delivers inside
    ``publish``; one made with ``pumped=True`` keeps everything until ``pump``.  What a handler
    publishes is delivered after what was under way.
    """

    def __init__(self, *, pumped: bool = False) -> None:
        self._pumped = pumped
        self._lock = Lock()  # never held while a handler runs
        self._declarations: list[Declaration] = []
        self._deliveries: deque[Callable[[], object]] = deque()
        self._delivering = False

    def attach_station(self) -> MemoryBus:
        """Attach a linked endpoint that reaches every other."""
        return MemoryBus(self, is_station=True)

    def attach_unit(self) -> MemoryBus:
        """Attach a linked endpoint that reaches the stations only, no other unit."""
        return MemoryBus(self, is_station=False)

    def pump(self) -> int:
        """Deliver everything that waits, and what handlers publish meanwhile; returns the number of
        deliveries.  Inside a handler, or while another thread delivers, it does nothing.
        """
        count = 0
        while True:
            with self._lock:
                if self._delivering or not self._deliveries:
                    return count
                deliver = self._deliveries.popleft()
                self._delivering = True
            deliver()
            self._delivering = False
            count += 1

    def route(
        self, sender: MemoryBus, key: str, payload: bytes, *, remote_only: bool = False
    ) -> None:
        with self._lock:
            for entry in self._reached_from(sender, EndpointRole.SUBSCRIBER):
                if remote_only and entry.owner is sender:
                    continue
                if intersects(entry.expression, key):
                    self._defer(entry.gate, key, payload)
        self._deliver_unless_pumped()

    def has_subscriber(self, sender: MemoryBus, key: str) -> bool:
        with self._lock:
            return any(
                intersects(entry.expression, key) and entry.owner is not sender
                for entry in self._reached_from(sender, EndpointRole.SUBSCRIBER)
            )

    def answers(
        self, asker: MemoryBus, key: str, parameters: str, payload: bytes
    ) -> Iterable[bytes]:
        with self._lock:
            serving = [
                entry.gate
                for entry in self._reached_from(asker, EndpointRole.SERVER)
                if intersects(entry.expression, key)
            ]
        for gate in serving:
            yield from gate.replies(key, parameters, payload)

    def declare(self, entry: Declaration) -> None:
        with self._lock:
            self._declarations.append(entry)
            self._notify_watchers()
        self._deliver_unless_pumped()

    def withdraw(self, entry: Declaration) -> None:
        with self._lock:
            if entry in self._declarations:
                self._declarations.remove(entry)
            self._notify_watchers()
        self._deliver_unless_pumped()

    def withdraw_all(self, owner: MemoryBus) -> None:
        for entry in [entry for entry in self._declarations if entry.owner is owner]:
            entry.gate.close()
            self.withdraw(entry)

    def links_changed(self) -> None:
        with self._lock:
            self._notify_watchers()
        self._deliver_unless_pumped()

    def _reached_from(self, endpoint: MemoryBus, role: EndpointRole) -> list[Declaration]:
        return [
            entry
            for entry in self._declarations
            if entry.role is role and endpoint.reaches(entry.owner)
        ]

    def _notify_watchers(self) -> None:
        """Tell each watcher how the set of tokens that it can see has changed."""
        for watcher in self._declarations:
            if watcher.role is not EndpointRole.WATCHER:
                continue
            alive = {
                token.expression
                for token in self._reached_from(watcher.owner, EndpointRole.TOKEN)
                if intersects(watcher.expression, token.expression)
            }
            for key in sorted(watcher.alive ^ alive):
                self._defer(watcher.gate, key, key in alive)
            watcher.alive = alive

    def _defer(self, gate: HandlerGate, *arguments: object) -> None:
        self._deliveries.append(lambda: gate(*arguments))

    def _deliver_unless_pumped(self) -> None:
        if not self._pumped:
            self.pump()


class MemoryBus:
    """One endpoint of a ``MemoryRouter``; ``link_down`` and ``link_up`` are for tests."""

    def __init__(self, router: MemoryRouter, *, is_station: bool) -> None:
        self._router = router
        self._is_station = is_station
        self._closed = False
        self._linked = True

    def reaches(self, other: MemoryBus) -> bool:
        """True if messages pass between the two, as a Zenoh router passes them to its peers."""
        if other is self:
            return True
        return self._linked and other._linked and (self._is_station or other._is_station)

    def link_down(self) -> None:
        """Cut the link: published bytes are lost, nothing arrives, and tokens end."""
        self._linked = False
        self._router.links_changed()

    def link_up(self) -> None:
        self._linked = True
        self._router.links_changed()

    def publish(self, key: str, payload: bytes, qos: Qos, *, remote_only: bool = False) -> None:
        self._require_open()
        if qos is Qos.LOCAL:
            raise BusError(f"{key!r} is the station's own and never travels on the bus")
        self._router.route(self, require_key(key), bytes(payload), remote_only=remote_only)

    def subscribe(self, key_expression: str, handler: SampleHandler) -> Subscription:
        return self._declare(
            EndpointRole.SUBSCRIBER, require_key_expression(key_expression), handler
        )

    def declare_alive(self, key: str) -> Subscription:
        return self._declare(EndpointRole.TOKEN, require_key(key), bool)

    def watch_alive(self, key_expression: str, handler: LivelinessHandler) -> Subscription:
        return self._declare(EndpointRole.WATCHER, require_key_expression(key_expression), handler)

    def serve(self, key_expression: str, handler: QueryHandler) -> Subscription:
        return self._declare(EndpointRole.SERVER, require_key_expression(key_expression), handler)

    def query(self, selector: str, payload: bytes, timeout_s: float) -> Iterable[bytes]:
        del timeout_s  # everyone here answers at once
        self._require_open()
        key, _, parameters = selector.partition("?")
        return self._router.answers(self, require_key_expression(key), parameters, payload)

    def ask(
        self,
        selector: str,
        payload: bytes,
        timeout_s: float,
        on_reply: ReplyHandler,
        *,
        urgent: bool = False,
    ) -> None:
        del urgent
        for reply in self.query(selector, payload, timeout_s):
            on_reply(reply)
        on_reply(None)

    def is_linked(self) -> bool:
        return self._linked and not self._closed

    def has_subscriber(self, key: str) -> bool:
        return not self._closed and self._router.has_subscriber(self, require_key(key))

    def close(self) -> None:
        self._closed = True
        self._router.withdraw_all(self)

    def _declare(
        self, role: EndpointRole, expression: str, handler: Callable[..., object]
    ) -> Subscription:
        self._require_open()
        entry = Declaration(self, role, expression, HandlerGate(expression, handler))
        self._router.declare(entry)
        return _MemoryDeclaration(self._router, entry)

    def _require_open(self) -> None:
        if self._closed:
            raise BusError("the bus is closed")


class _MemoryDeclaration:
    def __init__(self, router: MemoryRouter, entry: Declaration) -> None:
        self._router = router
        self._entry = entry

    def close(self) -> None:
        self._entry.gate.close()
        self._router.withdraw(self._entry)
