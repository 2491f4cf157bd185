"""Timelines: mapping of a source's own time to this machine's monotonic clock."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

from shared.clock import NS_PER_S

_JUMP_NS = 10 * NS_PER_S
_BACK_NS = NS_PER_S  # by which a clock goes back that was set
_DRIFT = 2e-4  # of one quartz against another, at most


@dataclass(frozen=True, slots=True)
class Timeline:
    """Timeline of a source played at ``speed`` from one instant on; by default that of a live
    source.
    """

    source_origin_ns: int = 0
    mono_origin_ns: int = 0
    speed: float = 1.0

    def to_mono_ns(self, t_ns: int) -> int:
        elapsed_ns = t_ns - self.source_origin_ns
        if self.speed != 1.0:
            elapsed_ns = round(elapsed_ns / self.speed)
        return self.mono_origin_ns + elapsed_ns


class Timekeeper(Protocol):
    """Mapping of a source's time to the machine's, batch by batch."""

    def place(self, first_t_ns: int, last_t_ns: int, now_mono_ns: int) -> Timeline:
        """Return the timeline of the batch whose samples lie between the two times."""
        ...


class Pacer:
    """Timekeeper that plays recorded time on the machine's clock.

    A jump of more than ten seconds in the recording is a clock that was set, not a wait:
    from there time is laid on anew.
    """

    def __init__(self, speed: float) -> None:
        self._timeline = Timeline(speed=speed)
        self._last_t_ns: int | None = None

    def place(self, first_t_ns: int, last_t_ns: int, now_mono_ns: int) -> Timeline:
        before_ns = self._last_t_ns
        if before_ns is None or not -NS_PER_S < first_t_ns - before_ns < _JUMP_NS:
            self._timeline = replace(
                self._timeline, source_origin_ns=first_t_ns, mono_origin_ns=now_mono_ns
            )
        self._last_t_ns = last_t_ns
        return self._timeline


class Follower:
    """Timekeeper that maps the clock of another machine to this one, while its samples come.

    The quickest of them says how the two stand: one that the radio held up says nothing, and a
    backlog neither.  Over a shift two clocks drift seconds apart, and that is followed.
    """

    def __init__(self) -> None:
        self._last_t_ns = 0
        self._ahead_ns: int | None = None  # this machine's time less the other's

    def place(self, first_t_ns: int, last_t_ns: int, now_mono_ns: int) -> Timeline:
        delay_ns = now_mono_ns - last_t_ns
        elapsed_ns = last_t_ns - self._last_t_ns
        if self._ahead_ns is None or elapsed_ns < -_BACK_NS:
            self._ahead_ns = delay_ns
        else:
            self._ahead_ns = min(delay_ns, self._ahead_ns + round(_DRIFT * max(elapsed_ns, 0)))
        self._last_t_ns = last_t_ns
        return Timeline(first_t_ns, first_t_ns + self._ahead_ns)
