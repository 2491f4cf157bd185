"""An assessment as tables for a terminal."""

from __future__ import annotations

from pathlib import Path

import msgspec
from rich.console import Console
from rich.table import Table

from base_station.core.durations import format_duration
from base_station.replay.assessment.figures import Figures
from base_station.replay.assessment.report import IncidentReport, UnitReport
from shared.out_file import whole


def print_report(report: IncidentReport) -> None:
    console = Console(markup=False, emoji=False, highlight=False)  # names are what people typed
    console.print(_errors_table(report))
    console.print(_trust_table(report))
    console.print(_checks_table(report))


def write_report(report: IncidentReport, path: Path) -> None:
    """Raises UserError where the disk does not take it."""
    with whole(path) as making:
        making.write_bytes(msgspec.json.format(msgspec.json.encode(report)) + b"\n")


def _errors_table(report: IncidentReport) -> Table:
    table = Table(title=f"{report.incident_id}: 50 % / 95 % errors in metres (ISO/IEC 18305)")
    for heading in ("unit", "", "circular", "vertical", "spherical", "floor right"):
        table.add_column(heading, justify="left" if heading in {"unit", ""} else "right")
    for unit in report.units:
        promised, right = _share(unit.floor_probability), _share(unit.floor_right)
        table.add_row(_name(unit), "as stated", *_cells(unit.stated), promised)
        table.add_row("", "against the smoothed trail", *_cells(unit.against_smoothed), right)
    table.add_row("all", "as stated", *_cells(report.stated), "")
    table.add_row("", "against the smoothed trail", *_cells(report.against_smoothed), "")
    return table


def _trust_table(report: IncidentReport) -> Table:
    table = Table(title="The light beside the name: for how long, and why not green")
    for heading in ("unit", "green", "amber", "red", "why"):
        table.add_column(heading, justify="left" if heading in {"unit", "why"} else "right")
    for unit in report.units:
        trust = unit.trust
        lights = map(format_duration, (trust.green_s, trust.amber_s, trust.red_s))
        why = ", ".join(f"{cause} {format_duration(seconds)}" for cause, seconds in trust.causes)
        table.add_row(_name(unit), *lights, why)
    return table


def _checks_table(report: IncidentReport) -> Table:
    table = Table(title="Checks")
    for heading in (
        "unit",
        "walked",
        "loop closure",
        "jumps as fixes came back",
        "pins: shown off",
        "fixes and sightings that were not used",
    ):
        table.add_column(heading)
    for unit in report.units:
        table.add_row(
            _name(unit),
            f"{unit.walked_m:.0f} m",
            _closure(unit),
            ", ".join(f"{one:.1f} m" for one in unit.reentry_jumps_m),
            ", ".join(
                f"{one.note or 'pin'}: {one.shown_m:.1f} m"
                for one in unit.pin_residuals
                if one.shown_m is not None
            ),
            ", ".join(f"{count} {reason}" for reason, count in unit.not_used),
        )
    return table


def _name(unit: UnitReport) -> str:
    return f"{', '.join(unit.people)} ({unit.unit_id})" if unit.people else unit.unit_id


def _share(part: float | None) -> str:
    return "" if part is None else f"{part:.1%}"


def _closure(unit: UnitReport) -> str:
    if unit.loop_closure_m is None:
        return ""
    return f"{unit.loop_closure_m:.1f} m, {unit.loop_closure_percent:.1f} %"


def _cells(figures: Figures | None) -> tuple[str, str, str]:
    if figures is None:
        return "", "", ""
    return (
        f"{figures.ce50_m:.1f} / {figures.ce95_m:.1f}",
        f"{figures.ve50_m:.1f} / {figures.ve95_m:.1f}",
        f"{figures.se50_m:.1f} / {figures.se95_m:.1f}",
    )
