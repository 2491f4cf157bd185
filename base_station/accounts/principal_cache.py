"""Cache of authenticated principals, for times when the database does not answer."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from threading import Lock

from base_station.accounts.principals import Principal
from shared.errors import DatabaseAwayError, DiskHangsError

_MOST = 1000


class PrincipalCache:
    """Cache that knows secrets by their SHA-256 only.  Thread-safe."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._known: dict[bytes, Principal] = {}  # in the order of look-ups, the newest last

    def resolve(self, secret: str, look_up: Callable[[str], Principal | None]) -> Principal | None:
        """Return the holder of a secret.  A commander in an emergency must not wait for a disk or a
        server, so holders who were authenticated before are known without them.

        Raises StoreError, as ``look_up``.
        """
        name = hashlib.sha256(secret.encode()).digest()
        try:
            found = look_up(secret)
        except (DatabaseAwayError, DiskHangsError):
            with self._lock:
                known = self._known.get(name)
            if known is None:
                raise
            return known
        with self._lock:
            self._known.pop(name, None)
            if found is not None:
                self._known[name] = found
                if len(self._known) > _MOST:
                    del self._known[next(iter(self._known))]
        return found

    def forget_all(self) -> None:
        """Forget all holders, so that they are looked up again: a right may have been withdrawn."""
        with self._lock:
            self._known.clear()
