"""Takes a report of the dispatch centre: logs its changes, and may open an incident."""

from __future__ import annotations

from typing import Literal

import msgspec

from base_station.api.idempotent_request import IdempotentRequest
from base_station.api.routes.incidents import new_incident_id
from base_station.api.services import Services
from base_station.dispatch.call_signs import CallSigns, KnownUnit, MatchedCallSign
from base_station.dispatch.config import Opening
from base_station.dispatch.description import incident_name
from base_station.views.station import dispatch_view
from base_station.views.wire import DispatchView, IncidentView, Snapshot
from shared.errors import UserError
from shared.messages.station import NoteDispatch, OpenIncident

Outcome = Literal["offered", "updated", "unchanged", "outdated", "opened"]


def take_report(station: Services, perform: IdempotentRequest, report: NoteDispatch) -> Outcome:
    """Log a report that has new content, and open an incident if the settings ask for it."""
    known = known_dispatch(station.picture(), report.number)
    outcome: Outcome = "offered" if known is None else "updated"
    if known is not None:
        new = dispatch_view(report, station.roster.known)
        if _content(known) == _content(new):
            return "unchanged"
        if (known.updated_ms or 0) > (new.updated_ms or 0):
            return "outdated"
    perform(report)
    return "opened" if _opens_incident(station, perform.by, report) else outcome


def known_dispatch(picture: Snapshot, number: str) -> DispatchView | None:
    """Newest report with this number that the station has shown."""
    incident = picture.incident
    of_incident = () if incident is None or incident.dispatch is None else (incident.dispatch,)
    return next((one for one in (*of_incident, *picture.dispatches) if one.number == number), None)


def open_incident_of(picture: Snapshot, number: str) -> IncidentView | None:
    """The open incident that was opened from this dispatch."""
    incident = picture.incident
    is_open = incident is not None and incident.closed_ms is None
    if not is_open or incident is None or incident.dispatch is None:
        return None
    return incident if incident.dispatch.number == number else None


def matched_units(
    station: Services, picture: Snapshot, call_signs: tuple[str, ...]
) -> tuple[MatchedCallSign, ...]:
    """Call signs with the crews of the roster, and the units of the live picture, that have the
    same name.
    """
    crews = {person.crew for person in station.roster.people() if person.crew}
    units = [KnownUnit(unit.unit_id, unit.label) for unit in picture.units if unit.registered]
    return CallSigns(station.dispatch.units).matched(call_signs, sorted(crews), units)


def _opens_incident(station: Services, by: str, report: NoteDispatch) -> bool:
    """Open an incident from an offered dispatch, unless one is open.  True if it was opened."""
    if station.dispatch.open is not Opening.AUTOMATICALLY or report.has_ended:
        return False
    picture = station.picture()
    is_open = picture.incident is not None and picture.incident.closed_ms is None
    offered = known_dispatch(msgspec.structs.replace(picture, incident=None), report.number)
    if is_open or offered is None or offered.is_dismissed:
        return False
    usual = station.accountability
    opening = OpenIncident(
        new_incident_id(station),
        incident_name(report),
        usual.par_interval_s,
        usual.work_limit_s,
        report.number,
    )
    try:
        station.perform(by, opening)
    except UserError:  # a person has opened one meanwhile: it stays offered
        return False
    return True


def _content(dispatch: DispatchView) -> DispatchView:
    """The report without the fields that differ between two reports of the same content."""
    return msgspec.structs.replace(
        dispatch,
        updated_ms=None,
        received_ms=None,
        is_dismissed=False,
        warnings=(),
        warning_codes=(),
    )
