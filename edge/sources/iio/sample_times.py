"""Times of captured samples, on this machine's monotonic clock.

A driver stamps a sample as it is taken, by a clock that can be chosen since Linux 4.8: the
monotonic one.  Where it cannot be chosen, stamps are laid onto the monotonic clock by when they
come.  A sample with an impossible time stamp is dropped.
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
        """Samples of a time that cannot be."""
        ...

    def place(
        self, stamps_ns: Nanoseconds, arrival_ns: int
    ) -> tuple[Nanoseconds, NDArray[np.bool_]]:
        """Return the times of the samples that have a place, and which they are."""
        ...

    def take_events(self) -> list[str]: ...


def choose_clock(device: Path) -> SampleTimes:
    """Choose the monotonic clock where the device lets one.  Raises OSError."""
    if read_if_there(device / _CLOCK) is None:
        return MappedTimes()
    write_text(device / _CLOCK, _MONOTONIC)
    is_monotonic = read_if_there(device / _CLOCK) == _MONOTONIC
    return MonotonicTimes() if is_monotonic else MappedTimes()


class MonotonicTimes:
    """Times that the driver takes from the monotonic clock."""

    def __init__(self) -> None:
        self._last_ns = 0
        self.implausible = 0

    def place(
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
    """Times of another clock, laid onto the monotonic one by when they come."""

    def __init__(self) -> None:
        self._clock = DeviceClock()

    @property
    def implausible(self) -> int:
        return self._clock.implausible

    def place(
        self, stamps_ns: Nanoseconds, arrival_ns: int
    ) -> tuple[Nanoseconds, NDArray[np.bool_]]:
        """The newest stamp of a read shows how long the others waited."""
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
