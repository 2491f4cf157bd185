"""The port to the message bus.  ``bus_memory`` and ``bus_zenoh`` implement it; one contract
suite runs over both.

Threading: handlers are called from a thread of the bus, one call at a time for a
subscription; a handler copies what it needs and returns at once.  Publishing is thread-safe,
never blocks for the network, and says nothing of arrival: without a link the bytes are gone,
and the journal is what brings them.
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
        """After it returns the handler is not called again."""
        ...


class Bus(Protocol):
    def publish(self, key: str, payload: bytes, qos: Qos, *, remote_only: bool = False) -> None:
        """``remote_only``: this end's own subscriptions are not given it."""
        ...

    def subscribe(self, key_expression: str, handler: SampleHandler) -> Subscription:
        """Key expressions as in Zenoh: ``*`` one chunk, ``**`` any number."""
        ...

    def declare_alive(self, key: str) -> Subscription:
        """Hold a liveliness token until closed or the link is lost."""
        ...

    def watch_alive(self, key_expression: str, handler: LivelinessHandler) -> Subscription:
        """Hear of tokens that are there, appear and vanish."""
        ...

    def serve(self, key_expression: str, handler: QueryHandler) -> Subscription:
        """Answer queries."""
        ...

    def query(self, selector: str, payload: bytes, timeout_s: float) -> Iterable[bytes]:
        """Ask and yield replies as they come; with no one to answer, nothing."""
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

        An ``urgent`` question and its replies go ahead of live data, any other behind it.
        """
        ...

    def is_linked(self) -> bool:
        """True if another end is there at this moment, as far as this one has noticed."""
        ...

    def has_subscriber(self, key: str) -> bool:
        """True if another end would be sent what is published under ``key``: false without a
        link or a subscriber, and where the access rules hide it from this end.
        """
        ...

    def close(self) -> None: ...
