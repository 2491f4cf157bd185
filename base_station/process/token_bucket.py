"""Token bucket: an allowance that fills at a rate (algorithm of the same name)."""

from __future__ import annotations

from shared.clock import NS_PER_S


class TokenBucket:
    """Bucket that fills at a rate, up to a burst."""

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
        """Take tokens for work already done; more than the content becomes a debt."""
        self._fill(now_ns)
        self._left -= amount

    def wait_s(self, now_ns: int) -> float:
        """Seconds until there are tokens again; 0 if there are."""
        self._fill(now_ns)
        return max(0.0, -self._left / self._per_s)

    def _fill(self, now_ns: int) -> None:
        filled = self._left + (now_ns - self._filled_ns) * self._per_s / NS_PER_S
        self._filled_ns = now_ns
        self._left = min(filled, self._burst)
