"""Dispatches: reports of the dispatch centre, from which incidents are opened.

A report never opens, renames or closes an incident: it is offered until an operator opens an
incident from it or dismisses it, and then belongs to that incident.
"""

from __future__ import annotations

import msgspec

from base_station.core.state import Dispatch, Incident, StationState
from shared.coded_text import coded
from shared.errors import UserError
from shared.messages.station import NoteDispatch

KEPT = 50  # offered or dismissed ones, newest last; the log and the tables have all


def note(state: StationState, report: NoteDispatch) -> None:
    """Take a report; one that is older than the known one changes nothing."""
    for incident_id, incident in state.incidents.items():
        state.incidents[incident_id] = _with_report(incident, report)
    state.closed_incidents = [_with_report(one, report) for one in state.closed_incidents]
    if incident_of(state, report.number) is not None:
        return
    known = find(state, report.number)
    if known is not None and known.report.updated_ns > report.updated_ns:
        return
    received_ns = state.t_ns if known is None else known.received_ns
    is_dismissed = known is not None and known.is_dismissed
    others = _dispatches_without(state, report.number)
    state.dispatches = (*others, Dispatch(report, received_ns, is_dismissed))[-KEPT:]


def dismiss(state: StationState, number: str) -> None:
    """Offer this dispatch no longer; UserError where there is none."""
    known = _required_dispatch(state, number)
    dismissed = msgspec.structs.replace(known, is_dismissed=True)
    state.dispatches = tuple(dismissed if one is known else one for one in state.dispatches)


def take(state: StationState, number: str) -> NoteDispatch:
    """Return the newest report of a dispatch from which an incident is opened now, and offer it no
    longer; UserError where there is none.
    """
    opened = incident_of(state, number)
    if opened is not None:
        raise UserError(
            coded(
                "dispatch-opened",
                "the dispatch {number} has opened the incident {incident!r} already",
                number=number,
                incident=opened.name,
            )
        )
    report = _required_dispatch(state, number).report
    state.dispatches = _dispatches_without(state, number)
    return report


def find(state: StationState, number: str) -> Dispatch | None:
    return next((one for one in state.dispatches if one.report.number == number), None)


def incident_of(state: StationState, number: str) -> Incident | None:
    """The incident that this dispatch has opened, open or closed."""
    incidents = [*state.closed_incidents, *state.incidents.values()]
    return next((one for one in incidents if _is_of(one, number)), None)


def _with_report(incident: Incident, report: NoteDispatch) -> Incident:
    known = incident.dispatch
    if known is None or known.number != report.number or known.updated_ns > report.updated_ns:
        return incident
    return msgspec.structs.replace(incident, dispatch=report)


def _is_of(incident: Incident, number: str) -> bool:
    return incident.dispatch is not None and incident.dispatch.number == number


def _dispatches_without(state: StationState, number: str) -> tuple[Dispatch, ...]:
    return tuple(one for one in state.dispatches if one.report.number != number)


def _required_dispatch(state: StationState, number: str) -> Dispatch:
    known = find(state, number)
    if known is None:
        raise UserError(
            coded(
                "dispatch-unknown",
                "there is no dispatch {number} from which no incident was opened",
                number=number,
            )
        )
    return known
