"""``muster bench department-faults``: faults between three stations and their department: losses,
and the time until they are made up for.

All have certificates and networks of their own; between them are the links of
``tests.rig.lossy_link``.  The tables of the department are on a PostgreSQL server.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, Any

import typer
from rich.console import Console as Terminal
from rich.table import Table

from base_station.security.pki.folder import PkiFolder
from shared.bench_figures import FiguresFile, write_figures
from tests.rig.database_server import DatabaseServer, database_server
from tests.rig.department_network import DepartmentNetwork, ReportingStation
from tests.rig.latency import Latency
from tests.rig.link_forwarder import Conditions
from tests.rig.lossy_link import CLEAN, DARK
from tests.rig.pacing import wait_until
from tests.rig.program import Launch, launch_installed

LOSSY = Conditions(loss=0.2, delay_s=0.015)
AHEAD_S = 3 * 3600  # of the clock of one station
_AHEAD = f"""
import time
utc_ns, utc_s = time.time_ns, time.time
time.time_ns, time.time = lambda: utc_ns() + {AHEAD_S} * 10**9, lambda: utc_s() + {AHEAD_S}
""".strip()
_SEED = 33
_SETTLE_S = 1.0


@dataclass(frozen=True, slots=True)
class FaultRow:
    """Decisions of all stations from the fault's beginning until all of it had arrived."""

    fault: str
    seconds: float
    sent: int  # transitions of alarms
    arrived: int
    lost: int
    twice: int
    recovery_s: float  # from the fault's end until all that had been decided is there
    station: Latency  # sensor to console at the first station, meanwhile
    memory_mb: float  # of the department with its router


class Faults:
    """Three stations that work, and what is done to them; each method returns when it is over."""

    def __init__(
        self, folder: Path, closing: ExitStack, launch: Launch, server: DatabaseServer
    ) -> None:
        self.server = server
        address = server.new_database(folder)
        settings = folder / "department.toml"
        settings.write_text(
            f'database = "{address.url}"\ndatabase_password_file = "{address.password_file}"\n'
        )
        self._folder = folder
        self.roof = DepartmentNetwork(folder, closing, launch, _SEED, settings)
        self.strangers: list[ReportingStation] = []  # of another department
        for name, before in (("engine-7", ""), ("engine-8", ""), ("engine-9", _AHEAD)):
            self.roof.add_station(name).start(before)

    def view(self) -> Any:
        return self.roof.department.get("/department")

    def wait_problem(self, words: str) -> None:
        wait_until(
            f"the department says: {words}",
            lambda: any(words in one for one in self.view()["problems"]),
        )

    def start_department(self, seconds: float) -> None:
        time.sleep(seconds)  # the stations work before there is one
        self.roof.department.start()

    def lose_packets(self, seconds: float) -> None:
        for station in self.roof.stations:
            station.link.set(LOSSY)
        time.sleep(seconds)
        for station in self.roof.stations:
            station.link.set(CLEAN)

    def cut_off(self, seconds: float) -> None:
        """The second station; the others report as before."""
        link = self.roof.stations[1].link
        link.set(DARK)
        time.sleep(seconds)
        link.set(CLEAN)

    def kill_department(self, seconds: float) -> None:
        self.roof.department.kill()
        time.sleep(seconds)
        self.roof.department.start()

    def kill_database(self, seconds: float) -> None:
        before_ms = self._last_ms()
        self.server.kill()
        try:
            self.wait_problem("database server does not answer")
            wait_until("the picture goes on", lambda: self._last_ms() > before_ms + 1000)
            time.sleep(seconds)
        finally:
            self.server.start()

    def kill_station(self, seconds: float) -> None:
        station = self.roof.stations[1]
        station.kill()
        time.sleep(min(seconds, 5.0))
        station.start()

    def give_a_name_twice(self, seconds: float) -> None:
        """Another machine with the enrolment of the second station; its events count as well."""
        first = self.roof.stations[1]
        enrolment = self._folder / "city-engine-8.toml"
        second = self.roof.place_station("copy", enrolment, first.link, number=1)
        second.start()
        self.wait_problem("Several machines report as engine-8")
        time.sleep(seconds)
        second.quieten()
        self.roof.stations.append(second)

    def try_another_certificate(self, seconds: float) -> None:
        """A station of the first one's name, by another authority."""
        county = PkiFolder(self._folder / "county")
        county.create("County", hosts=[], connect=[self.roof.address])
        enrolment = self.roof.enrol("engine-7", county)
        link = self.roof.stations[0].link
        stranger = self.roof.place_station("stranger", enrolment, link, number=1)
        stranger.start()
        time.sleep(seconds)  # it tries once a second
        self.strangers.append(stranger)
        stranger.quieten()

    def suffer(self, fault: str, happen: Callable[[float], None], seconds: float) -> FaultRow:
        roof = self.roof
        before = roof.decided()
        roof.stations[0].forget_latency()
        happen(seconds)
        recovery_s = roof.recovery_s()
        decided = roof.decided() - before
        station = roof.stations[0].latency()
        roof.recovery_s()  # of what was decided since
        arrived = [one for one in roof.department.alarm_events() if one in decided]
        return FaultRow(
            fault=fault,
            seconds=seconds,
            sent=len(decided),
            arrived=len(arrived),
            lost=len(decided - set(arrived)),
            twice=len(arrived) - len(set(arrived)),
            recovery_s=recovery_s,
            station=station,
            memory_mb=roof.department.memory_mb(),
        )

    def end(self) -> None:
        """Nobody decides any more, and all is handed over."""
        for station in self.roof.stations:
            station.quieten()
        time.sleep(_SETTLE_S)
        self.roof.recovery_s()

    def _last_ms(self) -> int:
        return int(self.view()["stations"][0]["last_ms"])


def suffer_all(faults: Faults, seconds: float, cut_s: float) -> list[FaultRow]:
    return [
        faults.suffer(name, happen, cut_s if happen == faults.cut_off else seconds)
        for name, happen in (
            ("the department starts after its stations", faults.start_department),
            ("nothing", time.sleep),
            ("20 % of packets lost each way", faults.lose_packets),
            ("one station cut off", faults.cut_off),
            ("department killed, with its router", faults.kill_department),
            ("PostgreSQL killed", faults.kill_database),
            ("station killed and started", faults.kill_station),
            ("certificate of another department", faults.try_another_certificate),
            ("two stations with one name", faults.give_a_name_twice),
        )
    ]


def bench_department_faults(
    seconds: Annotated[float, typer.Option(min=1.0, help="Duration of each fault.")] = 10.0,
    cut_s: Annotated[float, typer.Option(min=1.0, help="Duration of the long cut.")] = 600.0,
    json_file: FiguresFile = None,
) -> None:
    """Measure the loss, repeats and delay of faults between three stations and their department.

    Needs to be root, on Linux, and a PostgreSQL server that is installed.
    """
    with (
        TemporaryDirectory(prefix="muster-bench-") as folder,
        database_server() as server,
        ExitStack() as closing,
    ):
        faults = Faults(Path(folder), closing, launch_installed, server)
        rows = suffer_all(faults, seconds, cut_s)
    Terminal().print(_table_of(rows))
    write_figures(json_file, rows)


def _table_of(rows: list[FaultRow]) -> Table:
    table = Table(title="Three stations and their department", show_lines=False)
    names = ("s", "sent", "arrived", "lost", "twice", "recovery s", "station p99 ms", "MB")
    for name in ("fault", *names):
        table.add_column(name, justify="left" if name == "fault" else "right")
    for row in rows:
        table.add_row(
            row.fault,
            f"{row.seconds:.0f}",
            *(str(one) for one in (row.sent, row.arrived, row.lost, row.twice)),
            f"{row.recovery_s:.1f}",
            f"{row.station.p99_ms:.0f}",
            f"{row.memory_mb:.0f}",
        )
    return table
