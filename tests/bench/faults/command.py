"""``muster bench faults``: losses of a station and a unit under faults.

Both run as they would in earnest, with certificates, in network namespaces of their own; between
them is the link of ``tests.rig.lossy_link``.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import typer
from rich.box import SIMPLE
from rich.console import Console as Terminal
from rich.progress import Progress
from rich.table import Table

from shared.bench_figures import FiguresFile, write_figures
from shared.clock import NS_PER_S
from shared.errors import UserError
from tests.bench.faults.fault_scenarios import FAULTS, Fault
from tests.bench.faults.site import Site, site
from tests.rig.lossy_link import CLEAN
from tests.rig.unit_journal import MessageOfUnit

_BEFORE_S = 2.0  # of a good link
_RECONNECT_S = 3.0  # to reach


@dataclass(frozen=True, slots=True)
class FaultReport:
    """One row.  Times are of the one clock that both ends share here."""

    fault: str
    seconds: float
    sent: int  # put into the unit's journal from before the fault until after it
    arrived: int
    lost: int
    duplicates: int  # messages that are more than once in the log
    forged: int  # messages in the log of somebody who may not say them
    fetched: int  # of those that arrived, from the journal
    received_s: float | None  # from the fault's end to the first message that came live
    complete_s: float | None  # from the fault's end until all said before it is in the log
    alerts: int
    alert_worst_s: float | None  # from being said, or from the fault's end where that is later
    memory_mb: float  # of the station with its router


def bench_faults(
    longest: Annotated[
        float, typer.Option(min=1.0, help="Longest fault; longer ones are skipped.")
    ] = 60.0,
    only: Annotated[str, typer.Option(help="Only faults with these words in their name.")] = "",
    patience: Annotated[
        float, typer.Option(help="Longest wait after a fault for late messages.")
    ] = 180.0,
    times: Annotated[int, typer.Option(min=1, help="Repeats of each fault.")] = 1,
    seed: Annotated[int, typer.Option(help="Seed of the link's losses.")] = 1,
    json_file: FiguresFile = None,
) -> None:
    """Measure losses, repeats and delays by bad links, kills, clones, clocks and full disks.

    Needs to be root, on Linux.  With `--longest 600` the outage of ten minutes is among them.
    """
    faults = [fault for fault in FAULTS if fault.seconds <= longest and only in fault.name]
    if not faults:
        known = ", ".join(fault.name for fault in FAULTS)
        raise UserError(f"no fault is left to be measured; there are: {known}")
    with Progress(transient=True) as progress:
        reports = measure(faults * times, patience, seed, progress)
    Terminal().print(table_of(reports))
    write_figures(json_file, reports)


def measure(
    faults: Sequence[Fault], patience_s: float, seed: int, progress: Progress
) -> list[FaultReport]:
    """One row a fault, one after the other with the same station and unit.

    Raises BusError where network namespaces are not allowed, or when the unit is never heard.
    """
    with (
        TemporaryDirectory(prefix="muster-bench-") as folder,
        site(Path(folder), seed) as one,
    ):
        task = progress.add_task("", total=sum(fault.seconds for fault in faults))
        reports = []
        for fault in faults:
            progress.update(task, description=fault.name)
            reports.append(suffer(one, fault, patience_s))
            progress.advance(task, fault.seconds)
        return reports


def suffer(one: Site, fault: Fault, patience_s: float) -> FaultReport:
    """Let a fault happen, wait for the rest to arrive, and count."""
    before = one.output()
    one.ask_par()  # the wearer answers some seconds later, so when it is bad
    time.sleep(_BEFORE_S)
    fault.happen(one)
    one.link.set(fault.after)
    over_ns, stated_then = time.time_ns(), one.output()
    one.wait_logged(stated_then, patience_s)
    one.wait_received(patience_s, over_ns)
    memory_mb = one.station.memory_mb()
    one.link.set(CLEAN)
    stated = one.output()
    one.wait_logged(stated, patience_s)
    return _report(one, fault, before, stated, stated_then, over_ns, memory_mb)


def _report(
    one: Site,
    fault: Fault,
    before: set[MessageOfUnit],
    stated: set[MessageOfUnit],
    stated_before_end: set[MessageOfUnit],
    over_ns: int,
    memory_mb: float,
) -> FaultReport:
    """Messages of ``before`` must still be there; else they were lost now."""
    logged = list(one.logged())
    arrived_ns = {record.message: record.t_ns for record in reversed(logged)}
    sent = stated - before
    records = [record for record in logged if record.message in sent]
    received_ns = [r.t_ns for r in records if r.live and r.t_ns > over_ns]
    complete = stated_before_end <= arrived_ns.keys()
    complete_ns = max(arrived_ns[one] for one in stated_before_end) if complete else None
    alerts_s = [
        (r.t_ns - (max(r.sent_ns, over_ns) if r.t_ns > over_ns else r.sent_ns)) / NS_PER_S
        for r in records
        if r.alert
    ]
    return FaultReport(
        fault=fault.name,
        seconds=fault.seconds,
        sent=len(sent),
        arrived=len(sent & arrived_ns.keys()),
        lost=len(stated - arrived_ns.keys()),
        duplicates=len(logged) - len(arrived_ns),
        forged=one.forged(),
        fetched=sum(not record.live for record in records),
        received_s=(min(received_ns) - over_ns) / NS_PER_S if received_ns else None,
        complete_s=None if complete_ns is None else max(0.0, (complete_ns - over_ns) / NS_PER_S),
        alerts=len(alerts_s),
        alert_worst_s=max(alerts_s, default=None),
        memory_mb=memory_mb,
    )


def table_of(reports: Sequence[FaultReport]) -> Table:
    table = Table(
        title="Faults",
        box=SIMPLE,
        padding=0,
        caption="In seconds: received, from the fault's end to the first live message, to reach "
        f"{_RECONNECT_S:.0f}; whole, until all sent before is in the log; alert, the worst from "
        "being sent, or from the fault's end, to being in the log. MB: the station's memory. "
        "Lost, twice and forged: to reach 0.",
    )
    titles = ("sent", "arrived", "lost", "twice", "forged", "fetched", "received", "whole", "alert")
    table.add_column("fault", min_width=16)
    for title in (*titles, "MB"):
        table.add_column(title, justify="right", no_wrap=True)
    for one in reports:
        counts = (one.sent, one.arrived, one.lost, one.duplicates, one.forged, one.fetched)
        times_s = (one.received_s, one.complete_s, one.alert_worst_s)
        table.add_row(
            one.fault,
            *(f"{count:,}" for count in counts),
            *("never" if time_s is None else f"{time_s:.1f}" for time_s in times_s),
            f"{one.memory_mb:.0f}",
        )
    return table
