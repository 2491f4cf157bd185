"""``muster bench archive``: search of many incidents, and the first picture over a slow link."""

from __future__ import annotations

import os
import subprocess
import sys
from contextlib import ExitStack, closing
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import msgspec
import typer
from rich.console import Console
from rich.table import Table

from base_station.app.factories import project_whole_log
from base_station.storage.db.store import Store
from shared.bench_figures import FiguresFile, write_figures
from shared.mcap_log import SegmentWriter
from shared.messages.station import CloseIncident
from tests.bench.archive.catalogue import SearchFigures, search_figures
from tests.bench.archive.pictures import Picture
from tests.rig.bucket_server import ADDRESS, BucketServer
from tests.rig.console_log import with_console
from tests.rig.link_forwarder import Conditions
from tests.rig.live_station import make_pipeline
from tests.rig.lossy_link import LossyLink
from tests.rig.round_walk import Walk
from tests.rig.simulated_units import unit_names

_LINK = Conditions(delay_s=0.020, rate_bps=50e6)  # each way
_PROJECT = Path(__file__).parents[3]


@dataclass(frozen=True, slots=True)
class ArchiveFigures:
    incidents: int
    searches: list[SearchFigures]
    units: int
    minutes: float
    archived_mb: float
    pictures: list[Picture]


def bench_archive(
    incidents: Annotated[int, typer.Option(min=1, help="Incidents to search.")] = 10_000,
    units: Annotated[int, typer.Option(min=1, help="Units of the archived incident.")] = 50,
    minutes: Annotated[
        float, typer.Option(min=1.0, help="Duration of the archived incident.")
    ] = 15.0,
    pictures: Annotated[int, typer.Option(min=1, help="Pictures that are shown.")] = 10,
    json_file: FiguresFile = None,
) -> None:
    """Measure the search of many archived incidents, and the time to the first picture of one in a
    bucket behind a link of 20 ms each way and 50 Mbit/s.
    """
    with TemporaryDirectory(prefix="muster-bench-") as name, ExitStack() as cleaning:
        folder = Path(name)
        searches = search_figures(folder, incidents)
        (folder / "station").mkdir()
        walk_incident(folder / "station", units, minutes)
        link = LossyLink(1, cleaning)
        link.set(_LINK)
        (folder / "bucket").mkdir()
        server = BucketServer(folder / "bucket", link.station)
        cleaning.callback(server.stop)
        server.start()
        environment = {**os.environ, **server.environment(), "AWS_ALLOW_HTTP": "true"}

        def run(inside: tuple[str, ...], *module: str) -> str:
            command = [*inside, sys.executable, "-m", *module]
            return subprocess.run(
                command, env=environment, cwd=_PROJECT, capture_output=True, text=True, check=True
            ).stdout

        copy = ("shared.command_line", "base", "archive", "copy", ADDRESS)
        run(link.station.inside(), *copy, "--data", str(folder / "station"))
        shown = run(
            link.units.inside(), "tests.bench.archive.pictures", ADDRESS, "i1", str(pictures)
        )
        size_mb = sum(one.stat().st_size for one in (folder / "bucket").rglob("*.dat")) / 1e6
    figures = ArchiveFigures(
        incidents,
        searches,
        units,
        minutes,
        size_mb,
        msgspec.json.decode(shown, type=list[Picture]),
    )
    for table in _tables(figures):
        Console().print(table)
    write_figures(json_file, figures)


def walk_incident(data: Path, units: int, minutes: float) -> None:
    """A station's folder with one closed incident, as long as that."""
    walk = Walk(*unit_names(units))
    for unit_id in walk.units:
        walk.start(unit_id)
    walk.go(round(minutes * 60))
    walk.script.act(CloseIncident("i1"))
    with closing(SegmentWriter(data / "log")) as log:
        for record in with_console(walk.script.records, make_pipeline(None)):
            log.write(*record)
    with Store(data / "station.sqlite") as store:
        project_whole_log(store, data / "log", lambda _: None)


def _tables(figures: ArchiveFigures) -> list[Table]:
    searches = Table("search", "found", "slowest", title=f"{figures.incidents} incidents")
    for one in figures.searches:
        searches.add_row(one.asked, str(one.found), f"{one.took_s * 1e3:.0f} ms")
    title = (
        f"first picture: {figures.units} units, {figures.minutes:g} min, "
        f"{figures.archived_mb:.1f} MB archived; 20 ms each way, 50 Mbit/s"
    )
    pictures = Table("second", "took", "of it waited", "requests", "kB", "units", title=title)
    for shown in figures.pictures:
        pictures.add_row(
            f"{shown.second:.0f}",
            f"{shown.took_s:.2f} s",
            f"{shown.waited_s:.2f} s",
            str(shown.requests),
            f"{shown.kilobytes:.0f}",
            str(shown.units),
        )
    return [searches, pictures]
