"""A rehearsal as tables for a terminal, and as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

import msgspec
from rich.console import Console
from rich.table import Table

from base_station.replay.rehearsal.report import EpisodeChange, RehearsalReport, RehearsedPoint
from shared.out_file import whole

_CHANGES_SHOWN = 40  # the JSON has all of them
_HEADINGS = ("raised", "per h", "same", "earlier", "later", "missed", "added", "median shift")


def print_rehearsal(report: RehearsalReport) -> None:
    console = Console(markup=False, emoji=False, highlight=False)
    incidents = ", ".join(one.incident_id for one in report.incidents)
    console.print(f"{incidents}: {report.worn_h:.2f} hours of wear")
    possible = [point for point in report.points if not point.problem]
    for row in range(len(possible[0].levels) if possible else 0):
        console.print(_level_table(report, possible, row))
    for point in report.points:
        if point.problem:
            console.print(f"{thresholds_text(point)} is left out: {point.problem}")
    if not report.swept:
        for point in possible:
            _print_changes(console, point)


def write_rehearsal(report: RehearsalReport, path: Path) -> None:
    """Raises UserError where the disk does not take it."""
    with whole(path) as making:
        making.write_bytes(msgspec.json.format(msgspec.json.encode(report)) + b"\n")


def thresholds_text(point: RehearsedPoint) -> str:
    return ", ".join(f"{name}={value:g}" for name, value in sorted(point.thresholds.items()))


def _level_table(report: RehearsalReport, points: Sequence[RehearsedPoint], row: int) -> Table:
    first = points[0].levels[row]
    live = sum(one.live_alarms[first.rule] for one in report.incidents)
    table = Table(
        title=f"{first.rule}: {first.level}",
        caption=f"alarms of this rule that the station kept then: {live}",
    )
    table.add_column(report.swept.rpartition(".")[2], no_wrap=True)
    for heading in _HEADINGS:
        table.add_column(heading, justify="right")
    table.add_row("then", str(first.recorded), _per_hour(first.recorded_per_hour))
    for point in points:
        one = point.levels[row]
        counts = (one.same, one.earlier, one.later, one.missed, one.added)
        table.add_row(
            f"{point.thresholds[report.swept]:g}" if report.swept else "now",
            str(one.rehearsed),
            _per_hour(one.rehearsed_per_hour),
            *map(str, counts),
            "" if one.median_shift_s is None else f"{one.median_shift_s:+.1f} s",
        )
    return table


def _print_changes(console: Console, point: RehearsedPoint) -> None:
    for change in point.changes[:_CHANGES_SHOWN]:
        console.print(_change_text(change))
    left_out = len(point.changes) - _CHANGES_SHOWN
    if left_out > 0:
        console.print(f"and {left_out} more; --json has all of them")


def _change_text(change: EpisodeChange) -> str:
    then, now = _time(change.recorded_ms), _time(change.rehearsed_ms)
    of = f"{change.incident_id}  {change.unit_id}  {change.rule} {change.level}"
    return f"{of}: {change.outcome.value}, then {then}, now {now}"


def _time(t_ms: int | None) -> str:
    return "not raised" if t_ms is None else f"{datetime.fromtimestamp(t_ms / 1000, UTC):%H:%M:%S}"


def _per_hour(rate: float | None) -> str:
    return "" if rate is None else f"{rate:.2f}"
