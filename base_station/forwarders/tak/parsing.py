"""Reads events of other teams, which may be wrong, hostile or of kinds that are not shown."""

from __future__ import annotations

import math
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from xml.etree import ElementTree as ET

from defusedxml import DefusedXmlException
from defusedxml.ElementTree import fromstring

from base_station.forwarders.tak.cot import EMERGENCY, EMERGENCY_CANCELLED, UNKNOWN
from shared.clock import NS_PER_MS
from shared.messages import ExternalKind, ExternalMarker

_NAME_CHARACTERS, _REMARKS_CHARACTERS, _ID_CHARACTERS = 64, 200, 128
_DELETED = "t-x-d-d"
_NOWHERE_DEG = 1e-6
_LONGEST = timedelta(days=1)  # a marker of a year is shown as fresh for a day
_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)


@dataclass(frozen=True, slots=True)
class MarkerDeletion:
    """Another team has deleted a marker, or cancelled an emergency."""

    uid: str


class NoMarkerError(Exception):
    """Event that cannot be read, with the reason."""


def read_event(source: str, raw: bytes) -> ExternalMarker | MarkerDeletion | None:
    """None for an event that is shown nowhere, such as a ping; raises NoMarkerError."""
    try:
        event = fromstring(raw, forbid_dtd=True)
    except (ET.ParseError, DefusedXmlException, ValueError, LookupError) as error:
        raise NoMarkerError(f"it is no XML that is accepted: {error!r}") from error
    kind = event.get("type", "")
    uid = event.get("uid", "")
    if not 0 < len(uid) <= _ID_CHARACTERS or not uid.isprintable():
        raise NoMarkerError("it has no uid")
    if kind == EMERGENCY_CANCELLED:
        return MarkerDeletion(uid)
    if kind == _DELETED:
        link = event.find("detail/link")
        return None if link is None else MarkerDeletion(link.get("uid", ""))
    shown = _kind_of(kind)
    return None if shown is None else _marker(source, uid, kind, shown, event)


def _kind_of(kind: str) -> ExternalKind | None:
    if kind.startswith("a-"):
        return ExternalKind.PERSON
    if kind.startswith(("b-a-o-", EMERGENCY)):
        return ExternalKind.EMERGENCY
    return ExternalKind.MARKER if kind.startswith("b-m-p-") else None


def _marker(
    source: str, uid: str, kind: str, shown: ExternalKind, event: ET.Element
) -> ExternalMarker:
    point = event.find("point")
    if point is None:
        raise NoMarkerError("it has no point")
    lat_deg, lon_deg = _number(point, "lat"), _number(point, "lon")
    if abs(lat_deg) > 90.0 or abs(lon_deg) > 180.0:
        raise NoMarkerError(f"{lat_deg}, {lon_deg} is no latitude and longitude")
    if abs(lat_deg) < _NOWHERE_DEG and abs(lon_deg) < _NOWHERE_DEG:
        raise NoMarkerError("it is at 0, 0, which is no valid place")
    ce_m = _number(point, "ce")
    at, stale = _time(event, "time"), _time(event, "stale")
    contact = event.find("detail/contact")
    callsign = "" if contact is None else contact.get("callsign", "")
    return ExternalMarker(
        marker_id=f"{source}/{uid}",
        source=source,
        name=_plain(callsign or uid, _NAME_CHARACTERS),
        kind=shown,
        type=kind[:_NAME_CHARACTERS],
        remarks=_plain(event.findtext("detail/remarks") or "", _REMARKS_CHARACTERS),
        lat_deg=lat_deg,
        lon_deg=lon_deg,
        radius_m=ce_m if 0.0 < ce_m < float(UNKNOWN) else 0.0,
        t_ns=_ns(at),
        stale_ns=_ns(min(stale, at + _LONGEST)),
    )


def _number(point: ET.Element, name: str) -> float:
    try:
        value = float(point.get(name, ""))
    except ValueError:
        raise NoMarkerError(f"its {name} is no number") from None
    if not math.isfinite(value):
        raise NoMarkerError(f"its {name} is no number")
    return value


def _time(event: ET.Element, name: str) -> datetime:
    try:
        at = datetime.fromisoformat(event.get(name, ""))
    except ValueError:
        raise NoMarkerError(f"its {name} is no time") from None
    at = at if at.tzinfo is not None else at.replace(tzinfo=UTC)
    if not _EPOCH < at < datetime(2100, 1, 1, tzinfo=UTC):
        raise NoMarkerError(f"its {name} makes no sense")
    return at


def _ns(at: datetime) -> int:
    return (at - _EPOCH) // timedelta(milliseconds=1) * NS_PER_MS


def _plain(text: str, characters: int) -> str:
    """In one line, without invisible characters."""
    words = "".join(one if one.isprintable() else " " for one in text).split()
    return " ".join(words)[:characters]
