"""Station time: the time of the log, of sessions and of all that people are shown."""

from __future__ import annotations

from collections.abc import Callable
from threading import Lock

from base_station.core.durations import format_duration
from shared.clock import NS_PER_S, Clock
from shared.coded_text import Measure, coded

_STEP_NS = 5 * NS_PER_S  # nothing is old after that
_REPORT_FROM_NS = 5 * NS_PER_S


class SteadyClock:
    """Clock whose UTC never goes back and never stands still.  Thread-safe.

    It follows the machine's UTC forwards.  When that is set back, the clock continues at the rate
    of monotonic time until the machine's UTC has caught up.  While the clock is held, it does the
    same when the machine's UTC is set far forward: otherwise members would count as missing since
    yesterday because a clock was set.
    """

    def __init__(self, clock: Clock, not_before_ns: int = 0) -> None:
        """``not_before_ns``: UTC that was given out before this program started."""
        self._clock = clock
        self._lock = Lock()
        self._offset_ns = max(not_before_ns, clock.utc_ns()) - clock.monotonic_ns()
        self._is_held: Callable[[], bool] = lambda: False

    def hold_while(self, is_held: Callable[[], bool]) -> None:
        """Hold the clock while ``is_held`` returns True; it may be called from any thread."""
        self._is_held = is_held

    def not_before(self, utc_ns: int) -> None:
        """Continue from ``utc_ns``, which another clock has reached, if that is later."""
        with self._lock:
            self._offset_ns = max(self._offset_ns, utc_ns - self._clock.monotonic_ns())

    def agree(self, utc_ns: int) -> None:
        """Set the clock to ``utc_ns``, the time of the station whose log this one follows; its time
        on the way is not counted.  The clock may go back by this; times that it has given out are
        in no log.
        """
        with self._lock:
            offset_ns = utc_ns - self._clock.monotonic_ns()
            if abs(offset_ns - self._offset_ns) > _STEP_NS:
                self._offset_ns = offset_ns

    def monotonic_ns(self) -> int:
        return self._clock.monotonic_ns()

    def utc_ns(self) -> int:
        with self._lock:
            monotonic_ns = self._clock.monotonic_ns()
            machine_ns = self._clock.utc_ns() - monotonic_ns
            if machine_ns <= self._offset_ns + _STEP_NS or not self._is_held():
                self._offset_ns = max(self._offset_ns, machine_ns)
            return monotonic_ns + self._offset_ns

    def problems(self) -> tuple[str, ...]:
        """Problems of the machine's clock, as sentences for a person."""
        ahead_ns = self.utc_ns() - self._clock.utc_ns()
        if abs(ahead_ns) <= _REPORT_FROM_NS:
            return ()
        off_s = abs(ahead_ns) / NS_PER_S
        span = Measure(off_s, format_duration(off_s))
        if ahead_ns > 0:
            text = coded(
                "clock-behind",
                "This machine's clock is {off_s} behind what was recorded here last: set it. "
                "Times go on from there meanwhile",
                off_s=span,
            )
        else:
            text = coded(
                "clock-ahead",
                "This machine's clock is {off_s} ahead of the time that is recorded, which does "
                "not leap at a standby or in an open incident: set it, or close the incident",
                off_s=span,
            )
        return (text,)
