"""Rate limit of sightings: one a second for each beacon, tag or unit."""

from __future__ import annotations

from edge.samples import SightingSample
from shared.clock import NS_PER_S

_COUNTED_MAX = 1000  # things whose sightings are limited one by one; with more all begin anew


class SightingLimit:
    def __init__(self) -> None:
        self._last_ns: dict[tuple[str, str], int] = {}

    def takes(self, sample: SightingSample) -> bool:
        """Return True if this sighting is to be published."""
        key = (sample.kind, sample.seen_id)
        before_ns = self._last_ns.get(key)
        if before_ns is not None and 0 <= sample.t_ns - before_ns < NS_PER_S:
            return False
        if len(self._last_ns) >= _COUNTED_MAX:
            self._last_ns.clear()
        self._last_ns[key] = sample.t_ns
        return True
