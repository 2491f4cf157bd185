"""Summary of the picture that a station's consoles show."""

from __future__ import annotations

from base_station.department_wire import IncidentSummary, PersonSummary, PlaceSummary
from base_station.views.wire import IncidentView, PositionView, UnitView


def incident_summary(incident: IncidentView) -> IncidentSummary:
    return IncidentSummary(incident.incident_id, incident.name, incident.opened_ms)


def person_summary(unit: UnitView, incident_id: str) -> PersonSummary:
    """Summary of one person.  ``incident_id``: the wearer's incident; empty if in none."""
    status, duty = unit.status, unit.duty
    return PersonSummary(
        unit_id=unit.unit_id,
        label=unit.label,
        person_id="" if unit.person is None else unit.person.person_id,
        link=unit.link,
        incident_id=incident_id,
        place=None if unit.position is None else _place_summary(unit.position),
        activity="" if status is None else status.activity,
        mayday=status is not None and status.mayday,
        alarms=unit.alarms,
        par="" if duty is None else duty.confirmed,
        par_due_ms=None if duty is None else duty.due_ms,
    )


def _place_summary(position: PositionView) -> PlaceSummary:
    return PlaceSummary(
        t_ms=position.t_ms,
        north_m=round(position.north_m, 2),
        east_m=round(position.east_m, 2),
        floor=position.floor,
        lat_deg=position.lat_deg,
        lon_deg=position.lon_deg,
        radius_m=round(position.ellipse_major_m, 1),
        quality=position.quality,
    )
