"""Restart of a running station: on request, and if its live state was made from a damaged log."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from base_station.core.log_position import LogPosition
from base_station.standby.stale_state import StaleState


class Restart(NamedTuple):
    """Request that the station starts again; as a standby if another station leads."""

    cut_from: LogPosition | None  # behind which the log goes its own way
    is_repaired: bool = False  # its saved state was made without the missing part


class RestartControl:
    """Control of restarts.  Thread-safe."""

    def __init__(
        self,
        stop: Callable[[], None],
        *,
        is_leader: Callable[[], bool],
        has_standby: Callable[[], bool],
        is_in_incident: Callable[[], bool],
    ) -> None:
        """``stop`` ends the station; ``has_standby`` tells whether another station can take
        over.
        """
        self._stop = stop
        self._is_leader = is_leader
        self._has_standby = has_standby
        self._is_in_incident = is_in_incident
        self.stale = StaleState()
        self.requested: Restart | None = None

    def request(self, cut_from: LogPosition | None) -> None:
        """End the station so that it starts again."""
        self.requested = self.requested or Restart(cut_from, self.stale.is_stale)
        self._stop()

    def note_repaired(self, end_ns: int) -> None:
        """Note that the segment of the log which ends at this time was repaired."""
        self.stale.note_mended(end_ns)
        self.restart_if_stale()

    def restart_if_stale(self) -> None:
        """Restart the station if the live state is stale and no incident is open."""
        has_standby, in_incident = self._has_standby(), self._is_in_incident()
        if self.stale.can_recover(
            leads=self._is_leader(), spared=has_standby, in_incident=in_incident
        ):
            self.request(None)
