"""``muster bench archive-outage``: an S3 server that is gone for an hour while a station works.

Incidents are opened and closed meanwhile, and segments of the log are sealed.  Afterwards each
copy in the bucket is compared with the log.
"""

from __future__ import annotations

import os
import re
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from http import HTTPStatus
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import typer
from rich.console import Console as Terminal
from rich.table import Table

from base_station.app.archive_sources import open_archived_log
from base_station.archive.catalogue import archived_ids
from base_station.archive.checking import defects_of
from base_station.archive.store import open_store
from base_station.engine.log_feed import FolderFeed
from base_station.storage.db.records import Records
from base_station.storage.db.store import Store
from shared.bench_figures import FiguresFile, write_figures
from shared.clock import SystemClock
from shared.errors import StoreError
from shared.mcap_log import segment_paths
from tests.rig.bucket_server import ADDRESS, BucketServer, bucket_server
from tests.rig.pacing import wait_until
from tests.rig.simulated_units import BenchUnit, speak_in_turn, unit_names
from tests.rig.station_command import Browser
from tests.rig.station_process import Membership, StationProcess, station_process

_RATE_HZ = 2.0  # messages of a unit
_STEP_S = 2.0  # the station closes a connection that was idle for five seconds
_PATIENCE_S = 1200.0  # twice the longest pause of the station
_LOGGED = re.compile(r".*(?:not archived|takes incidents again).*")


@dataclass(frozen=True, slots=True)
class ArchiveMoment:
    """State of the archive as the station shows it."""

    elapsed_s: float  # since the server was killed
    state: str
    waiting: int
    copied: int
    has_problem: bool
    memory_mb: float  # of the station with its processes


@dataclass(frozen=True, slots=True)
class OutageReport:
    away_s: float
    units: int
    closed: int  # incidents
    archived: int
    segments: int
    sent: int  # messages of units
    logged: int
    logged_twice: int
    records: int  # of the closed incidents, in the log
    records_lost: int  # in the bucket
    records_twice: int
    defects: list[str]
    recovery_s: float  # from the server's return until all that was closed meanwhile is archived
    moments: list[ArchiveMoment]
    problems: list[str]  # sentences for a person, each once
    logged_lines: list[str]


class WatchedStation:
    """A station with units that walk, and incidents that are opened and closed."""

    def __init__(
        self,
        station: StationProcess,
        browser: Browser,
        units: list[BenchUnit],
        incident_s: float,
    ) -> None:
        self._station, self._browser = station, browser
        self._units, self._incident_s = units, incident_s
        self._killed_s = time.monotonic()
        self._incident_id, self._opened_s = "", 0.0
        self.closed: list[str] = []
        self.moments: list[ArchiveMoment] = []
        self.problems: list[str] = []

    def begin(self) -> None:
        for unit in self._units:
            self._browser.call("POST", "/units", json={"unit_id": unit.unit_id})
        wait_until("the station listens", lambda: all(one.is_received for one in self._units))
        for unit in self._units:
            unit.introduce()
        self._open()

    def note_kill(self) -> None:
        self._killed_s = time.monotonic()

    def work(self, seconds: float) -> None:
        """Units walk; an incident that is old enough is closed, and the next one opened."""
        end_s = time.monotonic() + seconds
        while (left_s := end_s - time.monotonic()) > 0.0:
            rate_hz = _RATE_HZ * len(self._units)
            speak_in_turn(self._units, rate_hz, min(_STEP_S, left_s), lambda: None)
            if time.monotonic() - self._opened_s > self._incident_s:
                self.close_incident()
                self._open()
            self.look()

    def close_incident(self) -> None:
        status = self._browser.close_incident(self._incident_id)
        if status != HTTPStatus.NO_CONTENT:
            raise StoreError(f"incident {self._incident_id} was not closed: {status}")
        self.closed.append(self._incident_id)

    def look(self) -> ArchiveMoment:
        health = self._browser.call("GET", "/health")
        archive = health["archive"]
        problems = [str(one) for one in health["problems"] if archive["location"] in str(one)]
        shown = [re.sub(r"\d+ min, \d+ wait", "… min, … wait", one) for one in problems]
        self.problems += [one for one in shown if one not in self.problems]
        moment = ArchiveMoment(
            time.monotonic() - self._killed_s,
            archive["state"],
            archive["waiting"],
            archive["copied"],
            bool(problems),
            self._station.memory_mb(),
        )
        self.moments.append(moment)
        return moment

    def has_archived(self, incident_ids: Sequence[str]) -> bool:
        self.look()
        incidents = self._browser.call("GET", "/incidents")
        archived = {one["incident_id"] for one in incidents if one["archived_ms"] is not None}
        return archived.issuperset(incident_ids)

    def wait_archived(self) -> None:
        wait_until(
            "all closed incidents are archived",
            lambda: self.has_archived(self.closed),
            _PATIENCE_S,
        )

    def _open(self) -> None:
        name = f"Incident {len(self.closed) + 1}"
        opened = self._browser.call("POST", "/incidents", json={"name": name})
        self._incident_id, self._opened_s = opened["incident_id"], time.monotonic()


def bench_archive_outage(
    away_s: Annotated[float, typer.Option(min=1.0, help="The S3 server is gone so long.")] = 3600.0,
    units: Annotated[int, typer.Option(min=1, help="Units that walk.")] = 4,
    incident_s: Annotated[float, typer.Option(min=1.0, help="Duration of an incident.")] = 120.0,
    json_file: FiguresFile = None,
) -> None:
    """Measure what a station archives after its S3 server was gone: losses, repeats, the time until
    nothing waits, and the station's memory.
    """
    report = measure(away_s, units, incident_s)
    for table in _tables(report):
        Terminal().print(table)
    for line in (*report.defects, *report.problems, *report.logged_lines):
        Terminal().print(line, markup=False)
    write_figures(json_file, report)


def measure(away_s: float, units: int, incident_s: float) -> OutageReport:
    with ExitStack() as closing:
        folder = Path(closing.enter_context(TemporaryDirectory(prefix="muster-bench-")))
        server = closing.enter_context(bucket_server())
        closing.enter_context(_environment(server.environment()))
        names = unit_names(units)
        members = Membership(folder, names, plain=True)
        settings = folder / "station.toml"
        settings.write_text(
            f'[archive]\nlocation = "{ADDRESS}"\nalarm_after_s = {max(away_s / 4, 60.0)}\n'
            f"[log]\nsegment_s = {max(incident_s / 2, 1.0)}\n"
        )
        station = closing.enter_context(station_process(folder, members.address, settings=settings))
        speakers = [BenchUnit(name, members.endpoint_of(name), closing) for name in names]
        browser = closing.enter_context(Browser(station.url, folder))
        watched = WatchedStation(station, browser, speakers, incident_s)
        recovery_s = _lose_the_server(watched, server, away_s, incident_s)
        watched.close_incident()
        watched.wait_archived()
        station.stop()
        return _compared(folder, station, watched, speakers, away_s, recovery_s)


def _lose_the_server(
    watched: WatchedStation, server: BucketServer, away_s: float, incident_s: float
) -> float:
    """Gives the time from the server's return until all that was closed meanwhile is archived."""
    watched.begin()
    watched.work(incident_s + 2 * _STEP_S)
    watched.wait_archived()
    server.stop()
    watched.note_kill()
    try:
        watched.work(away_s)
    finally:
        server.start()
    returned_s, missed = time.monotonic(), tuple(watched.closed)
    while not watched.has_archived(missed) and time.monotonic() - returned_s < _PATIENCE_S:
        watched.work(_STEP_S)
    return time.monotonic() - returned_s


def _compared(
    folder: Path,
    station: StationProcess,
    watched: WatchedStation,
    speakers: list[BenchUnit],
    away_s: float,
    recovery_s: float,
) -> OutageReport:
    """Records of each copy beside those of the log, byte for byte."""
    bucket = open_store(ADDRESS)
    records = lost = twice = 0
    with Store(folder / "station.sqlite") as store:
        for incident_id in watched.closed:
            incident = Records(store, SystemClock()).require_incident(incident_id)
            span = incident.opened_ns, incident.closed_ns
            here = list(FolderFeed(station.log).records(*span))
            with ExitStack() as closing:
                opened = open_archived_log(bucket, incident_id, closing, lambda _: None)
                there = list(opened.log.records(*span))
            records += len(here)
            lost += len(set(here) - set(there))
            twice += len(there) - len(set(there))
    recorded = station.recorded()
    output = (folder / "station.txt").read_text().splitlines()
    return OutageReport(
        away_s=away_s,
        units=len(speakers),
        closed=len(watched.closed),
        archived=len(set(archived_ids(bucket)) & set(watched.closed)),
        segments=len(segment_paths(station.log)),
        sent=sum(one.sent.messages for one in speakers),
        logged=recorded.from_units,
        logged_twice=recorded.repeated,
        records=records,
        records_lost=lost,
        records_twice=twice,
        defects=[f"{one}: {defect}" for one, defect in defects_of(bucket, lambda _: None)],
        recovery_s=recovery_s,
        moments=watched.moments,
        problems=watched.problems,
        logged_lines=[one for one in output if _LOGGED.fullmatch(one)],
    )


@contextmanager
def _environment(variables: dict[str, str]) -> Iterator[None]:
    """Variables of this process and of those that it starts."""
    before = {name: os.environ.get(name) for name in variables}
    os.environ.update(variables)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


def _tables(report: OutageReport) -> list[Table]:
    title = f"S3 server gone for {report.away_s:.0f} s, {report.units} units"
    figures = Table("", "figure", title=title)
    for name in (
        "closed", "archived", "segments", "sent", "logged", "logged_twice", "records",
        "records_lost", "records_twice",
    ):  # fmt: skip
        figures.add_row(name.replace("_", " "), str(getattr(report, name)))
    figures.add_row("defects", str(len(report.defects)))
    figures.add_row("recovery", f"{report.recovery_s:.0f} s")
    course = Table("after", "state", "waiting", "copied", "problem", "MB", title="as shown")
    step = max(len(report.moments) // 15, 1)
    for one in report.moments[::step]:
        problem = "yes" if one.has_problem else ""
        course.add_row(
            f"{one.elapsed_s:.0f} s",
            one.state,
            str(one.waiting),
            str(one.copied),
            problem,
            f"{one.memory_mb:.0f}",
        )
    return [figures, course]
