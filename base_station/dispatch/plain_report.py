"""Dispatch as plain JSON, for senders of one's own (docs/howto/take-dispatches.md)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from base_station.dispatch.report_parts import REMARKS_CHARACTERS, ReportParts
from shared.coded_text import coded
from shared.messages.station import NoteDispatch

_FIELDS = frozenset(
    {
        *("number", "type", "type_code", "priority", "address", "position", "units"),
        *("called", "dispatched", "updated", "remarks", "ended"),
    }
)


def read_plain(body: Mapping[str, Any], parts: ReportParts) -> NoteDispatch:
    """Read a plain report.  Raises WireError if it has no number."""
    number = parts.number(body.get("number"), '"number"')
    unknown = sorted(name for name in body if name not in _FIELDS)
    if unknown:
        parts.warn(
            coded(
                "report-unknown-fields",
                "fields that are not known are left out: {fields}",
                fields=", ".join(unknown)[:200],
            )
        )
    lat_deg, lon_deg = _position(body.get("position"), parts)
    units = body.get("units") or []
    if not isinstance(units, list):
        parts.warn(coded("report-units-no-list", '"units" is no list and is left out'))
        units = []
    has_ended = body.get("ended", False)
    if not isinstance(has_ended, bool):
        parts.warn(
            coded("report-ended-no-flag", '"ended" is neither true nor false and is left out')
        )
        has_ended = False
    return NoteDispatch(
        number,
        "json",
        type=parts.text(body.get("type"), '"type"'),
        type_code=parts.text(body.get("type_code"), '"type_code"'),
        priority=parts.text(body.get("priority"), '"priority"'),
        address=parts.text(body.get("address"), '"address"'),
        lat_deg=lat_deg,
        lon_deg=lon_deg,
        units=parts.call_signs(units, '"units"'),
        called_ns=parts.time_ns(body.get("called"), '"called"'),
        dispatched_ns=parts.time_ns(body.get("dispatched"), '"dispatched"'),
        updated_ns=parts.time_ns(body.get("updated"), '"updated"'),
        remarks=parts.text(body.get("remarks"), '"remarks"', REMARKS_CHARACTERS),
        has_ended=has_ended,
    )


def _position(value: Any, parts: ReportParts) -> tuple[float, float] | tuple[None, None]:
    if value is None:
        return None, None
    if not isinstance(value, dict):
        parts.warn(
            coded(
                "report-position-no-object",
                '"position" is no object with lat_deg and lon_deg and is left out',
            )
        )
        return None, None
    return parts.position_deg(value.get("lat_deg"), value.get("lon_deg"), '"position"')
