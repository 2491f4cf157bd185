"""``muster bench station``: messages a second that one core takes through a station, and whether
its memory stays as it is.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import numpy as np
import psutil
import typer
from rich.console import Console as Terminal
from rich.progress import Progress
from rich.table import Table

from base_station.bench.rig.compressed import CompressedStation, compressed_station
from base_station.bench.rig.units import unit_names
from base_station.program import interpreter
from shared.bench_figures import FiguresFile, write_figures

_TO_REACH_HZ = 20_000.0  # messages a second and core
_FLAT_MB_PER_MINUTE = 0.5
_WARM_S = 5.0


@dataclass(frozen=True, slots=True)
class ThroughputReport:
    units: int
    rate_hz: float  # of each unit
    consoles: int
    minutes: float  # of the station's time
    messages: int
    cpu_us: dict[str, float]  # by part, a message
    per_core_hz: float
    times_real: float  # how much faster than time goes by, on this machine now
    memory_mb: tuple[float, ...]  # once a minute of the station's time, the first at the start
    # Over the last third: by then trails are full; None: the run was too short to tell.
    memory_slope_mb_per_minute: float | None
    console_messages: int


def bench_station(
    units: Annotated[int, typer.Option(min=1, help="Wearers.")] = 500,
    rate: Annotated[float, typer.Option(min=0.1, help="Messages a second of each wearer.")] = 7.0,
    minutes: Annotated[float, typer.Option(min=0.05, help="Of the station's time.")] = 0.5,
    consoles: Annotated[int, typer.Option(min=0, help="Consoles that watch.")] = 3,
    json_file: FiguresFile = None,
) -> None:
    """What a message costs a station: log, pipeline, database and consoles, without the network,
    at full speed.  With --minutes 30 it tells whether memory grows.
    """
    with Progress(transient=True) as progress:
        report = measure(units, rate, minutes, consoles, progress)
    Terminal().print(_table(report))
    write_figures(json_file, report)


def measure(
    units: int, rate_hz: float, minutes: float, consoles: int, progress: Progress
) -> ThroughputReport:
    interpreter.relax()  # as the station does
    task = progress.add_task(f"{units} units", total=minutes)
    with (
        TemporaryDirectory(prefix="muster-bench-") as folder,
        compressed_station(Path(folder), unit_names(units), rate_hz, consoles) as station,
    ):
        station.run(_WARM_S)
        interpreter.settle()
        messages, spent_s, began = station.messages, station.cpu_s(), time.perf_counter()
        memory_mb = [_memory_mb()]
        while (left := minutes - (len(memory_mb) - 1)) > 0.0:
            station.run(60.0 * min(left, 1.0))
            memory_mb.append(_memory_mb())
            progress.advance(task, min(left, 1.0))
        took_s, messages = time.perf_counter() - began, station.messages - messages
        cpu_us = _cost_us(station, spent_s, messages)
        shown = station.console_messages
    return ThroughputReport(
        units=units,
        rate_hz=rate_hz,
        consoles=consoles,
        minutes=minutes,
        messages=messages,
        cpu_us=cpu_us,
        per_core_hz=1e6 / sum(cpu_us.values()),
        times_real=minutes * 60.0 / took_s,
        memory_mb=tuple(memory_mb),
        memory_slope_mb_per_minute=_slope(memory_mb),
        console_messages=shown,
    )


def _cost_us(
    station: CompressedStation, before_s: dict[str, float], messages: int
) -> dict[str, float]:
    now_s = station.cpu_s()
    return {part: (now_s[part] - before_s.get(part, 0.0)) * 1e6 / messages for part in now_s}


def _memory_mb() -> float:
    return float(psutil.Process().memory_info().rss) / 1e6


def _slope(memory_mb: list[float]) -> float | None:
    """Of the last third, by least squares; a run of a few minutes tells nothing."""
    late = memory_mb[2 * len(memory_mb) // 3 :]
    if len(late) < 3:
        return None
    return float(np.polyfit(np.arange(len(late)), late, 1)[0])


def _table(report: ThroughputReport) -> Table:
    table = Table(
        title=f"{report.units} units at {report.rate_hz:g} messages a second each, "
        f"{report.consoles} consoles, {report.minutes:g} min",
        caption="Time of the processor; making the messages is not counted.",
    )
    for title in ("", "measured", "to reach"):
        table.add_column(title, justify="left" if title == "" else "right")
    slope = report.memory_slope_mb_per_minute
    rows = [("messages", f"{report.messages:,}", "")]
    rows += [(part, f"{cost_us:.1f} us a message", "") for part, cost_us in report.cpu_us.items()]
    rows += [
        ("a core takes", f"{report.per_core_hz:,.0f} /s", f"{_TO_REACH_HZ:,.0f} /s"),
        ("faster than time goes by", f"{report.times_real:.1f} times", ""),
        ("to consoles", f"{report.console_messages:,}", ""),
        ("memory at first, most, at last", _extremes(report.memory_mb), ""),
        (
            "memory grows, last third",
            "told by a longer run" if slope is None else f"{slope:.2f} MB/min",
            f"{_FLAT_MB_PER_MINUTE:.2f} MB/min",
        ),
    ]
    for row in rows:
        table.add_row(*row)
    return table


def _extremes(memory_mb: tuple[float, ...]) -> str:
    return f"{memory_mb[0]:.0f}, {max(memory_mb):.0f}, {memory_mb[-1]:.0f} MB"
