"""Token bucket: an allowance that fills at a rate."""

from __future__ import annotations

from shared.clock import NS_PER_S


class TokenBucket:
    """Fills at a rate, up to a burst; more than its content cannot be taken."""

    __slots__ = ("_burst", "_filled_ns", "_left", "_per_s")

    def __init__(self, per_s: float, burst: float, now_ns: int) -> None:
        self._per_s = per_s
        self._burst = burst
        self._left = burst
        self._filled_ns = now_ns

    def take(self, amount: float, now_ns: int) -> bool:
        self._fill(now_ns)
        if amount > self._left:
            return False
        self._left -= amount
        return True

    def spend(self, amount: float, now_ns: int) -> None:
        """Take tokens for work already done; more than there are become a debt."""
        self._fill(now_ns)
        self._left -= amount

    def wait_s(self, now_ns: int) -> float:
        """Until anything is left again; 0: there is."""
        self._fill(now_ns)
        return max(0.0, -self._left / self._per_s)

    def _fill(self, now_ns: int) -> None:
        filled = self._left + (now_ns - self._filled_ns) * self._per_s / NS_PER_S
        self._filled_ns = now_ns
        self._left = min(filled, self._burst)
