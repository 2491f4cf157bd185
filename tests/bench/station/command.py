"""``muster bench station``: messages a second of one core through a station, and growth of its
memory.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console as Terminal
from rich.progress import Progress
from rich.table import Table

from shared.bench_figures import FiguresFile, write_figures

if TYPE_CHECKING:
    from tests.bench.station.load import ThroughputReport, Yardsticks

_TO_REACH_HZ = 20_000.0  # messages a second and core
_RECORDING_HZ = 150_000.0
_AS_UNITS_SPEAK_HZ = 7.0
_FULL_MINUTES = 0.5  # at what is to be reached, which tells nothing more for being longer
_FLAT_MB_PER_MINUTE = 0.5


def bench_station(
    units: Annotated[int, typer.Option(min=1, help="Wearers.")] = 500,
    rate: Annotated[
        float | None,
        typer.Option(
            min=0.1,
            help="Messages a second of each wearer.",
            show_default="7, and then what is to be reached by all together",
        ),
    ] = None,
    minutes: Annotated[float, typer.Option(min=0.05, help="Duration in the station's time.")] = 0.5,
    consoles: Annotated[int, typer.Option(min=0, help="Consoles that watch.")] = 3,
    json_file: FiguresFile = None,
) -> None:
    """Measure the cost of a message at a station at full speed: log, pipeline, database and
    consoles, without the network; beside it the log alone and a bare subscriber.

    With --minutes 30 it shows whether memory grows.
    """
    # Loads the core.
    from tests.bench.station.load import measure, measure_yardsticks  # noqa: PLC0415

    loads = [(rate or _AS_UNITS_SPEAK_HZ, minutes)]
    if rate is None:
        loads.append((_TO_REACH_HZ / units, min(minutes, _FULL_MINUTES)))
    with Progress(transient=True) as progress:
        reports = [measure(units, hz, long, consoles, progress) for hz, long in loads]
        yardsticks = measure_yardsticks(progress)
    Terminal().print(_table(reports, yardsticks))
    write_figures(json_file, {"loads": reports, "yardsticks": yardsticks})


def _table(reports: Sequence[ThroughputReport], yardsticks: Yardsticks) -> Table:
    one = reports[0]
    core = "machine code" if one.is_compiled else "plain Python"
    table = Table(
        title=f"{one.units} units, {one.consoles} consoles; the core is {core}",
        caption="Time of the processor; making the messages is not counted.",
    )
    table.add_column("messages a second of each unit")
    for report in reports:
        table.add_column(f"{report.rate_hz:g}", justify="right")
    table.add_column("to reach", justify="right")

    def add(title: str, figure: Callable[[ThroughputReport], str], to_reach: str = "") -> None:
        table.add_row(title, *map(figure, reports), to_reach)

    add("minutes of the station's time", lambda report: f"{report.minutes:g}")
    add("messages", lambda report: f"{report.messages:,}")
    for part in one.cpu_us:
        add(f"{part}, a message", partial(_cost, part))
    add("a core takes", lambda report: f"{report.per_core_hz:,.0f} /s", f"{_TO_REACH_HZ:,.0f} /s")
    add("faster than time goes by", lambda report: f"{report.times_real:.1f} times")
    add("to consoles", lambda report: f"{report.console_messages:,}")
    add("memory at first, most, at last", lambda report: _extremes(report.memory_mb))
    add("memory grows, last third", _growth, f"{_FLAT_MB_PER_MINUTE:.2f} MB/min")
    empty = [""] * (len(reports) - 1)
    recording = f"{yardsticks.recording_hz:,.0f} /s"
    table.add_row("a core records alone", recording, *empty, f"{_RECORDING_HZ:,.0f} /s")
    table.add_row("bare Zenoh, 200 B, takes", f"{yardsticks.bare_zenoh_hz:,.0f} /s", *empty)
    return table


def _cost(part: str, report: ThroughputReport) -> str:
    return f"{report.cpu_us[part]:.1f} us"


def _growth(report: ThroughputReport) -> str:
    slope = report.memory_slope_mb_per_minute
    return "told by a longer run" if slope is None else f"{slope:.2f} MB/min"


def _extremes(memory_mb: tuple[float, ...]) -> str:
    return f"{memory_mb[0]:.0f}, {max(memory_mb):.0f}, {memory_mb[-1]:.0f} MB"
