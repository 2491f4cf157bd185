"""Reads a satellite receiver in a thread of its own, beside whatever source a unit has.

While the receiver is off, gone or talks nonsense, the unit says why, once for each reason, and it
is tried again for ever.  That there is no fix is no fault: it is what happens indoors.
"""

from __future__ import annotations

import errno
import logging
from collections import deque
from dataclasses import replace

from edge.receivers.fix_clock import FixClock
from edge.receivers.port import Dialect, Report
from edge.samples import GpsSample
from edge.sources.line import Line
from edge.sources.line_place import why_not
from edge.sources.line_thread import LineThread
from shared.clock import NS_PER_S, Clock
from shared.errors import WireError

logger = logging.getLogger(__name__)

_MOST_WAITING = 600  # fixes that nobody took; the oldest are left out
_MOST_TOLD = 100
_SILENT_NS = 10 * NS_PER_S  # receivers say something every second, and gpsd seeks their speed first
_LOOK_NS = 10 * NS_PER_S
_MANY = 0.1  # of what came: a line that loses more is worth a look
_FEW = 3  # half a line after opening is none
_SHOWN = 40  # bytes of a garbled line


class GpsReader:
    """``start``, then ``take`` what came; see ``edge.sources.port.Beside``."""

    def __init__(self, dialect: Dialect, clock: Clock) -> None:
        self._dialect = dialect
        self._clock = clock
        self._fix_clock = FixClock(dialect.latency_s)
        self._waiting: deque[GpsSample] = deque(maxlen=_MOST_WAITING)
        self._faults: deque[str] = deque(maxlen=_MOST_TOLD)
        self._gone: set[str] = set()  # why there has been nothing since the last report
        self._thread = LineThread("gps", self, dialect.longest, clock)
        self.garbled = 0  # lines
        self.taken = 0  # reports that have a place in time
        self._last_ns = 0  # of the last report, or since the line is open
        self._has_spoken = False  # since the line is open
        self._repeats = False
        self._loss_told = False
        self._first_garbled = ""
        self._count_anew(0)

    @property
    def is_alive(self) -> bool:
        """Whether its thread runs."""
        return self._thread.is_alive

    def start(self) -> None:
        self._thread.start()

    def take(self) -> tuple[GpsSample, ...]:
        return tuple(self._waiting.popleft() for _ in range(len(self._waiting)))

    def take_faults(self) -> tuple[str, ...]:
        return tuple(self._faults.popleft() for _ in range(len(self._faults)))

    def close(self) -> None:
        self._thread.close()
        logger.info(
            "%s: %d reports; %d lines could not be read, %d reports came twice, %d had no time",
            *(self._dialect, self.taken, self.garbled),
            *(self._fix_clock.repeated, self._fix_clock.doubted),
        )

    def open(self) -> Line:
        return self._dialect.open()

    def opened(self) -> None:
        self._last_ns = self._clock.monotonic_ns()
        self._has_spoken = self._repeats = False
        self._count_anew(self._last_ns)

    def hear(self, line: bytes, began_ns: int) -> None:
        try:
            reports = self._dialect.hear(line, began_ns)
        except WireError as error:
            self.garbled += 1
            self._garbled += 1
            self._first_garbled = self._first_garbled or f"{line[:_SHOWN]!r} ({error})"
            return
        self._understood += 1
        self._put(reports)

    def turn(self, now_ns: int, *, paused: bool) -> bool:
        if paused:
            self._put(self._dialect.pause())
        if now_ns - self._last_ns > _SILENT_NS:
            self._say_gone(self._why_silent())
            return False
        if now_ns - self._looked_ns > _LOOK_NS and self._last_ns > self._looked_ns:
            self._look(now_ns)
        return True

    def gone(self, error: OSError | None) -> None:
        if self._garbled > self._understood:
            self._say_gone(self._why_silent())
        elif error is not None:
            self._say_gone(why_not(error, self._dialect.place))
        elif self._dialect.place.host:
            self._say_gone("it has ended the connection; is its program running?")
        else:
            self._say_gone(why_not(OSError(errno.EIO, "the line has ended"), self._dialect.place))
        self._count_anew(self._looked_ns)

    def _put(self, reports: tuple[Report, ...]) -> None:
        for report in reports:
            t_ns = self._fix_clock.place(report.of_day_ns, report.fix.t_ns)
            if t_ns is None:
                self._repeats = True
                continue
            self._waiting.append(replace(report.fix, t_ns=t_ns))
            self.taken += 1
            self._last_ns = self._clock.monotonic_ns()
            self._has_spoken = True
            self._repeats = False
            if self._gone:
                logger.info("%s speaks again", self._dialect)
                self._gone.clear()

    def _why_silent(self) -> str:
        why = self._dialect.why_nothing()
        if why:
            return why
        if self._repeats:
            return "it says the same instant again and again: it hangs; switch it off and on"
        if self._garbled > self._understood:
            return f"what comes is no receiver's: {self._first_garbled}; {self._dialect.hint}"
        if self._has_spoken:
            return "it has fallen silent; is it on, and the cable in?"
        return "the line is open and nothing comes; is it on, and the cable in?"

    def _look(self, now_ns: int) -> None:
        """A line that loses some of what is said, while the rest goes on: told once while it lasts,
        until ten seconds in which nothing was lost.
        """
        came = self._garbled + self._understood
        if not self._garbled:
            self._loss_told = False
        elif self._garbled > max(_FEW, _MANY * came) and not self._loss_told:
            self._loss_told = True
            self._say(
                f"{self._garbled} of {came} lines in {_LOOK_NS // NS_PER_S} s could not be read, "
                f"such as {self._first_garbled}; {self._dialect.hint}"
            )
        self._count_anew(now_ns)

    def _count_anew(self, now_ns: int) -> None:
        self._looked_ns = now_ns
        self._garbled = self._understood = 0
        self._first_garbled = ""

    def _say_gone(self, why: str) -> None:
        """Each reason once, however often it is tried again."""
        if why not in self._gone:
            self._gone.add(why)
            self._say(f"no fixes: {why}")

    def _say(self, fault: str) -> None:
        logger.warning("%s: %s", self._dialect, fault)
        self._faults.append(f"{self._dialect}: {fault}")
