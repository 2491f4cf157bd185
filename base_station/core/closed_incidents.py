"""Closed incidents, for data that arrives late."""

from __future__ import annotations

from base_station.core.state import Incident, StationState

KEPT = 50  # closed ones, newest last; of what comes later of older ones only the log tells


def add_closed_incident(state: StationState, incident: Incident) -> None:
    state.closed_incidents = [*state.closed_incidents[1 - KEPT :], incident]


def closed_incident_at(state: StationState, t_ns: int) -> Incident | None:
    """The closed incident at this station time."""
    for incident in reversed(state.closed_incidents):
        if incident.closed_ns is not None and t_ns > incident.closed_ns:
            return None
        if t_ns >= incident.opened_ns:
            return incident
    return None


def is_before_incident(state: StationState, t_ns: int) -> bool:
    """True for a time before the last closing, where another incident is open by now."""
    running, past = state.incident, state.closed_incidents
    if running is None or running.closed_ns is not None or not past:
        return False
    return t_ns <= (past[-1].closed_ns or 0)
