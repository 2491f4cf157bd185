"""Live state for the other parts of the station.  There is none until the log has been read."""

from __future__ import annotations

from collections.abc import Mapping

from base_station.core.alarms.thresholds import Thresholds
from base_station.core.state import StationState
from base_station.fusion import FUSERS


class LiveState:
    """Access to the live state.  Thread-safe."""

    def __init__(self, thresholds: Thresholds, fuser: str) -> None:
        """Thresholds of the alarm rules and name of the fuser, from the settings."""
        self.configured_thresholds = thresholds
        self.configured_fuser = fuser
        self._state: StationState | None = None

    def begin(self, state: StationState) -> None:
        """Set the live state, once the log has been read."""
        self._state = state

    def is_in_incident(self) -> bool:
        """True while an incident is open."""
        return self._state is not None and bool(self._state.open_incidents)

    @property
    def problems(self) -> Mapping[str, str]:
        """Problems of the station's parts, from the log."""
        return {} if self._state is None else self._state.problems

    @property
    def thresholds(self) -> Thresholds:
        """Thresholds of the alarm rules in use, from the log."""
        return self.configured_thresholds if self._state is None else self._state.thresholds

    @property
    def fuser(self) -> str:
        """Name of the fuser in use, from the log."""
        return self.configured_fuser if self._state is None else self._state.fuser or FUSERS[0].name
