"""Kinds of trails of an incident: raw, as shown at the time, and post-processed."""

from __future__ import annotations

from enum import StrEnum


class TrailKind(StrEnum):
    RAW = "raw"  # the unit's own path, placed by its start
    FUSED = "fused"  # as shown at the time
    SMOOTHED = "smoothed"  # the best that is known afterwards

    @property
    def in_words(self) -> str:
        """For a file that has a name."""
        return _IN_WORDS[self]

    def file_name(self, incident_id: str, suffix: str) -> str:
        which = "" if self is TrailKind.FUSED else f"-{self.value}"
        return f"{incident_id}{which}.{suffix}"


_IN_WORDS = {
    TrailKind.RAW: "by the units' own paths alone",
    TrailKind.FUSED: "as it was shown",
    TrailKind.SMOOTHED: "as it is known afterwards",
}
