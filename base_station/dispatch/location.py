"""Locations of emergency services: PIDF-LO (RFC 4119, civic addresses of RFC 5139)."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from xml.etree import ElementTree as ET

import msgspec
from defusedxml import DefusedXmlException
from defusedxml.ElementTree import fromstring

from base_station.dispatch.report_parts import ReportParts
from shared.coded_text import coded

_NUMBER = ("HNO", "HNS")
_STREET = ("PRD", "PRM", "STP", "RD", "STS", "POD")
_BUILDING = ("BLD", "FLR", "UNIT", "ROOM", "LOC")
_NAME, _TOWN = ("NAM", "LMK"), ("PC", "A3")
_WGS_84 = re.compile(r"(4326|4979)$")


class Location(msgspec.Struct, frozen=True):
    """Location of an incident, as far as it is known."""

    address: str = ""
    position_deg: tuple[float, float] | None = None  # latitude, longitude (WGS-84)


def read_location(xml: str, parts: ReportParts, name: str) -> Location:
    """Read a location; if it cannot be read, return an empty one and add a warning."""
    try:
        presence = fromstring(xml.strip(), forbid_dtd=True)
    except (ET.ParseError, DefusedXmlException, ValueError, LookupError) as error:
        parts.warn(
            coded(
                "location-unreadable",
                "{part} cannot be read ({error}) and is left out",
                part=name,
                error=str(error),
            )
        )
        return Location()
    return Location(_address(presence), _position_deg(presence, parts, name))


def _address(presence: ET.Element) -> str:
    civic = next(_elements(presence, "civicAddress"), None)
    if civic is None:
        return ""
    values = {local_name(one): (one.text or "").strip() for one in civic}

    def joined(tags: Sequence[str]) -> str:
        return " ".join(values[tag] for tag in tags if values.get(tag))

    groups = (joined((*_NUMBER, *_STREET)), joined(_BUILDING), joined(_NAME), joined(_TOWN))
    return ", ".join(filter(None, groups))


def _position_deg(
    presence: ET.Element, parts: ReportParts, name: str
) -> tuple[float, float] | None:
    """Latitude and longitude of the first point, circle or ellipsoid; for a polygon the middle of
    its corners.
    """
    for shape in presence.iter():
        system = shape.get("srsName")
        if system is not None and not _WGS_84.search(system):
            parts.warn(
                coded(
                    "location-other-system",
                    "{part} is in {system}, not in WGS-84, and is left out",
                    part=name,
                    system=system[:80],
                )
            )
            return None
    points = [(one.text or "").split()[:2] for one in _elements(presence, "pos")]
    for one in _elements(presence, "posList"):
        numbers = (one.text or "").split()
        points += [numbers[at : at + 2] for at in range(0, len(numbers), 2)]
    if not points:
        return None
    try:
        corners = [(float(lat), float(lon)) for lat, lon in points]
    except ValueError:
        parts.warn(
            coded(
                "location-no-number",
                "{part} has a position that is no number and is left out",
                part=name,
            )
        )
        return None
    # A polygon is closed: its last corner is its first one.
    distinct = corners[:-1] if len(corners) > 1 and corners[0] == corners[-1] else corners
    lat = sum(one[0] for one in distinct) / len(distinct)
    lon = sum(one[1] for one in distinct) / len(distinct)
    lat_deg, lon_deg = parts.position_deg(lat, lon, name)
    return None if lat_deg is None or lon_deg is None else (lat_deg, lon_deg)


def local_name(element: ET.Element) -> str:
    """Name of an element without its namespace, which differs between versions."""
    return element.tag.rpartition("}")[2]


def _elements(root: ET.Element, name: str) -> Iterator[ET.Element]:
    return (one for one in root.iter() if local_name(one) == name)
