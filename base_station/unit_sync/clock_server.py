"""Server of the station's time for units (see docs/clocks.md)."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from shared.clock import Clock
from shared.messages.clock import ClockAnswer


class ClockServer:
    """``clock`` gives station time; of two stations only the one that ``leads`` answers."""

    def __init__(self, clock: Clock, leads: Callable[[], bool] = lambda: True) -> None:
        self._clock = clock
        self._leads = leads

    def replies(self, key: str, parameters: str, payload: bytes) -> Iterator[bytes]:
        """Reply with the times of receipt and sending, taken as close to the bus as possible."""
        del key, parameters, payload
        if not self._leads():
            return
        received_ns = self._clock.utc_ns()
        yield ClockAnswer(received_ns, self._clock.utc_ns()).to_bytes()
