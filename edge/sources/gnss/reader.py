"""Reader of a satellite receiver in a thread of its own, beside whatever source a unit has.

While the receiver is off, gone or talks nonsense, the unit says why, once for each reason, and it
is tried again for ever.  That there is no fix is no fault: it is what happens indoors.
"""

from __future__ import annotations

import errno
import logging
from collections import deque
from dataclasses import replace

from edge.fault_texts import fault_of
from edge.samples import GpsSample
from edge.sources.gnss.fix_clock import FixClock
from edge.sources.gnss.interface import Dialect, Report
from edge.sources.transport.address import explain_os_error
from edge.sources.transport.connection import Connection
from edge.sources.transport.line_reader import LineReader
from shared.clock import NS_PER_S, Clock
from shared.coded_text import coded
from shared.errors import WireError

logger = logging.getLogger(__name__)

_FIXES_MAX = 600  # fixes that were not taken; the oldest are dropped
_FAULTS_MAX = 100
_SILENT_NS = 10 * NS_PER_S  # receivers say something every second, and gpsd seeks their speed first
_CHECK_NS = 10 * NS_PER_S
_MANY = 0.1  # of what came: a line that loses more is worth a look
_FEW = 3  # half a line after opening is none
_SHOWN = 40  # bytes of a garbled line


class GnssReader:
    """``start``, then ``take`` what came; see ``edge.sources.interface.AuxiliarySource``."""

    def __init__(self, dialect: Dialect, clock: Clock) -> None:
        self._dialect = dialect
        self._clock = clock
        self._fix_clock = FixClock(dialect.latency_s)
        self._waiting: deque[GpsSample] = deque(maxlen=_FIXES_MAX)
        self._faults: deque[str] = deque(maxlen=_FAULTS_MAX)
        self._silence_reasons: set[str] = set()  # why there has been nothing since the last report
        self._thread = LineReader("gps", self, dialect.longest, clock)
        self.garbled = 0  # lines
        self.taken = 0  # reports that have a place in time
        self._last_ns = 0  # of the last report, or since the line is open
        self._has_reported = False  # since the line is open
        self._repeats = False
        self._loss_reported = False
        self._first_garbled = ""
        self._reset_counts(0)

    @property
    def is_alive(self) -> bool:
        """True while its thread runs."""
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
            *(self._fix_clock.repeated, self._fix_clock.implausible),
        )

    def open(self) -> Connection:
        return self._dialect.open()

    def on_open(self) -> None:
        self._last_ns = self._clock.monotonic_ns()
        self._has_reported = self._repeats = False
        self._reset_counts(self._last_ns)

    def on_line(self, line: bytes, began_ns: int) -> None:
        try:
            reports = self._dialect.parse_line(line, began_ns)
        except WireError as error:
            self.garbled += 1
            self._garbled += 1
            self._first_garbled = self._first_garbled or f"{line[:_SHOWN]!r} ({error})"
            return
        self._understood += 1
        self._put(reports)

    def keeps_open(self, now_ns: int, *, paused: bool) -> bool:
        if paused:
            self._put(self._dialect.end_of_burst())
        if now_ns - self._last_ns > _SILENT_NS:
            self._report_silence(self._silence_reason())
            return False
        if now_ns - self._checked_ns > _CHECK_NS and self._last_ns > self._checked_ns:
            self._check_loss(now_ns)
        return True

    def on_close(self, error: OSError | None) -> None:
        if self._garbled > self._understood:
            self._report_silence(self._silence_reason())
        elif error is not None:
            self._report_silence(explain_os_error(error, self._dialect.place))
        elif self._dialect.place.host:
            self._report_silence(
                coded("gps-ended", "it has ended the connection; is its program running?")
            )
        else:
            self._report_silence(
                explain_os_error(OSError(errno.EIO, "the line has ended"), self._dialect.place)
            )
        self._reset_counts(self._checked_ns)

    def _put(self, reports: tuple[Report, ...]) -> None:
        for report in reports:
            t_ns = self._fix_clock.place(report.of_day_ns, report.fix.t_ns)
            if t_ns is None:
                self._repeats = True
                continue
            self._waiting.append(replace(report.fix, t_ns=t_ns))
            self.taken += 1
            self._last_ns = self._clock.monotonic_ns()
            self._has_reported = True
            self._repeats = False
            if self._silence_reasons:
                logger.info("%s speaks again", self._dialect)
                self._silence_reasons.clear()

    def _silence_reason(self) -> str:
        reason = self._dialect.silence_reason()
        if reason:
            return reason
        if self._repeats:
            return coded(
                "gps-hangs",
                "it says the same instant again and again: it hangs; switch it off and on",
            )
        if self._garbled > self._understood:
            return coded(
                "gps-no-receiver",
                "what comes is no receiver's: {garbled}; {hint}",
                garbled=self._first_garbled,
                hint=self._dialect.hint,
            )
        if self._has_reported:
            return coded("gps-silent", "it has fallen silent; is it on, and the cable in?")
        return coded(
            "gps-nothing", "the line is open and nothing comes; is it on, and the cable in?"
        )

    def _check_loss(self, now_ns: int) -> None:
        """Report a line that loses data while the rest goes on: once while it lasts, until ten
        seconds without loss.
        """
        received = self._garbled + self._understood
        if not self._garbled:
            self._loss_reported = False
        elif self._garbled > max(_FEW, _MANY * received) and not self._loss_reported:
            self._loss_reported = True
            self._report_fault(
                coded(
                    "gps-garbled",
                    "{garbled} of {received} lines in {within_s:.0f} s could not be read, such as "
                    "{first}; {hint}",
                    garbled=self._garbled,
                    received=received,
                    within_s=_CHECK_NS / NS_PER_S,
                    first=self._first_garbled,
                    hint=self._dialect.hint,
                )
            )
        self._reset_counts(now_ns)

    def _reset_counts(self, now_ns: int) -> None:
        self._checked_ns = now_ns
        self._garbled = self._understood = 0
        self._first_garbled = ""

    def _report_silence(self, reason: str) -> None:
        """Each reason once, however often it is tried again."""
        if reason not in self._silence_reasons:
            self._silence_reasons.add(reason)
            self._report_fault(coded("gps-no-fixes", "no fixes: {reason}", reason=reason))

    def _report_fault(self, fault: str) -> None:
        logger.warning("%s: %s", self._dialect, fault)
        self._faults.append(fault_of(self._dialect.title, fault))
