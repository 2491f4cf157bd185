"""``muster bench standby``: time until the standby leads, and records that its log lacks."""

from __future__ import annotations

import random
import time
from collections.abc import Callable
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import typer
from rich.console import Console as Terminal
from rich.progress import Progress
from rich.table import Table

from shared.bench_figures import FiguresFile, write_figures
from shared.errors import BusError, StoreError
from tests.bench.standby.long_log import measure_long_log, table_of
from tests.bench.standby.station_of_pair import Place, Station
from tests.bench.standby.two_stations import TwoStations
from tests.rig.lossy_link import CLEAN, DARK, LossyLink
from tests.rig.pacing import wait_until

_TAKE_OVER_S = 5.0  # to reach
_BEFORE_S = 5.0  # of both being well
_BETWEEN_S = 5.0  # of one being away
_ROUNDS = 5  # of killing both


@dataclass(frozen=True, slots=True)
class StandbyReport:
    """One row: what became of a fault of the station that led."""

    fault: str
    take_over_s: float  # from the fault until the other says that it leads
    back_s: float  # from the first one's return until it has everything
    back_cpu_s: float  # of that one's processor time, children included: starting costs most of it
    stated: int  # messages that the units have put into their journals
    lost: tuple[int, int]  # of these, not in the log of the first and of the second
    duplicates: tuple[int, int]
    same_logs: bool  # one is the beginning of the other, event for event


def bench_standby(
    units: Annotated[int, typer.Option(min=2, max=20, help="Simulated units.")] = 4,
    minutes: Annotated[
        float, typer.Option(min=0.0, help="Length of the log that a new standby fetches; 0: skip.")
    ] = 60.0,
    walkers: Annotated[int, typer.Option(min=1, help="Units in that log.")] = 20,
    json_file: FiguresFile = None,
) -> None:
    """Measure take-overs after a kill, a stop and a cut link (as root, on Linux), and the start of
    a new standby beside a long log.
    """
    terminal = Terminal()
    reports = []
    faults = (
        ("kill -9", _kill),
        ("stopped in order", _stop),
        ("kill -9 of both", kill_both),
        ("cable cut", _cut),
    )
    with Progress(transient=True) as progress:
        for name, fault in progress.track(faults, description="two stations"):
            with TemporaryDirectory(prefix="muster-bench-") as folder, ExitStack() as closing:
                try:
                    reports.append(fault(name, Path(folder), units, closing))
                except BusError as error:
                    terminal.print(f"{name}: left out: {error}")
        terminal.print(_table(reports))
        long_logs = []
        if minutes > 0.0:
            with TemporaryDirectory(prefix="muster-bench-") as folder:
                long_logs.append(measure_long_log(Path(folder), walkers, minutes, progress))
            terminal.print(table_of(long_logs[0]))
    write_figures(json_file, [*reports, *long_logs])


def _kill(name: str, folder: Path, units: int, closing: ExitStack) -> StandbyReport:
    two = _running(folder, (Place(), Place()), units, closing)
    return _suffer(name, two, two.first.kill, two.first.start)


def _stop(name: str, folder: Path, units: int, closing: ExitStack) -> StandbyReport:
    two = _running(folder, (Place(), Place()), units, closing)
    return _suffer(name, two, two.first.stop, two.first.start)


def _cut(name: str, folder: Path, units: int, closing: ExitStack) -> StandbyReport:
    """Half of the units stay with each."""
    link = LossyLink(1, closing)
    places = (Place(link.station.address, link.station), Place(link.units.address, link.units))
    two = _running(folder, places, units, closing)
    return _suffer(name, two, lambda: link.set(DARK), lambda: link.set(CLEAN))


def _running(
    folder: Path, places: tuple[Place, Place], units: int, closing: ExitStack
) -> TwoStations:
    two = TwoStations(folder, places, closing)
    two.start()
    for number in range(units):
        two.start_unit(f"unit-{number}", two.both[number % 2])
    two.wait_received(two.first)
    time.sleep(_BEFORE_S)
    return two


def _suffer(
    name: str, two: TwoStations, fault: Callable[[], object], mend: Callable[[], object]
) -> StandbyReport:
    began_s = time.monotonic()
    fault()
    wait_until("the second leads", two.second.leads)
    take_over_s = time.monotonic() - began_s
    time.sleep(_BETWEEN_S)
    began_s, before_cpu_s = time.monotonic(), two.first.cpu_s()
    mend()
    wait_until("the first follows", two.first.follows)
    back_s, back_cpu_s = time.monotonic() - began_s, two.first.cpu_s() - before_cpu_s
    return _compared(name, two, take_over_s, back_s, back_cpu_s)


def kill_both(
    name: str, folder: Path, units: int, closing: ExitStack, rounds: int = _ROUNDS
) -> StandbyReport:
    """Both, at random instants, started again in any order; times of the worst round."""
    two = _running(folder, (Place(), Place()), units, closing)
    chance = random.Random(name)  # no secret
    worst_s = [0.0, 0.0, 0.0]
    for _ in range(rounds):
        time.sleep(_BEFORE_S * chance.random())
        _in_any_order(two, chance, Station.kill)
        began_s = time.monotonic()
        _in_any_order(two, chance, Station.start)
        wait_until("one leads", lambda: two.first.leads() or two.second.leads())
        lead_s = time.monotonic() - began_s
        wait_until("the other follows", two.leader)
        back_s = time.monotonic() - began_s
        costs_s = (lead_s, back_s, max(one.cpu_s() for one in two.both))
        worst_s = [max(pair) for pair in zip(worst_s, costs_s, strict=True)]
    return _compared(name, two, *worst_s)


def _in_any_order(two: TwoStations, chance: random.Random, do: Callable[[Station], None]) -> None:
    for one in chance.sample(two.both, 2):
        do(one)
        time.sleep(chance.random())


def _compared(
    name: str, two: TwoStations, take_over_s: float, back_s: float, back_cpu_s: float
) -> StandbyReport:
    """Both are ended: the one that follows first, so that its log is the beginning of the other."""
    stated = two.output()
    with suppress(StoreError):  # what has not come by then is lost
        wait_until("both have everything", lambda: two.both_have(stated))
    two.stop_units()
    follows, leads = two.both[::-1] if two.first.leads() else two.both
    follows.stop()
    leads.stop()
    one, other = (station.logged() for station in two.both)
    short, long = follows.logged(), leads.logged()
    return StandbyReport(
        fault=name,
        take_over_s=take_over_s,
        back_s=back_s,
        back_cpu_s=back_cpu_s,
        stated=len(stated),
        lost=(len(stated - one.messages.keys()), len(stated - other.messages.keys())),
        duplicates=(one.duplicates, other.duplicates),
        same_logs=short.events == long.events[: len(short.events)],
    )


def _table(reports: list[StandbyReport]) -> Table:
    table = Table(
        title="Two stations",
        caption=f"take-over: from the fault until the other leads, to reach {_TAKE_OVER_S:.0f} s; "
        "back: from the first one's return until it has everything, and what that costs it of a "
        "processor; of both: from the return of both, the worst round. Lost and twice, in the log "
        "of the first and of the second: to reach 0.",
    )
    table.add_column("fault")
    for title in ("take-over", "back", "CPU", "said", "lost", "twice", "same logs"):
        table.add_column(title, justify="right")
    for one in reports:
        table.add_row(
            one.fault,
            f"{one.take_over_s:.1f} s",
            f"{one.back_s:.1f} s",
            f"{one.back_cpu_s:.1f} s",
            f"{one.stated:,}",
            f"{one.lost[0]} / {one.lost[1]}",
            f"{one.duplicates[0]} / {one.duplicates[1]}",
            "yes" if one.same_logs else "NO",
        )
    return table
