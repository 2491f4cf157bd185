"""Cursor-on-Target (CoT) 2.0 events of the station's picture; ``CotEvents`` is pure.

Nothing is made without a position on the Earth.  A position becomes stale by the time at which it
was measured, however late its event is sent.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from importlib.metadata import version
from xml.etree import ElementTree as ET

from base_station.core.state.message_stream import STALE_AFTER_S
from base_station.views.wire import AnchorView, PositionView, UnitView
from shared.geo import Anchor
from shared.xml_text import in_xml

PERSON = "a-f-G-U-C"  # friendly, on the ground, a unit of combatants: shown as a member by TAK
EMERGENCY, EMERGENCY_CANCELLED = "b-a-o-tbl", "b-a-o-can"
WAY = "u-d-f"  # a drawn line
PING = "t-x-c-t"
UNKNOWN = "9999999.0"
FUSED, DEAD_RECKONED = "m-f", "m-p"
EMERGENCY_STALE_MS = 60_000
_STALE_AFTER_MS = round(STALE_AFTER_S * 1000)
_GNSS_HOLDS_S = 10.0  # a fix so old still holds the path; after that it is dead reckoning
_Z_95 = 1.96  # 95 % of a normal distribution lie within so many standard deviations
_KNOWN_HEADING_RAD = math.radians(60.0)  # of its standard deviation
_NOWHERE_DEG = 1e-6
_VERSION = version("muster")


@dataclass(frozen=True, slots=True)
class GeodeticPlace:
    """Position on the Earth (WGS-84) with its 95 % errors; None if the height is unknown."""

    lat_deg: float
    lon_deg: float
    hae_m: float | None  # above the ellipsoid
    ce_m: float
    le_m: float | None


def place_of(position: PositionView | None, anchor: AnchorView | None) -> GeodeticPlace | None:
    """Position on the Earth; None if it is unknown, which latitude and longitude 0 also mean."""
    if position is None or anchor is None or _is_nowhere(anchor.lat_deg, anchor.lon_deg):
        return None
    frame = Anchor(anchor.lat_deg, anchor.lon_deg, anchor.height_m, anchor.plan_rotation_rad)
    metres = position.north_m, position.east_m, position.down_m
    lat_deg, lon_deg, hae_m = frame.to_geodetic(*metres)
    le_m = _Z_95 * position.std_down_m
    ce_m = position.ellipse_major_m  # the circle around the 95 % region
    if not all(map(math.isfinite, (lat_deg, lon_deg, hae_m, ce_m))):
        return None
    return GeodeticPlace(lat_deg, lon_deg, hae_m, ce_m, le_m if math.isfinite(le_m) else None)


def _is_nowhere(lat_deg: float, lon_deg: float) -> bool:
    return abs(lat_deg) < _NOWHERE_DEG and abs(lon_deg) < _NOWHERE_DEG


@dataclass(frozen=True, slots=True)
class GroundMotion:
    """Ground speed and true course."""

    speed_mps: float
    course_deg: float


class CotEvents:
    """Maker of the events of one connection."""

    def __init__(self, uid_prefix: str, team: str, *, names: bool) -> None:
        self._prefix = uid_prefix
        self._team = team
        self._names = names

    def uid(self, unit_id: str) -> str:
        return f"{self._prefix}.{unit_id}"

    def callsign(self, unit: UnitView) -> str:
        name = unit.person.name if self._names and unit.person is not None else ""
        return in_xml(name or unit.label or unit.unit_id)

    def person(
        self, unit: UnitView, position: PositionView, place: GeodeticPlace, motion: GroundMotion
    ) -> bytes:
        """Event of a person at a position.  It becomes stale when the position does, whenever it is
        sent.
        """
        at_ms = position.t_ms
        event = _event(self.uid(unit.unit_id), PERSON, how_of(position), at_ms, stale_ms(position))
        _add_point(event, place)
        detail = ET.SubElement(event, "detail")
        ET.SubElement(
            detail, "takv", device="Muster", platform="Muster", os="Linux", version=_VERSION
        )
        ET.SubElement(detail, "contact", callsign=self.callsign(unit))
        ET.SubElement(detail, "__group", name=self._team, role="Team Member")
        source = "GPS" if how_of(position) == FUSED else "Calc"
        ET.SubElement(detail, "precisionlocation", geopointsrc=source, altsrc="Calc")
        battery = unit.status.battery if unit.status else None
        if battery is not None:
            ET.SubElement(detail, "status", battery=f"{100.0 * battery:.0f}")
        ET.SubElement(
            detail,
            "track",
            speed=f"{motion.speed_mps:.1f}",
            course=f"{motion.course_deg % 360.0:.1f}",
        )
        ET.SubElement(detail, "remarks").text = in_xml(self._remarks(unit, position, place))
        return _bytes(event)

    def _remarks(self, unit: UnitView, position: PositionView, place: GeodeticPlace) -> str:
        crew = unit.person.crew if self._names and unit.person is not None else ""
        words = [
            f"crew {crew}" if crew else "",
            floor_text(position),
            "inside" if unit.inside_since_ms is not None else "",
            unit.status.activity.replace("_", " ") if unit.status else "",
            f"position of {_clock(position.t_ms)} UTC within {place.ce_m:.0f} m (95 %)",
            f"quality {position.quality}",
            f"link {unit.link}",
            f"unit {unit.unit_id}",
        ]
        return "; ".join(word for word in words if word)

    def emergency(
        self,
        unit: UnitView,
        position: PositionView,
        place: GeodeticPlace,
        rules: Sequence[str],
        now_ms: int,
    ) -> bytes:
        """Alert of a person, which stands until it is cancelled."""
        detail, event = self._alert(unit, EMERGENCY, position, place, now_ms)
        ET.SubElement(detail, "emergency", type="911 Alert").text = self.callsign(unit)
        text = ", ".join(rules)
        seen = f"last position of {_clock(position.t_ms)} UTC within {place.ce_m:.0f} m (95 %)"
        ET.SubElement(detail, "remarks").text = in_xml(f"{text}; {floor_text(position)}; {seen}")
        return _bytes(event)

    def emergency_cancelled(
        self, unit: UnitView, position: PositionView, place: GeodeticPlace, now_ms: int
    ) -> bytes:
        detail, event = self._alert(unit, EMERGENCY_CANCELLED, position, place, now_ms)
        ET.SubElement(detail, "emergency", cancel="true").text = self.callsign(unit)
        return _bytes(event)

    def _alert(
        self, unit: UnitView, kind: str, position: PositionView, place: GeodeticPlace, now_ms: int
    ) -> tuple[ET.Element, ET.Element]:
        uid = self.uid(unit.unit_id)
        stale = now_ms + EMERGENCY_STALE_MS
        event = _event(f"{uid}-9-1-1", kind, how_of(position), now_ms, stale)
        _add_point(event, place)
        detail = ET.SubElement(event, "detail")
        ET.SubElement(detail, "contact", callsign=f"{self.callsign(unit)}-Alert")
        ET.SubElement(detail, "link", uid=uid, relation="p-p", type=PERSON)
        return detail, event

    def way(self, unit: UnitView, position: PositionView, places: Sequence[GeodeticPlace]) -> bytes:
        """Breadcrumbs: the way to a position as a line, oldest point first."""
        uid = f"{self.uid(unit.unit_id)}-way"
        event = _event(uid, WAY, how_of(position), position.t_ms, stale_ms(position))
        _add_point(event, places[-1])
        detail = ET.SubElement(event, "detail")
        for place in places:
            ET.SubElement(detail, "link", point=_point_text(place))
        ET.SubElement(detail, "strokeColor", value="-65536")  # ARGB: red
        ET.SubElement(detail, "strokeWeight", value="2.0")
        ET.SubElement(detail, "contact", callsign=f"{self.callsign(unit)} way")
        ET.SubElement(detail, "labels_on", value="false")
        ET.SubElement(detail, "remarks")
        return _bytes(event)

    def ping(self, anchor: AnchorView, now_ms: int) -> bytes:
        """Ping, which the server answers with ``t-x-c-t-r``."""
        uid = f"{self._prefix}-ping"
        event = _event(uid, PING, "m-g", now_ms, now_ms + _STALE_AFTER_MS)
        place = GeodeticPlace(anchor.lat_deg, anchor.lon_deg, anchor.height_m, float(UNKNOWN), None)
        _add_point(event, place)
        ET.SubElement(event, "detail")
        return _bytes(event)


def how_of(position: PositionView) -> str:
    """Source of the position, in CoT's term."""
    since_s = position.since_gps_s
    return FUSED if since_s is not None and since_s <= _GNSS_HOLDS_S else DEAD_RECKONED


def stale_ms(position: PositionView) -> int:
    """Time from which the position is shown as old, the same as on the station's console."""
    return position.t_ms + _STALE_AFTER_MS


def floor_text(position: PositionView) -> str:
    if position.floor is None:
        return "floor unknown"
    sure = position.floor_probability
    return f"floor {position.floor}" + ("" if sure is None else f" ({100.0 * sure:.0f} %)")


def motion_between(
    before: tuple[int, GeodeticPlace] | None,
    position: PositionView,
    place: GeodeticPlace,
    rotation_rad: float,
) -> GroundMotion:
    """Speed since an earlier position, and the course: of the way, or the wearer's heading at
    rest.
    """
    course_deg = 0.0
    if position.heading_std_rad < _KNOWN_HEADING_RAD:
        course_deg = math.degrees(position.heading_rad + rotation_rad)
    if before is None or position.t_ms <= before[0]:
        return GroundMotion(0.0, course_deg)
    then_ms, there = before
    north_m = math.radians(place.lat_deg - there.lat_deg) * _EARTH_M
    east_m = math.radians(place.lon_deg - there.lon_deg) * _EARTH_M
    east_m *= math.cos(math.radians(place.lat_deg))
    speed_mps = math.hypot(north_m, east_m) / ((position.t_ms - then_ms) * 1e-3)
    if speed_mps >= _WALKING_MPS:
        course_deg = math.degrees(math.atan2(east_m, north_m))
    return GroundMotion(min(speed_mps, _FASTEST_MPS), course_deg)


_EARTH_M = 6_371_000.0  # mean radius
_WALKING_MPS = 0.5
_FASTEST_MPS = 12.0  # a person; beyond it a correction has moved the place


def _event(uid: str, kind: str, how: str, at_ms: int, stale: int) -> ET.Element:
    at = cot_time(at_ms)
    return ET.Element(
        "event",
        {
            "version": "2.0",
            "uid": in_xml(uid),
            "type": kind,
            "how": how,
            "time": at,
            "start": at,
            "stale": cot_time(stale),
        },
    )


def _add_point(event: ET.Element, place: GeodeticPlace) -> None:
    ET.SubElement(
        event,
        "point",
        lat=f"{place.lat_deg:.7f}",
        lon=f"{place.lon_deg:.7f}",
        hae=_metres(place.hae_m),
        ce=_metres(place.ce_m),
        le=_metres(place.le_m),
    )


def _metres(value_m: float | None) -> str:
    return UNKNOWN if value_m is None or abs(value_m) >= float(UNKNOWN) else f"{value_m:.1f}"


def _point_text(place: GeodeticPlace) -> str:
    return f"{place.lat_deg:.7f},{place.lon_deg:.7f},{_metres(place.hae_m)}"


def cot_time(t_ms: int) -> str:
    at = datetime.fromtimestamp(t_ms / 1000, UTC)
    return f"{at:%Y-%m-%dT%H:%M:%S}.{t_ms % 1000:03}Z"


def _clock(t_ms: int) -> str:
    return f"{datetime.fromtimestamp(t_ms / 1000, UTC):%H:%M:%S}"


def _bytes(event: ET.Element) -> bytes:
    written: bytes = ET.tostring(event, encoding="utf-8")
    return written
