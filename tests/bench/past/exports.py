"""``muster bench exports``: an incident of many units as files for other programs."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import typer
from rich.console import Console
from rich.progress import Progress
from rich.table import Table

from base_station.replay.trail_kind import TrailKind
from base_station.storage.data_folder import DataFolder
from shared.bench_figures import FiguresFile, write_figures
from tests.bench.past.command import walk_incident

_TRACK_FILES = ("tracks.gpx", "tracks.gpx.gz", "tracks.kml", "tracks.geojson", "tracks.csv")
_FILES = (*_TRACK_FILES, "tracks.parquet")
_KINDS = (TrailKind.FUSED, TrailKind.SMOOTHED)


@dataclass(frozen=True, slots=True)
class ExportFigures:
    """Figures of one command, from its start to its end."""

    file: str
    kind: str
    took_s: float
    peak_mb: float  # resident
    size_mb: float


def bench_exports(
    units: Annotated[int, typer.Option(min=1, help="Wearers.")] = 100,
    minutes: Annotated[float, typer.Option(min=0.1, help="Duration of the walks.")] = 60.0,
    json_file: FiguresFile = None,
) -> None:
    """Measure memory and time of exports of a simulated incident: as it was shown, and
    post-processed (made before, and not measured).
    """
    with TemporaryDirectory(prefix="muster-bench-") as name, Progress(transient=True) as progress:
        folder = DataFolder(Path(name) / "station")
        folder.path.mkdir()
        walk_incident(folder, units, minutes, progress)
        progress.add_task("exporting", total=None)
        _muster("smooth", "i1", "--data", str(folder.path))
        figures = [
            _export(folder, Path(name) / f"{kind.value}-{file}", kind)
            for kind in _KINDS
            for file in _FILES
        ]
    Console().print(_table(figures))
    write_figures(json_file, figures)


def _export(folder: DataFolder, out: Path, kind: TrailKind) -> ExportFigures:
    data = ("--data", str(folder.path))
    took_s, peak_mb = _muster("export", "i1", str(out), *data, "--kind", kind.value)
    return ExportFigures(
        file=out.name.removeprefix(f"{kind.value}-tracks."),
        kind=kind.value,
        took_s=took_s,
        peak_mb=peak_mb,
        size_mb=out.stat().st_size / 1e6,
    )


def _muster(*arguments: str) -> tuple[float, float]:
    """Runs the command; gives the seconds it took and the most memory it had."""
    began_s = time.perf_counter()
    command = [sys.executable, "-m", "shared.command_line", "base", *arguments]
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode:
        raise typer.Exit(child.returncode)
    return time.perf_counter() - began_s, usage.ru_maxrss / 1e3


def _table(figures: list[ExportFigures]) -> Table:
    table = Table("file", "trails", "took", "memory, at most", "size")
    for one in figures:
        table.add_row(
            one.file,
            one.kind,
            f"{one.took_s:.1f} s",
            f"{one.peak_mb:.0f} MB",
            f"{one.size_mb:.1f} MB",
        )
    return table
