"""``muster bench bus``: throughput of a station, and delay until a console shows a message."""

from __future__ import annotations

import time
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import psutil
import typer
from rich.console import Console as Terminal
from rich.progress import Progress

from shared.bench_figures import FiguresFile, write_figures
from tests.bench.bus.report import BusReport, table_of
from tests.rig.console_client import Console, watching
from tests.rig.console_load import ConsoleGroup, ConsoleTraffic
from tests.rig.latency import latencies_ms, latency_of
from tests.rig.pacing import wait_until
from tests.rig.raw_zenoh_baseline import BareFigures, bare_subscriber, measure_flood, measure_steady
from tests.rig.recorder_baseline import recording_hz
from tests.rig.simulated_units import BenchUnit, speak_in_turn, unit_names
from tests.rig.station_process import (
    Membership,
    PlainTcp,
    RunRecords,
    StationProcess,
    free_port,
    station_process,
)

_SETTLE_S = 2.0
_STEADY_S = 5.0
_FLOOD_S = 2.0
_RECORDED = 200_000  # messages


def bench_bus(
    units: Annotated[int, typer.Option(min=1, help="Simulated units.")] = 100,
    rate: Annotated[
        float, typer.Option(min=0.1, help="Messages a second of each unit, positions mostly.")
    ] = 10.0,
    seconds: Annotated[float, typer.Option(min=1.0, help="Duration of the load.")] = 30.0,
    consoles: Annotated[int, typer.Option(min=1, help="Consoles that watch.")] = 3,
    onlookers: Annotated[
        int, typer.Option(min=0, help="Further consoles that only count what they get.")
    ] = 0,
    slow: Annotated[int, typer.Option(min=0, help="Further consoles that hardly read.")] = 0,
    plain: PlainTcp = False,
    json_file: FiguresFile = None,
) -> None:
    """Measure messages a second and latency from sensor to WebSocket through a real station, beside
    a bare Zenoh publisher and subscriber in the same run.
    """
    load = Load(units, rate, seconds, consoles, onlookers, slow)
    with Progress(transient=True) as progress:
        report = measure(load, progress, plain=plain)
    Terminal().print(table_of(report))
    for problem in report.problems:
        Terminal().print(f"the station says: {problem}")
    write_figures(json_file, report)


@dataclass(frozen=True, slots=True)
class Load:
    """Load on the station."""

    units: int
    rate_hz: float  # messages a second of each unit
    seconds: float
    consoles: int
    onlookers: int = 0  # further consoles that read whatever comes
    slow: int = 0  # and that hardly do

    @property
    def total_hz(self) -> float:
        return self.units * self.rate_hz


def measure(load: Load, progress: Progress, *, plain: bool = False) -> BusReport:
    """Bare Zenoh over plain TCP first, then the station, both on this machine."""
    steady_s, flood_s = min(_STEADY_S, load.seconds), min(_FLOOD_S, load.seconds)
    task = progress.add_task("bare Zenoh", total=steady_s + flood_s + load.seconds)
    address = f"tcp/127.0.0.1:{free_port()}"
    with bare_subscriber(address) as far_end:
        steady = measure_steady(address, far_end, load.total_hz, steady_s)
        progress.advance(task, steady_s)
        flood = measure_flood(address, far_end, flood_s)
        progress.advance(task, flood_s)
    progress.update(task, description=f"{load.units} units")
    with TemporaryDirectory(prefix="muster-bench-") as folder, ExitStack() as closing:
        names = unit_names(load.units)
        members = Membership(Path(folder), names, plain=plain)
        station = closing.enter_context(station_process(Path(folder), members.address))
        speakers = [BenchUnit(name, members.endpoint_of(name), closing) for name in names]
        return _run_station(station, speakers, load, (steady, flood), progress, closing)


def _run_station(
    station: StationProcess,
    units: list[BenchUnit],
    load: Load,
    bare: tuple[BareFigures, BareFigures],
    progress: Progress,
    closing: ExitStack,
) -> BusReport:
    for unit in units:
        station.api.post("/units", {"unit_id": unit.unit_id})
    wait_until("the station listens", lambda: all(unit.is_received for unit in units))
    consoles = watching(station.api, load.consoles, closing)
    onlookers = ConsoleGroup(station.api, load.onlookers, load.slow)
    for unit in units:
        unit.introduce()
    time.sleep(_SETTLE_S)

    station.begin_measuring()
    [task] = progress.task_ids
    rate_hz = speak_in_turn(units, load.total_hz, load.seconds, lambda: progress.advance(task))
    cpu_share, memory_mb = station.cpu_share(), station.memory_mb()
    time.sleep(_SETTLE_S)

    stepped = station.api.get("/health")["messages"]
    quick, slow = onlookers.close()
    for console in consoles:
        console.close()
    station.stop()
    return _report(
        station.recorded(),
        bare,
        consoles[0],
        units,
        (quick, slow),
        units=load.units,
        consoles=load.consoles,
        rate_wanted_hz=load.total_hz,
        rate_hz=rate_hz,
        seconds=load.seconds,
        sent=sum(unit.sent.messages for unit in units),
        stepped=stepped,
        cpu_share=cpu_share,
        memory_mb=memory_mb,
    )


def _report(
    recorded: RunRecords,
    bare: tuple[BareFigures, BareFigures],
    console: Console,
    speakers: list[BenchUnit],
    onlookers: tuple[ConsoleTraffic, ConsoleTraffic],
    **measured: float,
) -> BusReport:
    steady, flood = bare
    positions = {unit.unit_id: unit.sent.position_times_ns for unit in speakers}
    shown = latencies_ms(positions, console.shown)
    return BusReport(
        **measured,  # type: ignore[arg-type]  # counts are ints
        recorded=recorded.from_units,
        lost=int(measured["sent"]) - recorded.from_units,
        repeated=recorded.repeated,
        positions_sent=sum(map(len, positions.values())),
        positions_shown=len(shown),
        latency=latency_of(shown),
        track_points_due=recorded.track_points_due,
        track_points=recorded.track_points,
        console_gaps=console.gaps,
        console_kbit_s=console.bytes_received * 8e-3 / measured["seconds"],
        onlookers=onlookers[0],
        slow=onlookers[1],
        problems=console.problems,
        bare_latency=latency_of(steady.latencies_ms),
        bare_lost=steady.sent - steady.received,
        bare_flood_hz=flood.rate_hz,
        recording_hz=recording_hz(_RECORDED),
        cores=psutil.cpu_count() or 1,
    )
