"""Ordinary GeoJSON (RFC 7946: longitude and latitude), such as indoor maps of OpenStreetMap, and
IMDF (OGC 20-094), a ZIP file of such collections.
"""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

import msgspec

from base_station.drawings.draft import Draft, noted
from base_station.drawings.shapes import DrawnShape, Point, box_of, plan_of
from shared.coded_text import coded, text_of_error
from shared.errors import UserError
from shared.geo import Anchor

_MOST_UNPACKED_BYTES = 60_000_000
_KINDS = {"wall", "outline", "stairs", "room", "door"}
_STAIRS = {"stairs", "steps", "escalator", "ramp"}
_NUMBER = re.compile(r"-?\d+")
_NOT_DEGREES = coded(
    "geojson-not-degrees",
    "the coordinates of this GeoJSON are no degrees of longitude and latitude; "
    "save it in EPSG:4326",
)


class _Found(NamedTuple):
    kind: str
    floor: int
    degrees: list[tuple[float, float]]  # longitude, latitude
    name: str


def read_geojson(content: bytes, name: str) -> Draft:
    """Read GeoJSON. Raises UserError with the fault of the file."""
    return _draft(name, [_by_tags(one) for one in _features(content, "this file")])


def read_imdf(content: bytes, name: str) -> Draft:
    """Read IMDF: levels become floors, units rooms or stairs, openings doors, wall fixtures
    walls.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            files = {
                entry.filename.rpartition("/")[2]: entry
                for entry in archive.infolist()
                if entry.filename.endswith(".geojson")
            }
            if "level.geojson" not in files:
                raise UserError(
                    coded("zip-no-imdf", "this ZIP file is no IMDF: it has no level.geojson")
                )
            wanted = [files[one] for one in _IMDF if one in files]
            if sum(one.file_size for one in wanted) > _MOST_UNPACKED_BYTES:
                raise UserError(
                    coded(
                        "imdf-too-large", "this IMDF is larger than 60 MB; send one building of it"
                    )
                )
            parts = {
                entry.filename.rpartition("/")[2]: _features(archive.read(entry), entry.filename)
                for entry in wanted
            }
    except (zipfile.BadZipFile, NotImplementedError, RuntimeError, OSError) as error:
        raise UserError(
            coded(
                "zip-unreadable",
                "this ZIP file cannot be read: {error}",
                error=text_of_error(error),
            )
        ) from error
    levels = parts["level.geojson"]
    floors = {str(one.get("id")): _ordinal(_properties(one)) for one in levels}
    found = []
    for part, features in parts.items():
        for feature in features:
            properties = _properties(feature)
            level = feature.get("id") if part == "level.geojson" else properties.get("level_id")
            kind = _imdf_kind(part, str(properties.get("category")))
            found.append((feature, kind, floors.get(str(level), 0), _name(properties)))
    return _draft(name, found)


_IMDF = ("level.geojson", "unit.geojson", "opening.geojson", "fixture.geojson")
_Tagged = tuple[Mapping[str, Any], str, int, str]  # feature, kind, floor, name


def _imdf_kind(part: str, category: str) -> str:
    match part:
        case "level.geojson":
            return "outline"
        case "opening.geojson":
            return "door"
        case "fixture.geojson":
            return "wall" if category == "wall" else ""
        case _:
            return "stairs" if category in _STAIRS else "room"


def _by_tags(feature: Mapping[str, Any]) -> _Tagged:
    """Kind of a feature, by ``kind`` as in plans of Muster, or by tags of OpenStreetMap (Simple
    Indoor Tagging).
    """
    properties = _properties(feature)
    kind = str(properties.get("kind", ""))
    indoor = str(properties.get("indoor", ""))
    if kind not in _KINDS:
        if "building" in properties or "building:part" in properties:
            kind = "outline"
        elif properties.get("stairs") == "yes" or properties.get("highway") in _STAIRS:
            kind = "stairs"
        elif indoor in {"room", "area", "corridor"}:
            kind = "room"
        elif "door" in properties:
            kind = "door"
        else:
            kind = "wall" if "Line" in _type(feature) else "room"
    floor = properties.get("floor", properties.get("level", 0))
    number = _NUMBER.search(str(floor))
    return feature, kind, int(number[0]) if number else 0, _name(properties)


def _draft(name: str, tagged: Iterable[_Tagged]) -> Draft:
    found: list[_Found] = []
    left = 0
    for feature, kind, floor, label in tagged:
        lines = list(_lines(feature)) if kind else []
        left += not lines
        found += [_Found(kind, floor, line, label) for line in lines]
    if not found:
        raise UserError(coded("geojson-empty", "this GeoJSON has no line and no area"))
    degrees = [point for one in found for point in one.degrees]
    if any(abs(lon) > 180.0 or abs(lat) > 90.0 for lon, lat in degrees):
        raise UserError(_NOT_DEGREES)
    west, south, east, north = box_of(degrees)
    lon_deg, lat_deg = (west + east) / 2.0, (south + north) / 2.0
    origin = Anchor(lat_deg, lon_deg, 0.0)
    shapes = [
        DrawnShape(one.kind, one.floor, [_site_point(origin, at) for at in one.degrees], one.name)
        for one in found
    ]
    notes = []
    if left:
        notes.append(
            coded(
                "note-features-left-out",
                "{count} of its features are points or of no use to a plan, and left out.",
                count=left,
            )
        )
    if all(one.kind != "wall" for one in found):
        notes.append(
            coded("note-no-walls", "It has no walls: rooms are drawn, and paths may cross them.")
        )
    return noted(Draft(plan=plan_of(name, shapes), lat_deg=lat_deg, lon_deg=lon_deg), notes)


def _site_point(origin: Anchor, degrees: tuple[float, float]) -> Point:
    north_m, east_m, _ = origin.to_incident_m(degrees[1], degrees[0], 0.0)
    return east_m, north_m


def _features(content: bytes, where: str) -> list[Mapping[str, Any]]:
    try:
        document = msgspec.json.decode(content.removeprefix(b"\xef\xbb\xbf"))
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise UserError(
            coded(
                "geojson-no-json",
                "{file} is no JSON: {error}",
                file=where,
                error=text_of_error(error),
            )
        ) from error
    if not isinstance(document, dict) or not isinstance(document.get("features"), list):
        raise UserError(
            coded("geojson-no-collection", "{file} is no GeoJSON FeatureCollection", file=where)
        )
    return [one for one in document["features"] if isinstance(one, dict)]


def _properties(feature: Mapping[str, Any]) -> Mapping[str, Any]:
    properties = feature.get("properties")
    return properties if isinstance(properties, dict) else {}


def _type(feature: Mapping[str, Any]) -> str:
    geometry = feature.get("geometry")
    return str(geometry.get("type")) if isinstance(geometry, dict) else ""


def _lines(feature: Mapping[str, Any]) -> Iterator[list[tuple[float, float]]]:
    """Lines of a feature, and the outer rings of its areas, each with two points or more."""
    geometry = feature.get("geometry")
    if not isinstance(geometry, dict):
        return
    nested = geometry.get("coordinates")
    try:
        match geometry.get("type"):
            case "LineString":
                lines = [nested]
            case "MultiLineString":
                lines = list(nested or ())
            case "Polygon":
                lines = list(nested or ())[:1]
            case "MultiPolygon":
                lines = [rings[0] for rings in nested or ()]
            case _:
                return
        for line in lines:
            points = [(float(at[0]), float(at[1])) for at in line or ()]
            if len(points) >= 2:
                yield points
    except (TypeError, ValueError, IndexError, KeyError) as error:
        raise UserError(
            coded("geojson-no-numbers", "this GeoJSON has coordinates that are no numbers")
        ) from error


def _ordinal(properties: Mapping[str, Any]) -> int:
    ordinal = properties.get("ordinal")
    return int(ordinal) if isinstance(ordinal, (int, float)) and abs(ordinal) < 1000 else 0


def _name(properties: Mapping[str, Any]) -> str:
    """Name of a feature; in IMDF there is one for each language."""
    name = properties.get("name")
    if isinstance(name, dict):
        name = next(iter(name.values()), None)
    return name[:80] if isinstance(name, str) else ""
