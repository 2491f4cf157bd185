"""``muster bench department``: summaries of many stations through a department's own path."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import msgspec
import typer
from rich.console import Console as Terminal
from rich.table import Table

from base_station.security.pki.folder import PkiFolder
from shared.bench_figures import FiguresFile, write_figures
from shared.enrolment import Holder
from shared.errors import BusError
from tests.rig.department_process import DepartmentProcess
from tests.rig.latency import Latency, latency_of
from tests.rig.pacing import wait_until
from tests.rig.program import launch_installed
from tests.rig.simulated_stations import StationsReport, clock_ms, station_name
from tests.rig.station_process import free_port

_POLL_S = 0.02
_PAGES_EVERY_S = 0.5
_PEOPLE_PAGE = 100


@dataclass(frozen=True, slots=True)
class DepartmentReport:
    """Figures of one run."""

    stations: int
    units: int  # of each
    summaries_hz: float  # that stations sent
    shown: Latency  # from the sending of a summary until the API shows it
    overview: Latency  # request of all stations, incidents and alarms
    people: Latency  # request of a page of people, of all
    events_sent: int
    events_lost: int
    events_repeated: int
    cpu_share: float  # of one core, with the router
    memory_mb: float  # with the router


def bench_department(
    stations: Annotated[int, typer.Option(min=1, help="Stations of the department.")] = 200,
    units: Annotated[int, typer.Option(min=1, help="Units of each station.")] = 100,
    seconds: Annotated[float, typer.Option(min=5.0, help="Duration of the reports.")] = 60.0,
    json_file: FiguresFile = None,
) -> None:
    """Measure the delay of a department's view, its requests and memory, with stations that report
    to it.
    """
    report = measure(stations, units, seconds)
    Terminal().print(_table_of(report))
    write_figures(json_file, report)


def measure(stations: int, units: int, seconds: float) -> DepartmentReport:
    with TemporaryDirectory(prefix="muster-bench-") as temporary:
        folder = Path(temporary)
        address = f"tls/127.0.0.1:{free_port()}"
        pki = PkiFolder(folder / "department")
        pki.create("Bench", hosts=[], connect=[address])
        enrolments = folder / "enrolments"
        enrolments.mkdir()
        for number in range(stations):
            name = station_name(number)
            pki.enroll(name, Holder.DEPARTMENT_STATION).write(enrolments / f"{name}.toml")
        department = DepartmentProcess(
            folder / "department", address, free_port(), launch_installed
        )
        department.start()
        try:
            department.get("/department")  # a first login takes its time
            with _simulated(enrolments, units) as simulation:
                return _observe(department, simulation, stations, units, seconds)
        finally:
            department.kill()


@contextmanager
def _simulated(enrolments: Path, units: int) -> Iterator[subprocess.Popen[bytes]]:
    """All stations in a program of their own, which prints what it sent at its end."""
    module = [sys.executable, "-m", "tests.rig.simulated_stations"]
    command = [*module, str(enrolments), str(units)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        try:
            yield process
        finally:
            process.kill()


def _observe(
    department: DepartmentProcess,
    simulation: subprocess.Popen[bytes],
    stations: int,
    units: int,
    seconds: float,
) -> DepartmentReport:
    """Raises BusError where the simulated stations fail."""
    wait_until(
        "all stations report",
        lambda: all(one["state"] == "live" for one in department.get("/department")["stations"]),
    )
    shown_ms: list[float] = []
    overview_ms: list[float] = []
    people_ms: list[float] = []
    last_sent_ms = 0.0
    began_s, began_cpu_s = time.monotonic(), department.cpu_s()
    pages_due_s = began_s
    while (now_s := time.monotonic()) < began_s + seconds and simulation.poll() is None:
        if now_s >= pages_due_s:  # as a page that is open does
            pages_due_s = now_s + _PAGES_EVERY_S
            overview_ms.append(_duration_ms(department, "/department"))
            people_ms.append(_duration_ms(department, f"/department/people?limit={_PEOPLE_PAGE}"))
        sent_ms = _newest_position_ms(department)
        if sent_ms > last_sent_ms:
            if last_sent_ms:
                shown_ms.append(clock_ms() - sent_ms)
            last_sent_ms = sent_ms
        time.sleep(_POLL_S)
    took_s = time.monotonic() - began_s
    cpu_share = (department.cpu_s() - began_cpu_s) / took_s
    memory_mb = department.memory_mb()
    assert simulation.stdin is not None
    assert simulation.stdout is not None
    simulation.stdin.close()
    printed = simulation.stdout.readline()
    if not printed:
        raise BusError("the simulated stations ended before their time")
    sent = msgspec.json.decode(printed, type=StationsReport)
    arrived = department.alarm_events()
    return DepartmentReport(
        stations=stations,
        units=units,
        summaries_hz=sent.summaries / sent.seconds,
        shown=latency_of(shown_ms),
        overview=latency_of(overview_ms),
        people=latency_of(people_ms),
        events_sent=sent.events,
        events_lost=sent.events - len(set(arrived)),
        events_repeated=len(arrived) - len(set(arrived)),
        cpu_share=cpu_share,
        memory_mb=memory_mb,
    )


def _newest_position_ms(department: DepartmentProcess) -> float:
    """Clock of ``clock_ms`` when one station sent what the API shows of it now."""
    page = department.get(f"/department/people?station={station_name(0)}&limit=1")
    return float(page["people"][0]["north_m"])


def _duration_ms(department: DepartmentProcess, path: str) -> float:
    began_s = time.monotonic()
    department.get(path)
    return (time.monotonic() - began_s) * 1000.0


def _table_of(report: DepartmentReport) -> Table:
    table = Table(title=f"{report.stations} stations of {report.units} units each")
    for name in ("", "p50 ms", "p99 ms", "max ms"):
        table.add_column(name, justify="right")
    for name, latency in (
        ("summary shown", report.shown),
        ("overview", report.overview),
        (f"{_PEOPLE_PAGE} people of all", report.people),
    ):
        table.add_row(
            name, f"{latency.p50_ms:.0f}", f"{latency.p99_ms:.0f}", f"{latency.max_ms:.0f}"
        )
    table.caption = (
        f"{report.summaries_hz:.0f} summaries/s; events: {report.events_sent} sent, "
        f"{report.events_lost} lost, {report.events_repeated} twice; "
        f"{100 * report.cpu_share:.0f} % of a core, {report.memory_mb:.0f} MB"
    )
    return table
