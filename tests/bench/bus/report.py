"""Report of ``muster bench bus``: the figures beside what is to be reached."""

from __future__ import annotations

from dataclasses import dataclass

from rich.table import Table

from base_station.engine.delta_pace import SHORTEST_NS
from shared.clock import NS_PER_S
from tests.rig.console_load import ConsoleTraffic
from tests.rig.latency import Latency

_LATENCY_P99_MS = 300.0  # to reach
_CPU_SHARE = 1.0  # to reach
_RECORDING_HZ = 150_000  # to reach


@dataclass(frozen=True, slots=True)
class BusReport:
    """One run."""

    units: int
    consoles: int
    rate_wanted_hz: float
    rate_hz: float
    seconds: float
    sent: int
    stepped: int
    recorded: int
    lost: int
    repeated: int
    positions_sent: int
    positions_shown: int
    latency: Latency
    track_points_due: int
    track_points: int
    cpu_share: float  # of one core
    memory_mb: float
    console_gaps: int
    console_kbit_s: float
    onlookers: ConsoleTraffic
    slow: ConsoleTraffic
    problems: tuple[str, ...]
    bare_latency: Latency
    bare_lost: int
    bare_flood_hz: float
    recording_hz: float  # a second of processor time
    cores: int


def table_of(report: BusReport) -> Table:
    table = Table(
        title=f"{report.units} units, {report.consoles} consoles, {report.cores} cores",
        caption=f"A console gets a delta every {SHORTEST_NS / NS_PER_S:g} s, of alarms sooner.",
    )
    for title in ("", "measured", "to reach"):
        table.add_column(title, justify="left" if title == "" else "right")
    bare, live = report.bare_latency, report.latency
    rows = [
        ("messages a second", f"{report.rate_hz:,.0f}", f"{report.rate_wanted_hz:,.0f}"),
        ("sent", f"{report.sent:,}", ""),
        ("in the log", f"{report.recorded:,}", f"{report.sent:,}"),
        ("lost", f"{report.lost:,}", "0"),
        ("twice in the log", f"{report.repeated:,}", "0"),
        ("stepped", f"{report.stepped:,}", f"{report.sent:,}"),
        ("track points in SQL", f"{report.track_points:,}", f"{report.track_points_due:,}"),
        ("positions at a console", f"{report.positions_shown:,}", f"{report.positions_sent:,}"),
        ("sensor to WebSocket p50", f"{live.p50_ms:.1f} ms", ""),
        ("sensor to WebSocket p99", f"{live.p99_ms:.1f} ms", f"{_LATENCY_P99_MS:.0f} ms"),
        ("sensor to WebSocket max", f"{live.max_ms:.1f} ms", ""),
        ("station, of one core", f"{report.cpu_share:.0%}", f"{_CPU_SHARE:.0%}"),
        ("station, memory", f"{report.memory_mb:.0f} MB", ""),
        ("to each console", f"{report.console_kbit_s:,.0f} kbit/s", ""),
        ("bare Zenoh p50, p99", f"{bare.p50_ms:.2f}, {bare.p99_ms:.2f} ms", ""),
        ("bare Zenoh lost", f"{report.bare_lost:,}", ""),
        ("bare Zenoh flood of 200 B", f"{report.bare_flood_hz:,.0f} /s", ""),
        ("recording alone, of one core", f"{report.recording_hz:,.0f} /s", f"{_RECORDING_HZ:,} /s"),
    ]
    rows += _onlookers("onlookers", report.onlookers) + _onlookers("slow consoles", report.slow)
    for row in rows:
        table.add_row(*row)
    return table


def _onlookers(name: str, seen: ConsoleTraffic) -> list[tuple[str, str, str]]:
    if seen.onlookers == 0:
        return []
    return [
        (name, f"{seen.onlookers:,}", ""),
        (f"{name}: messages to the last of them", f"{seen.least_messages:,}", ""),
        (f"{name}: snapshots, cut off", f"{seen.snapshots:,}, {seen.cut_off:,}", ""),
    ]
