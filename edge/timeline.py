"""How a source's own time lies on the unit's monotonic clock, and when a batch is due."""

from __future__ import annotations

from dataclasses import dataclass, replace

from shared.clock import NS_PER_S

_JUMP_NS = 10 * NS_PER_S


@dataclass(frozen=True, slots=True)
class Timeline:
    """A source played at ``speed`` from one instant on; as it stands, a live source's."""

    source_origin_ns: int = 0
    mono_origin_ns: int = 0
    speed: float = 1.0

    def to_mono_ns(self, t_ns: int) -> int:
        elapsed_ns = t_ns - self.source_origin_ns
        if self.speed != 1.0:
            elapsed_ns = round(elapsed_ns / self.speed)
        return self.mono_origin_ns + elapsed_ns


class Pacer:
    """Plays recorded time on the machine's clock.

    A jump of more than ten seconds in the recording is a clock that was set, not a wait:
    from there time is laid on anew.
    """

    def __init__(self, speed: float) -> None:
        self._timeline = Timeline(speed=speed)
        self._last_t_ns: int | None = None

    def place(self, first_t_ns: int, last_t_ns: int, now_mono_ns: int) -> Timeline:
        """The timeline of the batch whose samples lie between the two times."""
        before_ns = self._last_t_ns
        if before_ns is None or not -NS_PER_S < first_t_ns - before_ns < _JUMP_NS:
            self._timeline = replace(
                self._timeline, source_origin_ns=first_t_ns, mono_origin_ns=now_mono_ns
            )
        self._last_t_ns = last_t_ns
        return self._timeline
