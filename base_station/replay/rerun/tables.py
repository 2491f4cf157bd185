"""A re-run as tables for a terminal."""

from __future__ import annotations

from datetime import UTC, datetime

from rich.console import Console
from rich.table import Table

from base_station.replay.rerun.comparison import AlarmOutcome, RerunReport, TrailDifference

_FIGURES = ("median", "95 %", "most", "at the end", "height 95 %")


def print_rerun(report: RerunReport) -> None:
    console = Console(markup=False, emoji=False, highlight=False)
    console.print(_trails_table(report))
    same = sum(one.outcome is AlarmOutcome.SAME for one in report.alarms)
    console.print(f"{same} alarms as then")
    for alarm in report.alarms:
        if alarm.outcome is not AlarmOutcome.SAME:
            then, now = time_text(alarm.shown_ms), time_text(alarm.rerun_ms)
            of = f"{alarm.unit_id}  {alarm.rule}"
            console.print(f"{of}: {alarm.outcome.value}, then {then}, now {now}")
    for note in report.notes:
        console.print(note)


def metres(value_m: float | None) -> str:
    return "" if value_m is None else f"{value_m:.2f}"


def time_text(t_ms: int | None) -> str:
    """Time of day, UTC."""
    return "not raised" if t_ms is None else f"{datetime.fromtimestamp(t_ms / 1000, UTC):%H:%M:%S}"


def covered(trail: TrailDifference) -> str:
    """Share of the positions that came out of a recording."""
    return f"{trail.retracked / trail.positions:.0%}" if trail.positions else ""


def figures(trail: TrailDifference) -> tuple[str, ...]:
    values = (trail.median_m, trail.p95_m, trail.max_m, trail.end_m, trail.vertical_p95_m)
    return tuple(map(metres, values))


def _trails_table(report: RerunReport) -> Table:
    table = Table(title=f"{report.incident_id}: metres between the trail as shown and the re-run")
    for heading in ("unit", "tracker"):
        table.add_column(heading)
    for heading in ("again", *_FIGURES, "other floor"):
        table.add_column(heading, justify="right")
    for trail in report.trails:
        floor = f"{trail.other_floor_s} s"
        table.add_row(trail.unit_id, trail.tracker, covered(trail), *figures(trail), floor)
    return table
