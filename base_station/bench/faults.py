"""``muster bench faults``: a station and a unit whose radio is bad, and what of it is lost.

Both run as they would in earnest, with certificates, in network namespaces of their own; between
them is the link of ``base_station.bench.lossy_link``.
"""

from __future__ import annotations

import json
import sqlite3
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, NamedTuple

import typer
from rich.console import Console as Terminal
from rich.progress import Progress
from rich.table import Table

from base_station.bench.forwarder import Conditions
from base_station.bench.lossy_link import CLEAN, DARK, LossyLink
from base_station.bench.station import StationProcess, station_process
from base_station.pki.folder import PkiFolder
from shared.channels import Direction, Qos, is_backfilled, parse_key
from shared.clock import NS_PER_S
from shared.codec import decode
from shared.errors import BusError
from shared.mcap_log import read_log

UNIT = "anna"
_PORT = 7447
_START_PATIENCE_S = 200.0  # the first agent on a machine compiles its tracker
_LOOK_EVERY_S = 0.5
_BEFORE_S = 2.0  # of a good link
_RECONNECT_S = 3.0  # to reach

MessageId = tuple[int, int]  # boot id, sequence number


class Fault(NamedTuple):
    name: str
    link: Conditions  # both ways
    seconds: float
    after: Conditions = CLEAN  # from then on, until all that was said has arrived
    slow: bool = False  # takes a minute and more with the catching up


THIN = Conditions(delay_s=0.05, rate_bps=20_000.0)
FAULTS = (
    Fault("40 % loss, 300 ms jitter", Conditions(loss=0.4, jitter_s=0.3), 20.0),
    Fault("outage of 1 s", DARK, 1.0),
    Fault("outage of 30 s", DARK, 30.0),
    Fault("20 kbit/s", THIN, 10.0, after=THIN),
    Fault("outage of 30 s at 20 kbit/s", DARK, 30.0, after=THIN, slow=True),
    Fault("outage of 600 s", DARK, 600.0, slow=True),
)


@dataclass(frozen=True, slots=True)
class FaultReport:
    """One row.  Times are of the one clock that both ends share here."""

    fault: str
    seconds: float
    sent: int  # put into the unit's journal from before the fault until after it
    arrived: int
    lost: int
    duplicates: int  # messages that are more than once in the log
    fetched: int  # of those that arrived, from the journal
    heard_s: float | None  # from the link's return to the first message that came live
    complete_s: float | None  # from the link's return until all said before it is in the log
    alerts: int
    alert_worst_s: float | None  # from being said to being in the log
    memory_mb: float  # of the station with its router


def bench_faults(
    longest: Annotated[
        float, typer.Option(min=1.0, help="Leave out faults of more than so many seconds.")
    ] = 600.0,
    patience: Annotated[
        float, typer.Option(help="How long to wait, after a fault, for the rest to arrive.")
    ] = 180.0,
    seed: Annotated[int, typer.Option(help="Of the link's luck.")] = 1,
    json_file: Annotated[
        Path | None, typer.Option("--json", help="Also write the figures to this file.")
    ] = None,
) -> None:
    """What a bad radio link loses, doubles and delays.  Needs to be root, on Linux."""
    faults = [fault for fault in FAULTS if fault.seconds <= longest]
    with Progress(transient=True) as progress:
        reports = measure(faults, patience, seed, progress)
    Terminal().print(_table(reports))
    if json_file is not None:
        rows = [asdict(report) for report in reports]
        json_file.write_text(json.dumps(rows, indent=2) + "\n", encoding="utf-8")


def measure(
    faults: Sequence[Fault], patience_s: float, seed: int, progress: Progress
) -> list[FaultReport]:
    """One row a fault, one after the other with the same station and unit.

    Raises BusError where network namespaces are not allowed, or when the unit is never heard.
    """
    with (
        TemporaryDirectory(prefix="muster-bench-") as folder,
        ExitStack() as closing_all,
        site(Path(folder), seed, closing_all) as one,
    ):
        task = progress.add_task("", total=sum(fault.seconds for fault in faults))
        reports = []
        for fault in faults:
            progress.update(task, description=fault.name)
            reports.append(one.suffer(fault, patience_s))
            progress.advance(task, fault.seconds)
        return reports


class Site:
    """A station and a unit that are at it already."""

    def __init__(self, data: Path, journal: Path, link: LossyLink, station: StationProcess) -> None:
        self._log = data / "log"
        self._journal = journal
        self._link = link
        self._station = station

    def wait_heard(self, patience_s: float) -> None:
        end_s = time.monotonic() + patience_s
        while not any(record.live for record in self._logged()):
            if time.monotonic() > end_s:
                raise BusError("the unit to be measured is not heard")
            time.sleep(_LOOK_EVERY_S)

    def suffer(self, fault: Fault, patience_s: float) -> FaultReport:
        before = self._said()
        self._ask_par()  # the wearer answers some seconds later, so when the link is bad
        time.sleep(_BEFORE_S)
        self._link.set(fault.link)
        self._ask_par()
        time.sleep(fault.seconds)
        self._link.set(fault.after)
        back_ns, said_then = time.time_ns(), self._said()
        self._wait_logged(said_then, patience_s)
        memory_mb = self._station.memory_mb()
        self._link.set(CLEAN)
        said = self._said()
        self._wait_logged(said, patience_s)
        return self._report(fault, said - before, said_then - before, back_ns, memory_mb)

    def _ask_par(self) -> None:
        """Its answers are alerts."""
        order = {"kind": "par_request", "target": {"unit_id": UNIT}, "expires_s": 900}
        self._link.station.call(lambda: self._station.api.post("/commands", order))

    def _report(
        self,
        fault: Fault,
        said: set[MessageId],
        said_before_return: set[MessageId],
        back_ns: int,
        memory_mb: float,
    ) -> FaultReport:
        records = [record for record in self._logged() if record.message in said]
        arrived_ns = {record.message: record.t_ns for record in reversed(records)}
        heard_ns = [r.t_ns for r in records if r.live and r.t_ns > back_ns]
        complete = said_before_return <= arrived_ns.keys()
        complete_ns = max(arrived_ns[one] for one in said_before_return) if complete else None
        alerts_s = [(r.t_ns - r.said_ns) / NS_PER_S for r in records if r.alert]
        return FaultReport(
            fault=fault.name,
            seconds=fault.seconds,
            sent=len(said),
            arrived=len(arrived_ns),
            lost=len(said) - len(arrived_ns),
            duplicates=len(records) - len(arrived_ns),
            fetched=sum(not record.live for record in records),
            heard_s=(min(heard_ns) - back_ns) / NS_PER_S if heard_ns else None,
            complete_s=None
            if complete_ns is None
            else max(0.0, (complete_ns - back_ns) / NS_PER_S),
            alerts=len(alerts_s),
            alert_worst_s=max(alerts_s, default=None),
            memory_mb=memory_mb,
        )

    def _wait_logged(self, wanted: set[MessageId], patience_s: float) -> None:
        """Or until the patience is over; what is missing then is lost."""
        end_s = time.monotonic() + patience_s
        while time.monotonic() < end_s:
            if wanted <= {record.message for record in self._logged()}:
                return
            time.sleep(_LOOK_EVERY_S)

    def _said(self) -> set[MessageId]:
        """What the unit has ever said, by its journal."""
        with closing(sqlite3.connect(f"file:{self._journal}?mode=ro", uri=True)) as journal:
            rows = journal.execute(
                "SELECT boot_id, seq FROM message JOIN boot ON boot.number = message.boot"
            ).fetchall()
        return {(boot_id % 2**64, seq) for boot_id, seq in rows}

    def _logged(self) -> Iterator[_Record]:
        for t_ns, key, payload in read_log(self._log):
            unit_id, channel = parse_key(key)
            if unit_id != UNIT or channel.direction is not Direction.UP:
                continue
            header = decode(channel, payload).header
            yield _Record(
                message=(header.boot_id, header.seq),
                t_ns=t_ns,
                said_ns=header.t_utc_ns,
                live=not is_backfilled(key),
                alert=channel.qos is Qos.ALERT,
            )


class _Record(NamedTuple):
    message: MessageId
    t_ns: int  # when the station wrote it
    said_ns: int
    live: bool
    alert: bool


@contextmanager
def site(folder: Path, seed: int, closing_all: ExitStack) -> Iterator[Site]:
    """Station and unit, each in its namespace and linked; ended hard."""
    link = LossyLink(seed, closing_all)
    data, enrolment = folder / "station", folder / "unit.toml"
    data.mkdir()
    address = f"tls/{link.station.address}:{_PORT}"
    pki = PkiFolder(data)
    pki.create("bench", hosts=[link.station.address], connect=[address])
    pki.enroll(UNIT).write(enrolment)
    station = closing_all.enter_context(station_process(data, address, link.station.inside()))
    agent = ["from edge.cli import app; app()", "run", "--enrolment", str(enrolment)]
    agent += ["--source", "simulated:search-ground-floor", "--data", str(folder / "units")]
    said = closing_all.enter_context((folder / "unit.txt").open("wb"))
    command = [*link.units.inside(), sys.executable, "-c", *agent]
    with subprocess.Popen(command, stdout=said, stderr=said) as process:
        try:
            one = Site(data, folder / "units" / UNIT / "journal.sqlite", link, station)
            one.wait_heard(_START_PATIENCE_S)
            yield one
        finally:
            process.kill()


def _table(reports: Sequence[FaultReport]) -> Table:
    table = Table(
        title="Bad links",
        caption="heard: from the link's return to the first live message, to reach "
        f"{_RECONNECT_S:.0f} s; complete: until all said before is in the log; alert: the "
        "worst, from being said to being in the log; memory: the station's. "
        "Lost and twice: to reach 0.",
    )
    titles = ("sent", "arrived", "lost", "twice", "fetched", "heard", "complete", "alert")
    table.add_column("fault")
    for title in (*titles, "memory"):
        table.add_column(title, justify="right", min_width=min(len(title), 8))
    for one in reports:
        counts = (one.sent, one.arrived, one.lost, one.duplicates, one.fetched)
        times_s = (one.heard_s, one.complete_s, one.alert_worst_s)
        table.add_row(
            one.fault,
            *(f"{count:,}" for count in counts),
            *("never" if time_s is None else f"{time_s:.1f} s" for time_s in times_s),
            f"{one.memory_mb:.0f} MB",
        )
    return table
