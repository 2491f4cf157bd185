"""Tells the units the station's time when they ask (see docs/clocks.md)."""

from __future__ import annotations

from collections.abc import Iterator

from shared.clock import Clock
from shared.messages.clock import ClockAnswer


class ClockServer:
    """``clock`` gives station time."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock

    def replies(self, key: str, parameters: str, payload: bytes) -> Iterator[bytes]:
        """The two stamps stand as close to the bus as they can."""
        del key, parameters, payload
        received_ns = self._clock.utc_ns()
        yield ClockAnswer(received_ns, self._clock.utc_ns()).to_bytes()
