"""Place on the Earth that an IFC file states: by its map conversion, or by its site.

A map conversion is surveyed.  Latitude and longitude of the site are often those of a city that the
drawing program has set by itself, and are no more than a suggestion.
"""

from __future__ import annotations

import math
from importlib import import_module
from typing import Any, NamedTuple

from base_station.drawings.ifc_building import placed_at
from base_station.drawings.shapes import Point
from base_station.site.utm import Zone, lat_lon_of, zone_of
from shared.coded_text import coded
from shared.geo import Anchor

_NORTHWARDS_M = 100.0  # over which the grid's north is compared with true north


class ModelPlace(NamedTuple):
    """Place of the plan's origin; the rotation is the true heading of the plan's north axis."""

    lat_deg: float
    lon_deg: float
    rotation_rad: float
    is_surveyed: bool


def place_of(file: Any, unit_m: float, origin: Point) -> tuple[ModelPlace | None, tuple[str, ...]]:
    """Place of a point (x, y) of the file in metres, with notes for a person."""
    mapped, notes = _mapped(file, unit_m, origin)
    if mapped is not None:
        return mapped, notes
    return _by_site(file, unit_m, origin), notes


def _mapped(file: Any, unit_m: float, origin: Point) -> tuple[ModelPlace | None, tuple[str, ...]]:
    """Place by IfcMapConversion: east = E + a x - o y, north = N + o x + a y, of (a, o) a unit
    vector.
    """
    geolocation: Any = import_module("ifcopenshell.util.geolocation")
    found = geolocation.get_helmert_transformation_parameters(file)
    if found is None:
        return None, ()
    crs = geolocation.get_crs(file) or {}
    name = str(crs.get("Name") or "").upper().replace(" ", "")
    zone = zone_of(name)
    if zone is None:
        return None, (
            coded(
                "note-other-grid",
                "Its place is given in the grid {grid}, not UTM.",
                grid=name or "?",
            ),
        )
    turned_rad = math.atan2(found.xao, found.xaa)
    cosine, sine = math.cos(turned_rad), math.sin(turned_rad)
    x, y = origin
    for map_unit_m in (_map_unit_m(crs, unit_m), 1.0):
        east_m = found.e * map_unit_m + cosine * x - sine * y
        north_m = found.n * map_unit_m + sine * x + cosine * y
        lat_deg, lon_deg = lat_lon_of(zone, east_m, north_m)
        if 100_000.0 <= east_m <= 900_000.0 and math.isfinite(lat_deg):
            grid_rad = _grid_north_rad(zone, east_m, north_m)
            return ModelPlace(lat_deg, lon_deg, grid_rad - turned_rad, is_surveyed=True), ()
    return None, (
        coded("note-outside-zone", "Its place in {grid} lies outside of that zone.", grid=name),
    )


def _map_unit_m(crs: dict[str, Any], unit_m: float) -> float:
    """Unit of the map in metres.  A map without a unit of its own has that of the file, though some
    programs write metres then.
    """
    unit: Any = import_module("ifcopenshell.util.unit")
    stated = crs.get("MapUnit")
    if stated is None or isinstance(stated, str):
        return unit_m
    prefix = getattr(stated, "Prefix", None)
    return float(unit.convert(1.0, prefix, stated.Name, None, "METRE"))


def _grid_north_rad(zone: Zone, east_m: float, north_m: float) -> float:
    """True heading of the grid's north."""
    here = Anchor(*lat_lon_of(zone, east_m, north_m), 0.0)
    north_of_it = lat_lon_of(zone, east_m, north_m + _NORTHWARDS_M)
    to_north_m, to_east_m, _ = here.to_incident_m(*north_of_it, 0.0)
    return math.atan2(to_east_m, to_north_m)


def _by_site(file: Any, unit_m: float, origin: Point) -> ModelPlace | None:
    """Place by the latitude and longitude of IfcSite, which are those of its own placement."""
    for site in file.by_type("IfcSite"):
        if not site.RefLatitude or not site.RefLongitude:
            continue
        lat_deg, lon_deg = _degrees(site.RefLatitude), _degrees(site.RefLongitude)
        if not (0.0 < abs(lat_deg) <= 85.0 and abs(lon_deg) <= 180.0):
            continue
        x_m, y_m = 0.0, 0.0
        if site.ObjectPlacement:
            matrix = placed_at(site)
            x_m, y_m = float(matrix[0][3]) * unit_m, float(matrix[1][3]) * unit_m
        turned_rad = _true_heading_of_y_rad(file)
        anchor = Anchor(lat_deg, lon_deg, 0.0, turned_rad)
        east_m, north_m = origin[0] - x_m, origin[1] - y_m
        lat_deg, lon_deg, _ = anchor.to_geodetic(north_m, east_m, 0.0)
        return ModelPlace(lat_deg, lon_deg, turned_rad, is_surveyed=False)
    return None


def _degrees(parts: tuple[int, ...]) -> float:
    """Degrees from degrees, minutes, seconds and millionths of a second, all of one sign."""
    scales = (1.0, 60.0, 3600.0, 3600.0e6)
    return sum(part / scale for part, scale in zip(parts, scales, strict=False))


def _true_heading_of_y_rad(file: Any) -> float:
    """True heading of the file's y axis, by TrueNorth, the direction of true north in its frame."""
    for context in file.by_type("IfcGeometricRepresentationContext", include_subtypes=False):
        if context.TrueNorth:
            x, y = context.TrueNorth.DirectionRatios[:2]
            return math.atan2(-x, y)
    return 0.0
