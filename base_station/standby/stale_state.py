"""Check for a stale state: it was made without records that the log has again since.

A disk that loses a part of the log costs nothing as long as the station runs: it had stepped what
came.  One that has started since then has stepped the log without that part.
"""

from __future__ import annotations

from shared.coded_text import coded


class StaleState:
    """From any thread."""

    def __init__(self) -> None:
        self._from_ns = self._to_ns = 0
        self.is_stale = False

    def note_stepped(self, from_ns: int, to_ns: int) -> None:
        """The station stepped this part of the log as it started, behind its checkpoint."""
        self._from_ns, self._to_ns = from_ns, to_ns

    def note_mended(self, end_ns: int) -> None:
        """A segment that ends there is whole again."""
        self.is_stale = self.is_stale or self._from_ns < end_ns <= self._to_ns

    def can_recover(self, *, leads: bool, spared: bool, in_incident: bool) -> bool:
        """True if to start again and step it: a standby at once, one that leads when the other
        can take over (``spared``) and no incident is open.
        """
        return self.is_stale and (not leads or (spared and not in_incident))

    def problems(self) -> tuple[str, ...]:
        """Sentences for the console."""
        problem = coded(
            "state-stale",
            "What the disk had lost of the log is there again, and this station's picture was made "
            "without it. It is made anew as soon as the other station is in step and no incident "
            "is open; to have it now, let the other one take over",
        )
        return (problem,) if self.is_stale else ()
