"""Times of captured samples, on this machine's monotonic clock.

A driver gives each sample the time at which it was taken.  Since Linux 4.8 the clock of these time
stamps can be set, here to the monotonic one.  Where it cannot be set, time stamps are converted to
the monotonic clock by their time of arrival.  A sample with an implausible time stamp is dropped.
"""

from __future__ import annotations

from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from edge.samples import Nanoseconds
from edge.sources.device_clock import DeviceClock
from edge.sources.sysfs import read_if_there, write_text
from shared.clock import NS_PER_S

_CLOCK = "current_timestamp_clock"
_MONOTONIC = "monotonic"
_AHEAD_NS = NS_PER_S // 10  # drivers of hardware buffers estimate when a sample was taken
_OLD_NS = 10 * NS_PER_S  # longer than a buffer holds


class SampleTimes(Protocol):
    @property
    def implausible(self) -> int:
        """Number of samples with an implausible time stamp."""
        ...

    def to_monotonic(
        self, stamps_ns: Nanoseconds, arrival_ns: int
    ) -> tuple[Nanoseconds, NDArray[np.bool_]]:
        """Return the monotonic times of the plausible samples, and the mask of these samples."""
        ...

    def take_events(self) -> list[str]: ...


def choose_clock(device: Path) -> SampleTimes:
    """Set the device's clock to the monotonic one where that is possible.  Raises OSError."""
    if read_if_there(device / _CLOCK) is None:
        return MappedTimes()
    write_text(device / _CLOCK, _MONOTONIC)
    is_monotonic = read_if_there(device / _CLOCK) == _MONOTONIC
    return MonotonicTimes() if is_monotonic else MappedTimes()


class MonotonicTimes:
    """Time stamps that are of the monotonic clock already."""

    def __init__(self) -> None:
        self._last_ns = 0
        self.implausible = 0

    def to_monotonic(
        self, stamps_ns: Nanoseconds, arrival_ns: int
    ) -> tuple[Nanoseconds, NDArray[np.bool_]]:
        can_be = (stamps_ns <= arrival_ns + _AHEAD_NS) & (stamps_ns > arrival_ns - _OLD_NS)
        newest_ns = np.maximum.accumulate(np.where(can_be, stamps_ns, self._last_ns))
        before_ns = np.concatenate(([self._last_ns], newest_ns))[:-1]
        is_placed = can_be & (stamps_ns > np.maximum(before_ns, self._last_ns))
        self.implausible += int((~can_be).sum())
        times_ns = stamps_ns[is_placed]
        if len(times_ns):
            self._last_ns = int(times_ns[-1])
        return times_ns, is_placed

    def take_events(self) -> list[str]:
        return []


class MappedTimes:
    """Time stamps of another clock, converted by their time of arrival."""

    def __init__(self) -> None:
        self._clock = DeviceClock()

    @property
    def implausible(self) -> int:
        return self._clock.implausible

    def to_monotonic(
        self, stamps_ns: Nanoseconds, arrival_ns: int
    ) -> tuple[Nanoseconds, NDArray[np.bool_]]:
        """The newest time stamp of a read shows how long the other samples waited."""
        newest_ns = int(stamps_ns.max(initial=0))
        times_ns = [
            self._clock.place(stamp_ns, arrival_ns - min(newest_ns - stamp_ns, NS_PER_S))
            for stamp_ns in stamps_ns.tolist()
        ]
        placed = [time_ns for time_ns in times_ns if time_ns is not None]
        is_placed = np.array([time_ns is not None for time_ns in times_ns], bool)
        return np.array(placed, np.int64), is_placed

    def take_events(self) -> list[str]:
        return self._clock.take_events()
