"""Texts about a dispatch for the console, reports and exports."""

from __future__ import annotations

from datetime import UTC, datetime

from shared.clock import NS_PER_S
from shared.messages.station import NoteDispatch

NAME_CHARACTERS = 80  # of an incident


def incident_name(report: NoteDispatch) -> str:
    """Name of an incident that is opened from this report."""
    words = ", ".join(filter(None, (report.type, report.address)))
    return (words or f"Dispatch {report.number}")[:NAME_CHARACTERS].strip()


def description(report: NoteDispatch) -> str:
    """Summary of a report in one line, for readers of tracks and reports."""
    code = f" ({report.type_code})" if report.type_code not in {"", report.type} else ""
    place = ""
    if report.lat_deg is not None and report.lon_deg is not None:
        place = f"{report.lat_deg:.6f}, {report.lon_deg:.6f}"
    parts = (
        f"{report.type}{code}" if report.type else report.type_code,
        f"priority {report.priority}" if report.priority else "",
        report.address,
        place,
        f"units {' '.join(report.units)}" if report.units else "",
        f"called {_clock(report.called_ns)}" if report.called_ns else "",
        f"dispatched {_clock(report.dispatched_ns)}" if report.dispatched_ns else "",
        report.remarks,
        "ended by the dispatch centre" if report.has_ended else "",
    )
    return f"Dispatch {report.number}: {'; '.join(filter(None, parts)) or 'nothing more is known'}"


def _clock(t_ns: int) -> str:
    return f"{datetime.fromtimestamp(t_ns // NS_PER_S, UTC):%Y-%m-%d %H:%M:%S} UTC"
