"""Device that is read again and again, in a thread of its own.

One that hangs, is gone or is broken delays nothing; why it cannot be read is reported once for each
reason, and it is read again for ever.  What cannot be read has no value: none is invented.
"""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from threading import Event, Thread
from typing import Generic, TypeVar

from edge.fault_texts import fault_of, program_error
from edge.sources.sysfs import explain_read_error
from shared.clock import NS_PER_S, Clock
from shared.coded_text import coded

logger = logging.getLogger(__name__)

_STALE_NS = 5 * NS_PER_S  # without a reading: a 1-wire sensor takes a second
_RECOVERED_NS = 10 * NS_PER_S  # of readings, after which the same reason is reported again
_SAMPLES_MAX = 100  # readings that were not taken; the oldest are dropped
_JOIN_TIMEOUT_S = 0.5  # one that hangs is left behind

Sample = TypeVar("Sample")


@dataclass(frozen=True, slots=True)
class Unreadable:
    """Reason, for a person, why a device has no reading now."""

    reason: str


class PolledDevice(Generic[Sample]):
    """``start``, then ``take`` what was read."""

    def __init__(
        self,
        title: str,
        read: Callable[[], Sample | Unreadable],
        period_s: float,
        clock: Clock,
    ) -> None:
        """``title``: for a person.  ``read`` may take its time, and raise OSError."""
        self._title = title
        self._read_device = read
        self._period_s = period_s
        self._clock = clock
        self._samples: deque[Sample] = deque(maxlen=_SAMPLES_MAX)
        self._faults: deque[str] = deque(maxlen=_SAMPLES_MAX)
        self._reasons: set[str] = set()  # reported, and not over yet
        self._attempted_ns = clock.monotonic_ns()  # when a reading last ended, whatever came of it
        self._failed_ns = 0
        self._hangs = False
        self._stop = Event()
        self._thread = Thread(target=self._run, name=title, daemon=True)

    def start(self) -> None:
        self._attempted_ns = self._clock.monotonic_ns()
        self._thread.start()

    def take(self) -> tuple[Sample, ...]:
        return tuple(self._samples.popleft() for _ in range(len(self._samples)))

    def take_faults(self) -> tuple[str, ...]:
        silent_ns = self._clock.monotonic_ns() - self._attempted_ns
        if silent_ns > _STALE_NS + self._period_s * NS_PER_S and not self._hangs:
            self._hangs = True
            self._report_fault(
                coded(
                    "reading-hangs",
                    "no reading for {silent_s:.0f} s: it hangs",
                    silent_s=silent_ns // NS_PER_S,
                )
            )
        return tuple(self._faults.popleft() for _ in range(len(self._faults)))

    def stop(self) -> None:
        self._stop.set()

    def join(self) -> None:
        if self._thread.is_alive():
            self._thread.join(_JOIN_TIMEOUT_S)

    def _run(self) -> None:
        while not self._stop.is_set():
            found = self._read()
            self._attempted_ns = now_ns = self._clock.monotonic_ns()
            self._hangs = False
            if isinstance(found, Unreadable):
                self._failed_ns = now_ns
                self._report_reason(found.reason)
            else:
                self._samples.append(found)
                self._report_return(now_ns)
            self._stop.wait(self._period_s)

    def _read(self) -> Sample | Unreadable:
        try:
            return self._read_device()
        except OSError as error:
            return Unreadable(explain_read_error(error))
        except Exception as error:  # one device must not end the reading for good
            logger.exception("%s failed", self._title)
            return Unreadable(program_error(error))

    def _report_reason(self, reason: str) -> None:
        if reason not in self._reasons:
            self._reasons.add(reason)
            self._report_fault(coded("no-reading", "no reading: {reason}", reason=reason))

    def _report_return(self, now_ns: int) -> None:
        """A loose contact comes and goes: what was reported is over after a while of readings."""
        if self._reasons and now_ns - self._failed_ns > _RECOVERED_NS:
            logger.info("%s can be read again", self._title)
            self._reasons.clear()

    def _report_fault(self, fault: str) -> None:
        text = fault_of(self._title, fault)
        logger.warning(text)
        self._faults.append(text)
