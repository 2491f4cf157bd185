"""``muster bench restart``: time until a restarted station shows its console."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import typer
from rich.console import Console as Terminal
from rich.progress import Progress
from rich.table import Table

from base_station.engine.engine import CHECKPOINT_NS
from base_station.storage.data_folder import DataFolder
from shared.bench_figures import FiguresFile, write_figures
from shared.errors import StoreError
from shared.mcap_log import SegmentReader, segment_paths
from tests.rig.accelerated_station import compressed_station
from tests.rig.console_client import Console
from tests.rig.simulated_units import unit_names
from tests.rig.station_process import free_port, station_process

_TO_REACH_S = 3.0
_PATIENCE_S = 600.0
_TORN_BYTES = 2000  # that a kill takes from the newest segment


@dataclass(frozen=True, slots=True)
class RestartRow:
    after: str
    ready_s: float  # the console can be opened
    shown_s: float  # and shows every unit
    cpu_s: float  # of the station, until then


@dataclass(frozen=True, slots=True)
class RestartReport:
    units: int
    minutes: float
    messages: int
    log_mb: float
    rows: tuple[RestartRow, ...]


def bench_restart(
    units: Annotated[int, typer.Option(min=1, help="Wearers.")] = 100,
    minutes: Annotated[float, typer.Option(min=0.1, help="Duration of their walks.")] = 60.0,
    json_file: FiguresFile = None,
) -> None:
    """Measure the start of a station on the log of an hour: after an orderly stop, after a kill
    that left the log torn, and without any saved state.
    """
    with Progress(transient=True) as progress:
        report = measure(units, minutes, progress)
    Terminal().print(_table(report))
    write_figures(json_file, report)


def measure(units: int, minutes: float, progress: Progress) -> RestartReport:
    with TemporaryDirectory(prefix="muster-bench-") as name:
        folder = DataFolder(Path(name))
        task = progress.add_task(f"{units} units walk", total=minutes)
        with compressed_station(folder.path, unit_names(units), 7.0, consoles=0) as station:
            while (left := minutes - progress.tasks[0].completed) > 0.0:
                station.run(60.0 * min(left, 1.0))
                progress.advance(task, min(left, 1.0))
            messages = station.messages
        walked = segment_paths(folder.log)
        log_bytes = sum(path.stat().st_size for path in walked)
        with _started(folder, units, ""):
            pass  # makes the first login
        rows = [_measured(folder, units, "a stop")]
        _as_killed(folder, walked)
        rows.append(_measured(folder, units, "a kill"))
        for path in folder.checkpoints.iterdir():
            path.unlink()
        rows.append(_measured(folder, units, "a kill, no saved state"))
    return RestartReport(units, minutes, messages, log_bytes / 1e6, tuple(rows))


def _measured(folder: DataFolder, units: int, after: str) -> RestartRow:
    with _started(folder, units, after) as row:
        return row


@contextmanager
def _started(folder: DataFolder, units: int, after: str) -> Iterator[RestartRow]:
    began = time.perf_counter()
    with (
        station_process(folder.path, f"tcp/127.0.0.1:{free_port()}", patience_s=_PATIENCE_S) as one,
        ExitStack() as closing,
    ):
        ready_s = time.perf_counter() - began
        console = Console(one.api, closing)
        if not console.wait_ready(_PATIENCE_S) or console.units_shown < units:
            raise StoreError("the station that was started again does not show every unit")
        yield RestartRow(after, ready_s, time.perf_counter() - began, one.cpu_s())
        console.close()
        one.stop()


def _as_killed(folder: DataFolder, walked: Sequence[Path]) -> None:
    """While they walked, just before the state would have been saved again: of the log only that is
    left, its end torn, and of what was saved nothing that is newer.
    """
    for path in set(segment_paths(folder.log)) - set(walked):
        path.unlink()
    with SegmentReader(walked[-1]) as reader:
        end_ns = reader.info().end_ns
    for path in folder.checkpoints.iterdir():
        if int(path.stem) > end_ns - CHECKPOINT_NS:
            path.unlink()
    with walked[-1].open("r+b") as file:
        file.truncate(max(walked[-1].stat().st_size - _TORN_BYTES, 0))


def _table(report: RestartReport) -> Table:
    table = Table(
        title=f"{report.minutes:g} min of {report.units} units: {report.messages:,} messages, "
        f"a log of {report.log_mb:.0f} MB",
    )
    for title in ("started again after", "console opens", "shows all units", "CPU", "to reach"):
        table.add_column(title, justify="left" if title.startswith("started") else "right")
    for row in report.rows:
        times = (row.ready_s, row.shown_s, row.cpu_s)
        table.add_row(row.after, *(f"{one:.1f} s" for one in times), f"{_TO_REACH_S:.0f} s")
    return table
