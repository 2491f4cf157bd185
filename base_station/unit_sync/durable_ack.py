"""Durability of acknowledgements to journals: only messages that are safe from a power cut of the
station are acknowledged.
"""

from __future__ import annotations

from typing import Protocol


class Disk(Protocol):
    """Disk on which messages of units are kept."""

    @property
    def written(self) -> int:
        """Records that were taken so far."""
        ...

    @property
    def on_disk(self) -> int:
        """Number of the first of these that are on the disk."""
        ...


class DurableAckGate:
    """Gate for acknowledgements; one thread calls ``note_report_received`` at each report, any may
    read.
    """

    def __init__(self, disk: Disk) -> None:
        self._disk = disk
        self._written: tuple[int | None, int | None] = (None, None)  # at the last two reports

    def note_report_received(self) -> None:
        self._written = self._written[1], self._disk.written

    def previous_report_is_durable(self) -> bool:
        """True if all messages of the report before the last one are on the disk."""
        written = self._written[0]
        return written is not None and written <= self._disk.on_disk
