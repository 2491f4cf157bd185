"""Durability of the acknowledgements to journals: they outlive a power cut of the station."""

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
        """So many of these, the first ones, are on the disk."""
        ...


class DurableAckGate:
    """``note_report_received`` with each report, from one thread; any other asks."""

    def __init__(self, disk: Disk) -> None:
        self._disk = disk
        self._written: tuple[int | None, int | None] = (None, None)  # at the last two reports

    def note_report_received(self) -> None:
        self._written = self._written[1], self._disk.written

    def previous_report_is_durable(self) -> bool:
        """True if all messages of the report before the last one are on the disk."""
        written = self._written[0]
        return written is not None and written <= self._disk.on_disk
