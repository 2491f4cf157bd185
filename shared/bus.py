"""Interface of the message bus, implemented by ``bus_memory`` and ``bus_zenoh``; one contract suite
runs over both.

Threading: handlers are called from a thread of the bus, one call at a time for a subscription; a
handler copies what it needs and returns at once.  Publishing is thread-safe, never blocks for the
network, and gives no confirmation of arrival: without a link the bytes are lost, and are fetched
from the journal later.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Protocol

from shared.channels import Qos

SampleHandler = Callable[[str, bytes], None]  # key, payload
LivelinessHandler = Callable[[str, bool], None]  # key of the token, alive
QueryHandler = Callable[[str, str, bytes], Iterable[bytes]]  # key, parameters, payload -> replies
ReplyHandler = Callable[[bytes | None], None]  # each reply, and None when there are no more


class Subscription(Protocol):
    def close(self) -> None:
        """End it; after that the handler is not called again."""
        ...


class Bus(Protocol):
    def publish(self, key: str, payload: bytes, qos: Qos, *, remote_only: bool = False) -> None:
        """Publish a payload; ``remote_only``: not to this end's own subscriptions."""
        ...

    def subscribe(self, key_expression: str, handler: SampleHandler) -> Subscription:
        """Subscribe to a key expression as in Zenoh: ``*`` is one chunk, ``**`` any number."""
        ...

    def declare_alive(self, key: str) -> Subscription:
        """Hold a liveliness token until closed or the link is lost."""
        ...

    def watch_alive(self, key_expression: str, handler: LivelinessHandler) -> Subscription:
        """Watch liveliness tokens: present ones, new ones, and those that end."""
        ...

    def serve(self, key_expression: str, handler: QueryHandler) -> Subscription:
        """Answer queries."""
        ...

    def query(self, selector: str, payload: bytes, timeout_s: float) -> Iterable[bytes]:
        """Send a query and yield replies as they come; none where nothing answers."""
        ...

    def ask(
        self,
        selector: str,
        payload: bytes,
        timeout_s: float,
        on_reply: ReplyHandler,
        *,
        urgent: bool = False,
    ) -> None:
        """As ``query``, without waiting: ``on_reply`` is called by a thread of the bus.

        An ``urgent`` query and its replies go ahead of live data, any other behind it.
        """
        ...

    def is_linked(self) -> bool:
        """True if another end is connected, as far as this one has detected."""
        ...

    def has_subscriber(self, key: str) -> bool:
        """True if another end would be sent what is published under ``key``: false without a
        link or a subscriber, and where the access rules hide it from this end.
        """
        ...

    def close(self) -> None: ...
