"""Calls of a bus handler: one at a time, none after closing, errors logged."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from functools import lru_cache
from threading import RLock
from typing import Any

from shared.errors import BusError

logger = logging.getLogger(__name__)


class HandlerGate:
    """Calls a handler for a bus, from whatever thread the bus does it.

    One call at a time.  After ``close`` the handler is not called again: ``close`` waits for a
    call under way in another thread, and may be called by the handler itself.  An exception of
    the handler never reaches the bus; the first of its kind is logged with its traceback.
    """

    def __init__(self, key_expression: str, handler: Callable[..., Any]) -> None:
        self._key_expression = key_expression
        self._handler = handler
        self._lock = RLock()
        self._closed = False
        self._kinds_logged: set[type[BaseException]] = set()

    def __call__(self, *arguments: Any) -> None:
        with self._lock:
            if not self._closed:
                try:
                    self._handler(*arguments)
                except Exception as error:  # noqa: BLE001  # must not stop the bus
                    self._log(error)

    def replies(self, *arguments: Any) -> Iterator[bytes]:
        """Answers of a query handler, up to their end or to its failure."""
        with self._lock:
            if not self._closed:
                try:
                    yield from self._handler(*arguments)
                except Exception as error:  # noqa: BLE001  # must not stop the bus
                    self._log(error)

    def close(self) -> None:
        with self._lock:
            self._closed = True

    def _log(self, error: Exception) -> None:
        if type(error) in self._kinds_logged:
            return
        self._kinds_logged.add(type(error))
        logger.error(
            "the handler of %s failed; further failures of this kind are not logged",
            self._key_expression,
            exc_info=error,
        )


@lru_cache(maxsize=65_536)
def intersects(first: str, second: str) -> bool:
    """True if a key can match both expressions: ``*`` is one chunk, ``**`` any number."""
    return _chunks_intersect(tuple(first.split("/")), tuple(second.split("/")))


def _chunks_intersect(first: tuple[str, ...], second: tuple[str, ...]) -> bool:
    if first and first[0] == "**":
        return _chunks_intersect(first[1:], second) or (
            bool(second) and _chunks_intersect(first, second[1:])
        )
    if second and second[0] == "**":
        return _chunks_intersect(second, first)
    if not first or not second:
        return not first and not second
    same = first[0] == second[0] or "*" in (first[0], second[0])
    return same and _chunks_intersect(first[1:], second[1:])


def require_key(key: str) -> str:
    """Return ``key`` when something can be published under it, else raise BusError."""
    if any(chunk == "" for chunk in key.split("/")) or any(sign in key for sign in "*$?#"):
        raise BusError(
            f"{key!r} is not a key to publish under: it needs non-empty chunks between '/' "
            "and none of '*', '$', '?', '#'"
        )
    return key


def require_key_expression(expression: str) -> str:
    """Return ``expression`` when it selects keys, else raise BusError."""
    chunks = expression.split("/")
    plain = [chunk for chunk in chunks if chunk not in ("*", "**")]
    if any(chunk == "" or any(sign in chunk for sign in "*$?#") for chunk in plain):
        raise BusError(
            f"{expression!r} is not a key expression: it needs non-empty chunks between '/', "
            "each a name, '*' or '**'"
        )
    return expression
