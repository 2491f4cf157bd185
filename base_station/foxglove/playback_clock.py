"""Clock of a replay that clients play, pause and seek."""

from __future__ import annotations

import math

SPEED_MAX = 100.0
_SPEED_MIN = 0.01


class PlaybackClock:
    """Time within a recorded window; begins paused at its start.

    ``now_ns`` is monotonic time, and given by the caller.
    """

    def __init__(self, start_ns: int, end_ns: int, now_ns: int) -> None:
        self._start_ns, self._end_ns = start_ns, end_ns
        self._now_ns = now_ns
        self.at_ns = start_ns
        self.speed = 1.0
        self.is_playing = False

    @property
    def is_at_end(self) -> bool:
        return self.at_ns >= self._end_ns

    def advance(self, now_ns: int) -> int:
        """Return the time of the replay at ``now_ns``; pauses at the end of the window."""
        elapsed_ns, self._now_ns = max(now_ns - self._now_ns, 0), now_ns
        if self.is_playing:
            self.at_ns = min(self.at_ns + round(elapsed_ns * self.speed), self._end_ns)
            self.is_playing = not self.is_at_end
        return self.at_ns

    def hold(self, t_ns: int) -> None:
        """Put the time back to ``t_ns``: no more has been published."""
        self.at_ns = min(self.at_ns, t_ns)

    def play(self) -> None:
        """Go on; at the end, from the start."""
        if self.is_at_end:
            self.at_ns = self._start_ns
        self.is_playing = True

    def pause(self) -> None:
        self.is_playing = False

    def seek(self, t_ns: int) -> None:
        """Go to a time, or to the end of the window that is nearer to it."""
        self.at_ns = min(max(t_ns, self._start_ns), self._end_ns)

    def set_speed(self, speed: float) -> None:
        """Set the speed as a factor of real time; an invalid value is ignored."""
        if math.isfinite(speed) and speed > 0.0:
            self.speed = min(max(speed, _SPEED_MIN), SPEED_MAX)
