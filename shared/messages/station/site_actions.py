"""Actions on the site and on positions: anchor, plan, start positions, barometer, fuser."""

from __future__ import annotations

import msgspec


class SetAnchor(msgspec.Struct, frozen=True):
    """Position of the incident frame's origin on the Earth, and the direction of the plan."""

    lat_deg: float
    lon_deg: float
    height_m: float
    plan_rotation_rad: float
    incident_id: str = ""  # of whose site; empty: of the station's own


class SetPlan(msgspec.Struct, frozen=True):
    """The building's plan, metre-based site GeoJSON."""

    geojson: bytes
    incident_id: str = ""  # as above


class SetStart(msgspec.Struct, frozen=True):
    """Start of a unit's own frame: position and heading, as entered by a commander."""

    unit_id: str
    north_m: float
    east_m: float
    down_m: float
    heading_rad: float
    std_m: float
    heading_std_rad: float


class SetReference(msgspec.Struct, frozen=True):
    """Reference barometer: a unit at rest that measures the weather's pressure; no unit: none."""

    unit_id: str
    down_m: float
    incident_id: str = ""  # as above


class SetFuser(msgspec.Struct, frozen=True):
    """Fuser of all units from here on, by its name."""

    name: str
