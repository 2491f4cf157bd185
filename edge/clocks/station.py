"""Station clock of a unit: queries the station's time at intervals.  Monotonic time is the
machine's own, and tracking uses it.  Until the first answer of the station, UTC is the machine's,
without a stated accuracy.
"""

from __future__ import annotations

from collections.abc import Callable
from threading import Lock

from edge.clocks.offset import ClockEstimate, ClockOffsetFilter, Exchange
from shared.bus import ReplyHandler
from shared.clock import NS_PER_S, Clock
from shared.errors import WireError
from shared.messages.clock import ClockAnswer

_FIRST = 8  # exchanges, one a second: the quickest of several is a good one
_FIRST_EVERY_NS = NS_PER_S
_EVERY_NS = 15 * NS_PER_S
_LEAST_STD_S = 1e-3  # what the wire can say; less would say that nothing is known

Ask = Callable[[ReplyHandler], None]  # puts the question; without a link nothing comes of it


class StationClock:
    """Clock of station time.  Call ``turn`` often; any thread may read it."""

    def __init__(self, machine: Clock) -> None:
        self._machine = machine
        self._offset = ClockOffsetFilter()
        self._lock = Lock()
        self._answered = 0
        self._due_ns = 0

    def monotonic_ns(self) -> int:
        return self._machine.monotonic_ns()

    def utc_ns(self) -> int:
        now_ns = self._machine.monotonic_ns()
        estimate = self._at(now_ns)
        return self._machine.utc_ns() if estimate is None else now_ns + estimate.offset_ns

    def utc_std_s(self) -> float:
        """Standard deviation of ``utc_ns`` as station time; 0: unknown."""
        estimate = self.estimate()
        return 0.0 if estimate is None else max(estimate.std_s, _LEAST_STD_S)

    def estimate(self) -> ClockEstimate | None:
        """Return the estimate as it stands now; None before the station has answered."""
        return self._at(self._machine.monotonic_ns())

    def machine_ahead_s(self) -> float:
        """Return how far the machine's own UTC is ahead of the station's; 0 before it has
        answered.
        """
        ahead_ns = self._machine.utc_ns() - self.utc_ns()
        return 0.0 if self.estimate() is None else ahead_ns / NS_PER_S

    def turn(self, ask: Ask) -> None:
        """Query the station if that is due."""
        now_ns = self._machine.monotonic_ns()
        if now_ns < self._due_ns:
            return
        self._due_ns = now_ns + (_FIRST_EVERY_NS if self._answered < _FIRST else _EVERY_NS)
        query_ns = self._machine.monotonic_ns()
        ask(lambda reply: self._take(query_ns, reply))

    def _take(self, query_ns: int, reply: bytes | None) -> None:
        reply_ns = self._machine.monotonic_ns()
        if reply is None:
            return
        try:
            answer = ClockAnswer.from_bytes(reply)
        except WireError:
            return  # no time is better than a wrong one
        exchange = Exchange(query_ns, answer.received_utc_ns, answer.sent_utc_ns, reply_ns)
        with self._lock:
            self._answered += self._offset.note(exchange)

    def _at(self, t_mono_ns: int) -> ClockEstimate | None:
        with self._lock:
            return self._offset.at(t_mono_ns)
