"""Alerts of the Common Alerting Protocol (CAP 1.1 and 1.2, OASIS) as markers on the plan.

An alert has a marker for each circle and polygon of its areas: at its middle, with the circle that
covers it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from datetime import UTC, datetime, timedelta
from xml.etree import ElementTree as ET

import msgspec
from defusedxml import DefusedXmlException
from defusedxml.ElementTree import fromstring

from base_station.dispatch.location import local_name
from base_station.dispatch.report_parts import ReportParts, plain
from shared.clock import NS_PER_S
from shared.coded_text import TextCode, coded
from shared.errors import WireError
from shared.messages import ExternalKind, ExternalMarker

SOURCE = "CAP"
MOST_SHAPES = 20  # of one alert
MOST_REFERENCES = 20
_ID_CHARACTERS, _NAME_CHARACTERS, _REMARKS_CHARACTERS = 128, 64, 200
_EARTH_M = 6_371_000.0  # mean radius
_LONGEST_NS = 7 * 86_400 * NS_PER_S
_UNLIMITED_NS = 86_400 * NS_PER_S  # an alert without an end
_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)


class CapAlert(msgspec.Struct, frozen=True):
    """Changes of the plan by an alert."""

    alert_id: str  # sender,identifier
    outcome: str  # shown | cancelled | expired | not actual | without a place
    markers: tuple[ExternalMarker, ...]
    replaced: tuple[str, ...]  # ids of alerts that it updates or cancels
    warnings: tuple[str, ...]
    warning_codes: tuple[TextCode, ...]  # of ``warnings``, in their order


def marker_ids(alert_id: str) -> tuple[str, ...]:
    """Ids of all markers that an alert can have."""
    return tuple(f"{SOURCE}/{alert_id}/{number}" for number in range(MOST_SHAPES))


def read_alert(body: bytes, now_ns: int) -> CapAlert:
    """Read an alert.  ``now_ns``: station time (UTC). Raises WireError if it is none."""
    try:
        alert = fromstring(body, forbid_dtd=True)
    except (ET.ParseError, DefusedXmlException, ValueError, LookupError) as error:
        raise WireError(
            coded(
                "alert-no-xml",
                "The body is no XML that is accepted: {error}.",
                error=repr(error),
            )
        ) from error
    if local_name(alert) != "alert":
        raise WireError(
            coded(
                "alert-no-cap",
                "The body is no CAP alert: its root is {root!r}.",
                root=local_name(alert)[:40],
            )
        )
    return _AlertReader(alert, now_ns).read()


class _AlertReader:
    def __init__(self, alert: ET.Element, now_ns: int) -> None:
        self._alert = alert
        self._now_ns = now_ns
        self._parts = ReportParts(now_ns)
        self._id = f"{self._identity('sender')},{self._identity('identifier')}"

    def _identity(self, name: str) -> str:
        text = _text(self._alert, name)
        if not 0 < len(text) <= _ID_CHARACTERS:
            raise WireError(
                coded("alert-no-id", "The alert has no {part}; nothing was taken.", part=name)
            )
        return text

    def read(self) -> CapAlert:
        status, kind = _text(self._alert, "status"), _text(self._alert, "msgType")
        if status != "Actual":
            return self._result("not actual", ())
        if kind == "Cancel":
            return self._result("cancelled", ())
        if kind not in {"Alert", "Update"}:
            return self._result("not actual", ())
        info = self._info()
        if info is None:
            return self._result("without a place", ())
        sent_ns = self._parts.time_ns(_text(self._alert, "sent"), "sent") or self._now_ns
        ends_ns = self._ends_ns(info, sent_ns)
        if ends_ns <= self._now_ns:
            return self._result("expired", ())
        markers = tuple(self._markers(info, sent_ns, ends_ns))
        return self._result("shown" if markers else "without a place", markers)

    def _result(self, outcome: str, markers: tuple[ExternalMarker, ...]) -> CapAlert:
        kind = _text(self._alert, "msgType")
        replaces = _text(self._alert, "status") == "Actual" and kind in {"Update", "Cancel"}
        replaced = tuple(self._references()) if replaces else ()
        warnings, codes = self._parts.warnings, self._parts.warning_codes
        return CapAlert(self._id, outcome, markers, replaced, warnings, codes)

    def _references(self) -> Iterator[str]:
        references = _text(self._alert, "references").split()
        if not references:
            self._parts.warn(
                coded("alert-no-references", "it names no alert that it updates or cancels")
            )
        if len(references) > MOST_REFERENCES:
            self._parts.warn(
                coded(
                    "alert-too-many-references",
                    "only the last {most} references are followed",
                    most=MOST_REFERENCES,
                )
            )
        for reference in references[-MOST_REFERENCES:]:
            sender, _, rest = reference.partition(",")
            yield f"{sender},{rest.partition(',')[0]}"

    def _info(self) -> ET.Element | None:
        """English part of an alert, otherwise its first one."""
        infos = list(_children(self._alert, "info"))
        english = (one for one in infos if _text(one, "language").lower().startswith("en"))
        return next(english, infos[0] if infos else None)

    def _ends_ns(self, info: ET.Element, sent_ns: int) -> int:
        """Time from which the alert is old."""
        expires = _text(info, "expires")
        if not expires:
            return sent_ns + _UNLIMITED_NS
        try:
            at = datetime.fromisoformat(expires)
            if at.tzinfo is None:
                raise ValueError(expires)
            ends_ns = (at - _EPOCH) // timedelta(seconds=1) * NS_PER_S
        except ValueError:
            self._parts.warn(
                coded(
                    "alert-expiry-unreadable",
                    "expires is no time with its zone; it counts for a day",
                )
            )
            return sent_ns + _UNLIMITED_NS
        if ends_ns > self._now_ns + _LONGEST_NS:
            self._parts.warn(
                coded(
                    "alert-expiry-far",
                    "it expires in more than a week; it is shown for a week",
                )
            )
        return min(ends_ns, self._now_ns + _LONGEST_NS)

    def _markers(self, info: ET.Element, sent_ns: int, ends_ns: int) -> Iterator[ExternalMarker]:
        name = _text(info, "headline") or _text(info, "event") or "Alert"
        circles = [
            (area, circle) for area in _children(info, "area") for circle in self._circles(area)
        ]
        if len(circles) > MOST_SHAPES:
            self._parts.warn(
                coded(
                    "alert-too-many-areas",
                    "{count} areas beyond the first {most} are left out",
                    count=len(circles) - MOST_SHAPES,
                    most=MOST_SHAPES,
                )
            )
        ids = marker_ids(self._id)
        for (area, (lat_deg, lon_deg, radius_m)), marker_id in zip(circles, ids, strict=False):
            words = (_text(info, tag) for tag in ("severity", "description", "instruction"))
            remarks = "; ".join(filter(None, (_text(area, "areaDesc"), *words)))
            yield ExternalMarker(
                marker_id=marker_id,
                source=SOURCE,
                name=name[:_NAME_CHARACTERS],
                kind=ExternalKind.MARKER,
                type=_text(info, "event")[:_NAME_CHARACTERS],
                remarks=remarks[:_REMARKS_CHARACTERS],
                lat_deg=lat_deg,
                lon_deg=lon_deg,
                radius_m=radius_m,
                t_ns=min(sent_ns, self._now_ns),
                stale_ns=ends_ns,
            )

    def _circles(self, area: ET.Element) -> Iterator[tuple[float, float, float]]:
        """Latitude, longitude and radius in metres of the shapes of an area."""
        for shape in _children(area, "circle"):
            centre, _, radius = plain(shape.text or "").partition(" ")
            corners = _numbers(centre)
            radius_km = _numbers(f"{radius},0")
            if len(corners) == 1 and radius_km and 0.0 <= radius_km[0][0] < 20_000.0:
                yield from self._circle(corners, 1000.0 * radius_km[0][0])
            else:
                self._parts.warn(
                    coded("alert-circle-unreadable", "a circle cannot be read and is left out")
                )
        for shape in _children(area, "polygon"):
            corners = _numbers(shape.text or "")
            if len(corners) >= 4 and corners[0] == corners[-1]:
                yield from self._circle(corners[:-1], 0.0)
            else:
                self._parts.warn(
                    coded(
                        "alert-polygon-unreadable",
                        "a polygon cannot be read or is not closed, and is left out",
                    )
                )

    def _circle(
        self, corners: Sequence[tuple[float, float]], radius_m: float
    ) -> Iterator[tuple[float, float, float]]:
        lat = sum(one[0] for one in corners) / len(corners)
        lon = sum(one[1] for one in corners) / len(corners)
        lat_deg, lon_deg = self._parts.position_deg(lat, lon, "area")
        if lat_deg is not None and lon_deg is not None:
            far_m = max(_distance_m((lat_deg, lon_deg), one) for one in corners)
            yield lat_deg, lon_deg, radius_m + far_m


def _numbers(text: str) -> list[tuple[float, float]]:
    """Pairs ``lat,lon``; empty if any of them is invalid."""
    pairs = []
    for pair in text.split():
        lat, comma, lon = pair.partition(",")
        try:
            values = float(lat), float(lon)
        except ValueError:
            return []
        if not comma or not all(map(math.isfinite, values)):
            return []
        pairs.append(values)
    return pairs


def _distance_m(one_deg: tuple[float, float], other_deg: tuple[float, float]) -> float:
    """Between two places (latitude, longitude) on a sphere, after the haversine formula."""
    lat, lon = map(math.radians, one_deg)
    other_lat, other_lon = map(math.radians, other_deg)
    part = (
        math.sin((other_lat - lat) / 2) ** 2
        + math.cos(lat) * math.cos(other_lat) * math.sin((other_lon - lon) / 2) ** 2
    )
    return 2 * _EARTH_M * math.asin(min(1.0, math.sqrt(part)))


def _children(parent: ET.Element, name: str) -> Iterator[ET.Element]:
    return (one for one in parent if local_name(one) == name)


def _text(parent: ET.Element, name: str) -> str:
    """Text of the first child of that name, in one line; empty if there is none."""
    child = next(_children(parent, name), None)
    return "" if child is None else plain(child.text or "")
