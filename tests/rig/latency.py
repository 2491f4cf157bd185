"""Latency from a sensor to a console's WebSocket."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from shared.clock import NS_PER_MS, NS_PER_S


@dataclass(frozen=True, slots=True)
class Latency:
    """Milliseconds."""

    count: int
    p50_ms: float
    p99_ms: float
    max_ms: float


def latency_of(values_ms: list[float] | tuple[float, ...]) -> Latency:
    if not values_ms:
        return Latency(0, float("nan"), float("nan"), float("nan"))
    p50, p99, highest = np.percentile(values_ms, (50.0, 99.0, 100.0))
    return Latency(len(values_ms), float(p50), float(p99), float(highest))


def latencies_ms(
    sent_ns: Mapping[str, Sequence[int]], shown: Mapping[str, Mapping[int, int]]
) -> list[float]:
    """Sensor time to WebSocket of each position that was shown, one for each that was sent.

    The station states a position's time by its own idea of the unit's clock, some milliseconds
    off, so a shown position is that of the nearest sensor time.
    """
    latencies: list[float] = []
    for unit_id, times_ns in sent_ns.items():
        first_seen: dict[int, int] = {}
        for t_ms, seen_ns in shown.get(unit_id, {}).items():
            nearest_ns = _nearest(times_ns, t_ms * NS_PER_MS)
            if nearest_ns is not None and seen_ns >= nearest_ns:
                first_seen[nearest_ns] = min(seen_ns, first_seen.get(nearest_ns, seen_ns))
        latencies += [(seen_ns - t_ns) / NS_PER_MS for t_ns, seen_ns in first_seen.items()]
    return latencies


def _nearest(times_ns: Sequence[int], t_ns: int) -> int | None:
    """The nearest of rising times, at most a second away."""
    index = bisect_left(times_ns, t_ns)
    around = times_ns[max(index - 1, 0) : index + 1]
    nearest = min(around, key=lambda candidate: abs(candidate - t_ns), default=None)
    return nearest if nearest is not None and abs(nearest - t_ns) < NS_PER_S else None
