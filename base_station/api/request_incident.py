"""Incident to which a request refers: the one that it names, or else the only open one."""

from __future__ import annotations

from base_station.api.problems import Problem
from base_station.api.services import Services
from base_station.views.wire import IncidentView
from shared.coded_text import coded


def open_incidents(station: Services) -> list[IncidentView]:
    """Incidents that are open now, in the order in which they were opened."""
    return [one for one in station.picture().incidents if one.closed_ms is None]


def open_incident(station: Services, incident_id: str) -> IncidentView | None:
    """Incident with this id if it is open now; otherwise None."""
    opened = open_incidents(station)
    return next((one for one in opened if one.incident_id == incident_id), None)


def open_or_404(station: Services, incident_id: str) -> IncidentView:
    found = open_incident(station, incident_id)
    if found is None:
        raise Problem(
            404,
            coded(
                "incident-not-among-open",
                "There is no open incident {incident}.",
                incident=incident_id,
            ),
        )
    return found


def site_incident_id(station: Services, incident_id: str | None) -> str:
    """Id of the incident on whose site something is set; empty, the station's own site, if none is
    open.  Problem 409 if several are open and none is named.
    """
    if incident_id is not None:
        return open_or_404(station, incident_id).incident_id
    opened = open_incidents(station)
    if len(opened) > 1:
        names = ", ".join(f"{one.name} ({one.incident_id})" for one in opened)
        raise Problem(
            409,
            coded(
                "incident-not-named",
                "Several incidents are open; name one in incident_id: {incidents}.",
                incidents=names,
            ),
        )
    return opened[0].incident_id if opened else ""
