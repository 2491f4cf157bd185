"""Closed incidents, for data that arrives late."""

from __future__ import annotations

from base_station.core.state import Incident, StationState, UnitState

KEPT = 50  # closed ones, newest last; late data of older ones is only in the log


def add_closed_incident(state: StationState, incident: Incident) -> None:
    state.closed_incidents = [*state.closed_incidents[1 - KEPT :], incident]


def closed_incidents_at(state: StationState, t_ns: int) -> list[Incident]:
    """The closed incidents at this station time, newest first."""
    past = reversed(state.closed_incidents)
    return [one for one in past if one.opened_ns <= t_ns <= (one.closed_ns or 0)]


def last_closed_ns(state: StationState, site_id: str) -> int:
    """Time at which the last incident on this site was closed; 0: none was."""
    past = [one for one in state.closed_incidents if one.site_id == site_id]
    return max((one.closed_ns or 0 for one in past), default=0)


def is_before_incident(state: StationState, unit: UnitState, t_ns: int) -> bool:
    """True for a time before the unit came to its site, or before the last closing there, where
    another incident is open by now.
    """
    if t_ns < unit.site_ns:
        return True
    running = state.open_incident_of(unit)
    return running is not None and t_ns <= last_closed_ns(state, running.site_id)
