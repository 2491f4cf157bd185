"""How often something is tried.  By a clock that nobody sets: a machine whose time was put right
locks nobody out, and lets nobody try anew.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Hashable


class Tries:
    """Those of the last ``within_s`` under each key; what is older is not kept."""

    def __init__(
        self, most: int, within_s: float, monotonic_s: Callable[[], float] = time.monotonic
    ) -> None:
        self._most = most
        self._within_s = within_s
        self._monotonic_s = monotonic_s
        self._tried_s: dict[Hashable, deque[float]] = {}  # who tried last is the last here

    def __len__(self) -> int:
        """Of how many keys anything is known."""
        return len(self._tried_s)

    def has_room(self, key: Hashable) -> bool:
        """Whether there were fewer than ``most``."""
        tried_s = self._tried_s.get(key)
        return tried_s is None or len(tried_s) < self._most or self._is_over(tried_s[0])

    def note(self, key: Hashable) -> None:
        while self._tried_s and self._is_over(next(iter(self._tried_s.values()))[-1]):
            del self._tried_s[next(iter(self._tried_s))]
        tried_s = self._tried_s.pop(key, None) or deque(maxlen=self._most)
        tried_s.append(self._monotonic_s())
        self._tried_s[key] = tried_s

    def _is_over(self, tried_s: float) -> bool:
        return self._monotonic_s() - tried_s >= self._within_s
