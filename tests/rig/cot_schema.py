"""Checks of an event against the schema of Cursor-on-Target 2.0 (``Event.xsd``), which no package
carries, and against what TAK clients need beside it.
"""

from __future__ import annotations

import re
from datetime import datetime
from xml.etree import ElementTree as ET

from defusedxml.ElementTree import fromstring

_ATTRIBUTES = {"version", "uid", "type", "how", "time", "start", "stale"}
_OPTIONAL = {"access", "qos", "opex", "caveat", "releasableTo"}
_POINT = {"lat", "lon", "hae", "ce", "le"}
_TYPE = re.compile(r"\w+(-\w+)*(;[^;]*)?")  # the schema's pattern
_HOW = re.compile(r"\w(-\w+)*")
_TIME = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z")


def check_event(raw: bytes) -> ET.Element:
    """The event; an AssertionError where the schema does not allow it."""
    event = fromstring(raw, forbid_dtd=True)
    assert event.tag == "event"
    given = set(event.keys())
    assert given >= _ATTRIBUTES, _ATTRIBUTES - given
    assert given <= _ATTRIBUTES | _OPTIONAL, given
    assert event.get("version") == "2.0"
    assert event.get("uid")
    assert _TYPE.fullmatch(event.get("type", ""))
    assert _HOW.fullmatch(event.get("how", ""))
    times = [event.get(name, "") for name in ("time", "start", "stale")]
    assert all(map(_TIME.fullmatch, times)), times
    assert datetime.fromisoformat(times[1]) <= datetime.fromisoformat(times[2])
    assert [child.tag for child in event] == ["point", "detail"]
    _check_point(event[0])
    return event


def _check_point(point: ET.Element) -> None:
    assert set(point.keys()) == _POINT
    lat_deg, lon_deg = float(point.get("lat", "")), float(point.get("lon", ""))
    assert -90.0 <= lat_deg <= 90.0
    assert -180.0 <= lon_deg <= 180.0
    assert (lat_deg, lon_deg) != (0.0, 0.0), "nobody is there"
    assert float(point.get("ce", "")) >= 0.0
    assert float(point.get("le", "")) >= 0.0
    float(point.get("hae", ""))
