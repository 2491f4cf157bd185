"""Copies that may contain people who were erased.  An erasure is complete when they were made
again.
"""

from __future__ import annotations

from collections.abc import Callable

from base_station.storage.db.archived import ArchivedCopies
from base_station.views.wire import ArchiveView
from shared.coded_text import coded


class OutdatedCopies:
    """Problems of outdated copies, as of the last refresh.  Thread-safe."""

    def __init__(
        self,
        copies: ArchivedCopies,
        archive: Callable[[], ArchiveView | None],
        leads: Callable[[], bool],
    ) -> None:
        """``archive``: the one to which the station copies; None if there is none.  ``leads``: of
        two stations only the leading one makes copies again.
        """
        self._copies, self._archive, self._leads = copies, archive, leads
        self._by_address: dict[str, int] = {}

    def refresh(self) -> None:
        """Read the counts from the database again.  Raises StoreError."""
        self._by_address = self._copies.outdated_by_erasure()

    def problems(self) -> tuple[str, ...]:
        """A sentence for a person about each archive with outdated copies."""
        own = self._archive()
        return tuple(
            _problem(address, count, own)
            for address, count in sorted(self._by_address.items())
            if self._leads() or own is None or own.location != address
        )


def _problem(address: str, count: int, own: ArchiveView | None) -> str:
    if own is None or own.location != address:
        return coded(
            "erased-in-other-archive",
            "{count} copies in the archive {archive} may have people who were erased, and the "
            "station does not copy there: give muster base archive copy {archive}",
            count=count,
            archive=address,
        )
    if own.text:
        return coded(
            "erased-in-archive-away",
            "{count} copies in the archive {archive} may have people who were erased; they are "
            "made anew later: {reason}",
            count=count,
            archive=address,
            reason=own.text,
        )
    return coded(
        "erased-in-archive",
        "{count} copies in the archive {archive} may have people who were erased; they are being "
        "made anew",
        count=count,
        archive=address,
    )
