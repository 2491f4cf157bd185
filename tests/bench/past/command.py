"""``muster bench past``: cost of post-processing an incident beside a station."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Event, Thread
from typing import Annotated

import psutil
import typer
from rich.console import Console
from rich.progress import Progress
from rich.table import Table

from base_station.app.pipeline_factory import past_pipeline
from base_station.engine.log_feed import FolderFeed
from base_station.fusion.smoothing import SMOOTHERS
from base_station.replay.playback import Archive
from base_station.replay.processes.post_processing_process import (
    PostProcessingContext,
    PostProcessingProcess,
)
from base_station.replay.processes.server import ReplayProcesses
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.records import Records
from base_station.storage.db.smoothed import SmoothedTracks
from base_station.storage.db.store import Store
from shared.bench_figures import FiguresFile, write_figures
from shared.clock import SystemClock
from shared.messages.station import CloseIncident, OpenIncident, SetStart
from tests.bench.past.building_walk import BuildingWearer
from tests.bench.past.live_positions import PositionAges, live_positions
from tests.rig.accelerated_station import compressed_station
from tests.rig.latency import Latency, latency_of
from tests.rig.simulated_units import unit_names

_RATE_HZ = 7.0  # messages a second of each unit
_TO_REACH_MB = 500.0
_POLL_INTERVAL_S = 0.02


@dataclass(frozen=True, slots=True)
class LookBackFigures:
    units: int
    minutes: float
    messages: int
    points: int  # of all trails
    peak_mb: float  # resident, of the process that works it out
    took_s: float
    alone: Latency  # of live positions as consoles get them, before and after it
    meanwhile: Latency


def bench_past(
    units: Annotated[int, typer.Option(min=1, help="Wearers.")] = 100,
    minutes: Annotated[float, typer.Option(min=0.1, help="Duration of the walks.")] = 60.0,
    live_units: Annotated[int, typer.Option(min=1, help="Wearers at the live station.")] = 20,
    alone_s: Annotated[
        float, typer.Option(min=0.5, help="Duration without the work, before and after it.")
    ] = 20.0,
    json_file: FiguresFile = None,
) -> None:
    """Measure time and memory of the post-processing of a simulated incident, and its effect on the
    delay of positions at a live station beside it.
    """
    with TemporaryDirectory(prefix="muster-bench-") as name, Progress(transient=True) as progress:
        folder = DataFolder(Path(name))
        messages = walk_incident(folder, units, minutes, progress)
        progress.add_task("looking back", total=None)
        live = live_positions(folder.path / "live", live_units, _RATE_HZ)
        figures = _look_back(folder, units, minutes, messages, live, alone_s)
    Console().print(_table(figures))
    write_figures(json_file, figures)


def walk_incident(folder: DataFolder, units: int, minutes: float, progress: Progress) -> int:
    """Leave a closed incident ``i1`` in ``folder``; gives the number of messages."""
    task = progress.add_task(f"{units} units walk", total=minutes)
    names = unit_names(units)
    with compressed_station(folder.path, names, _RATE_HZ, 0, BuildingWearer) as station:
        station.run(2.0)
        station.act(OpenIncident("i1", "bench"))
        for name in names:
            station.act(SetStart(name, 0.0, 0.0, 0.0, 0.0, 0.5, 0.1))
        while (left := minutes - progress.tasks[0].completed) > 0.0:
            station.run(60.0 * min(left, 1.0))
            progress.advance(task, min(left, 1.0))
        station.act(CloseIncident("i1"))
        return station.messages


def _look_back(
    folder: DataFolder,
    units: int,
    minutes: float,
    messages: int,
    live: AbstractContextManager[PositionAges],
    alone_s: float,
) -> LookBackFigures:
    log = FolderFeed(folder.log)
    archive = Archive(log.records, Checkpoints(folder.checkpoints), past_pipeline, log.watch)
    with Store(folder.database) as store, ReplayProcesses() as processes:
        place = PostProcessingContext(
            processes=processes,
            log=str(folder.log),
            checkpoints=str(folder.checkpoints),
            database=str(folder.database),
            prepare=lambda: None,
            note_damage=typer.echo,
        )
        clock = SystemClock()
        incident = Records(store, clock).require_incident("i1")
        kept = SmoothedTracks(store)
        post_processor = PostProcessingProcess(place, archive, SMOOTHERS[0], kept, clock)
        with live as ages:
            alone_ms = _ages_alone(ages, alone_s)
            began_s = time.perf_counter()
            with _peak_mb(processes) as seen_mb:
                made = post_processor.post_process(incident, {})
            took_s = time.perf_counter() - began_s
            meanwhile_ms = ages.take()
            alone_ms += _ages_alone(ages, alone_s)
        points = sum(len(track) for track in made.smoothed.values())
    return LookBackFigures(
        units,
        minutes,
        messages,
        points,
        max(seen_mb),
        took_s,
        latency_of(alone_ms),
        latency_of(meanwhile_ms),
    )


def _ages_alone(ages: PositionAges, seconds: float) -> list[float]:
    ages.take()  # of before
    time.sleep(seconds)
    return ages.take()


@contextmanager
def _peak_mb(processes: ReplayProcesses) -> Iterator[list[float]]:
    """Resident, of all that are at work, looked at again and again while it lasts."""
    seen_mb, over = [0.0], Event()

    def look() -> None:
        while not over.wait(_POLL_INTERVAL_S):
            pid = processes.pid
            if pid is not None:
                seen_mb.extend(_memory_mb(one) for one in psutil.Process(pid).children())

    looking = Thread(target=look, name="bench-memory")
    looking.start()
    try:
        yield seen_mb
    finally:
        over.set()
        looking.join()


def _memory_mb(process: psutil.Process) -> float:
    try:
        return float(process.memory_info().rss) / 1e6
    except psutil.NoSuchProcess:  # it has just ended
        return 0.0


def _table(figures: LookBackFigures) -> Table:
    table = Table(
        title=f"Looking back on {figures.minutes:g} min of {figures.units} units: "
        f"{figures.messages:,} messages, {figures.points:,} points"
    )
    for title in ("", "", "to reach"):
        table.add_column(title, justify="right" if title or table.columns else "left")
    table.add_row("memory, at most", f"{figures.peak_mb:.0f} MB", f"{_TO_REACH_MB:.0f} MB")
    table.add_row("took", f"{figures.took_s:.1f} s", "")
    for name, ages in (("without it", figures.alone), ("meanwhile", figures.meanwhile)):
        table.add_row(
            f"live positions {name}, p50, p99", f"{ages.p50_ms:.0f}, {ages.p99_ms:.0f} ms", ""
        )
    return table
