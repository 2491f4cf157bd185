"""Incidents that were closed: what still comes to be known of their time."""

from __future__ import annotations

from base_station.live_state import Incident, StationState

KEPT = 50  # closed ones, newest last; of what comes later of older ones only the log tells


def note_closed(state: StationState, incident: Incident) -> None:
    state.past_incidents = [*state.past_incidents[1 - KEPT :], incident]


def incident_of(state: StationState, t_ns: int) -> Incident | None:
    """The closed incident in whose time this was."""
    for incident in reversed(state.past_incidents):
        if incident.closed_ns is not None and t_ns > incident.closed_ns:
            return None
        if t_ns >= incident.opened_ns:
            return incident
    return None


def is_before_incident(state: StationState, t_ns: int) -> bool:
    """Whether this was before the last one was closed, and another one is open by now."""
    running, past = state.incident, state.past_incidents
    if running is None or running.closed_ns is not None or not past:
        return False
    return t_ns <= (past[-1].closed_ns or 0)
