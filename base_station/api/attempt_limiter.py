"""Limits of attempts, by the monotonic clock: setting the machine's time neither locks a user out
nor makes the station forget attempts.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Hashable


class AttemptLimiter:
    """Limit of attempts within the last ``within_s`` seconds, for each key; older attempts are
    forgotten.
    """

    def __init__(
        self, max_attempts: int, within_s: float, monotonic_s: Callable[[], float] = time.monotonic
    ) -> None:
        self._max_size = max_attempts
        self._within_s = within_s
        self._monotonic_s = monotonic_s
        self._attempts_s: dict[Hashable, deque[float]] = {}  # the newest attempt last

    def __len__(self) -> int:
        """Number of keys with attempts."""
        return len(self._attempts_s)

    def allows(self, key: Hashable) -> bool:
        """True if the key had fewer than ``max_attempts`` attempts."""
        attempts_s = self._attempts_s.get(key)
        return (
            attempts_s is None
            or len(attempts_s) < self._max_size
            or self._is_expired(attempts_s[0])
        )

    def record(self, key: Hashable) -> None:
        while self._attempts_s and self._is_expired(next(iter(self._attempts_s.values()))[-1]):
            del self._attempts_s[next(iter(self._attempts_s))]
        attempts_s = self._attempts_s.pop(key, None) or deque(maxlen=self._max_size)
        attempts_s.append(self._monotonic_s())
        self._attempts_s[key] = attempts_s

    def _is_expired(self, attempts_s: float) -> bool:
        return self._monotonic_s() - attempts_s >= self._within_s
