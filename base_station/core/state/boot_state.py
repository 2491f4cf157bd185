"""One run of a unit's program, seen from the station.

Its received messages, its clock offset, and its time of presence: two runs that were present at the
same time are two machines under one name.
"""

from __future__ import annotations

from collections.abc import Iterable

import msgspec

from shared.clock import NS_PER_S
from shared.messages import Header
from shared.sequence_set import SequenceSet

CLOCK_DRIFT_PART = 10_000  # a unit's clock drifts by at most so small a part of the time
LIVE_WITHIN_NS = 5 * NS_PER_S  # a live message is slower than the fastest by at most this
BACKDATED_NS = 60 * NS_PER_S  # by a unit that knows the station's time
CLOCK_SET_NS = 60 * NS_PER_S  # all messages late by this: the station's clock was set
CLOCK_SET_MESSAGES = 20  # in a row
UNIT_OFFSET_SLACK_NS = NS_PER_S // 20
SLOWEST_NS = 30 * NS_PER_S  # a clock estimate is wrong if all messages would be slower


class BootState(msgspec.Struct):
    """Times are station time; ``0`` where a field is of time: never."""

    boot_id: int
    seen: SequenceSet = msgspec.field(default_factory=SequenceSet)
    min_offset_ns: int = 0  # station time less the unit's monotonic time, of the fastest message
    min_offset_t_ns: int = 0  # when that was judged
    unit_offset_ns: int | None = None  # the same as the unit itself estimates it, where that can be
    clock_std_s: float = 0.0  # of the unit's estimate; 0: it has none
    late: int = 0  # messages in a row that were too late to be explained by the link
    first_live_ns: int = 0  # capture time of the first message that was of now when it came
    last_live_ns: int = 0  # and of the newest

    @property
    def is_placed(self) -> bool:
        """True if its times can be converted to station time."""
        return self.min_offset_t_ns != 0

    @property
    def offset_ns(self) -> int:
        """Station time less the unit's monotonic time."""
        return self.min_offset_ns if self.unit_offset_ns is None else self.unit_offset_ns

    def station_ns(self, t_mono_ns: int) -> int:
        return t_mono_ns + self.offset_ns

    def note(self, t_ns: int, header: Header) -> bool:
        """Update the clock offset by a message.  True if the message is live, neither delayed nor
        repeated.
        """
        slower_ns = t_ns - header.t_mono_ns - self._bound_clock(t_ns, header)
        if slower_ns > LIVE_WITHIN_NS:
            return False
        if header.utc_std_s > 0.0 and abs(t_ns - header.t_utc_ns) > BACKDATED_NS:
            return False
        captured_ns = t_ns - max(slower_ns, 0)
        if self.first_live_ns == 0:
            self.first_live_ns = captured_ns
        self.last_live_ns = max(self.last_live_ns, captured_ns)
        return True

    def _bound_clock(self, t_ns: int, header: Header) -> int:
        """Return the bound of the offset by the least delayed message, with the drift of clocks
        since.  Within that bound the unit's own estimate is better.
        """
        offset_ns = t_ns - header.t_mono_ns
        drifted_ns = self.min_offset_ns + (t_ns - self.min_offset_t_ns) // CLOCK_DRIFT_PART
        self.late = self.late + 1 if offset_ns > drifted_ns + CLOCK_SET_NS else 0
        was_set = self.late >= CLOCK_SET_MESSAGES
        if offset_ns < drifted_ns or self.min_offset_t_ns == 0 or was_set:
            self.min_offset_ns, self.min_offset_t_ns, self.late = offset_ns, t_ns, 0
            drifted_ns = offset_ns
        self.clock_std_s = header.utc_std_s
        self.unit_offset_ns = (
            _unit_offset_ns(header, drifted_ns) if header.utc_std_s > 0.0 else None
        )
        return drifted_ns

    @property
    def live_ns(self) -> int:
        """Time for which it was live; no overlap is longer."""
        return self.last_live_ns - self.first_live_ns

    def overlap_ns(self, other: BootState) -> int:
        """Time for which both were live at once; not positive: one after the other."""
        return min(self.last_live_ns, other.last_live_ns) - max(
            self.first_live_ns, other.first_live_ns
        )


def captured_ns(boots: Iterable[BootState], header: Header, now_ns: int) -> int | None:
    """Capture time of a message by the station's clock, at most the present; None where the run's
    clock is unknown.
    """
    boot = next((one for one in boots if one.boot_id == header.boot_id), None)
    if boot is None or not boot.is_placed:
        return None
    return min(boot.station_ns(header.t_mono_ns), now_ns)


def event_time_ns(boots: Iterable[BootState], header: Header, now_ns: int) -> int | None:
    """The same; of a run of which nothing came live, by the unit's own estimate of station time.
    None: the time is unknown.
    """
    known_ns = captured_ns(boots, header, now_ns)
    if known_ns is None and header.utc_std_s > 0.0:
        return min(header.t_utc_ns, now_ns)
    return known_ns


def _unit_offset_ns(header: Header, drifted_ns: int) -> int | None:
    """The offset as the unit estimates it, where that can be."""
    unit_offset_ns = header.t_utc_ns - header.t_mono_ns
    slack_ns = UNIT_OFFSET_SLACK_NS + round(3.0 * header.utc_std_s * NS_PER_S)
    return unit_offset_ns if -slack_ns <= drifted_ns - unit_offset_ns <= SLOWEST_NS else None
