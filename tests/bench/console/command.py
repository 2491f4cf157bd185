"""``muster bench console``: bit rate and delay of consoles and browsers at a real station."""

from __future__ import annotations

import time
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import typer
from rich.console import Console as Terminal
from rich.table import Table

from shared.bench_figures import FiguresFile, write_figures
from tests.bench.console.page import PageReport, measure_page
from tests.rig.console_client import Console, watching
from tests.rig.latency import Latency, latencies_ms, latency_of
from tests.rig.paced_console import PacedConsole
from tests.rig.pacing import wait_until
from tests.rig.recorded_live import RecordedLive, Recorder
from tests.rig.simulated_units import BenchUnit, speaking, unit_names
from tests.rig.station_process import Membership, PlainTcp, StationProcess, station_process

_ANCHOR = {"lat_deg": 59.33, "lon_deg": 18.06, "height_m": 30.0}
_MESSAGES_HZ = 7.0  # of each unit: positions at 5 Hz, a status and a temperature
_SETTLE_S = 5.0
_KINDS = ((False, False), (False, True), (True, False), (True, True))  # fields, compressed


@dataclass(frozen=True, slots=True)
class WireReport:
    """Traffic to one console."""

    fields: bool  # changed fields, else whole units
    compressed: bool
    messages_hz: float
    mbit_s: float


@dataclass(frozen=True, slots=True)
class LoadReport:
    """A station with so many consoles."""

    consoles: int
    latency: Latency  # from sensor to WebSocket
    cpu_share: float  # of one core


@dataclass(frozen=True, slots=True)
class ConsoleReport:
    """Figures of one run."""

    units: int
    reached_hz: float  # messages of all units
    wire: list[WireReport]
    loads: list[LoadReport]
    pages: list[PageReport]


def bench_console(
    units: Annotated[int, typer.Option(min=1, help="Simulated units.")] = 200,
    consoles: Annotated[int, typer.Option(min=1, help="Consoles at once.")] = 50,
    seconds: Annotated[float, typer.Option(min=5.0, help="Duration of each measurement.")] = 30.0,
    slowed: Annotated[
        list[float] | None,
        typer.Option(
            min=1.0, help="How much slower the browser's processor is.", show_default="1 and 4"
        ),
    ] = None,
    plain: PlainTcp = False,
    json_file: FiguresFile = None,
) -> None:
    """Measure the bit rate of a console, the cost of many, and the delay of a slow browser.

    Units, station, consoles and browser share this machine.  At last the browser shows a recording
    of that, alone.
    """
    with TemporaryDirectory(prefix="muster-bench-") as folder, ExitStack() as closing:
        names = unit_names(units)
        members = Membership(Path(folder), names, plain=plain)
        station = closing.enter_context(station_process(Path(folder), members.address))
        speakers = [BenchUnit(name, members.endpoint_of(name), closing) for name in names]
        report = _measure(station, speakers, consoles, seconds, slowed or [1.0, 4.0])
    Terminal().print(_table(report))
    write_figures(json_file, report)


def _measure(
    station: StationProcess,
    units: list[BenchUnit],
    consoles: int,
    seconds: float,
    slowed: list[float],
) -> ConsoleReport:
    station.api.put("/site/anchor", _ANCHOR)
    for unit in units:
        station.api.post("/units", {"unit_id": unit.unit_id})
    station.api.post("/incidents", {"name": "Bench"})
    wait_until("the station listens", lambda: all(unit.is_received for unit in units))
    for unit in units:
        unit.introduce()
    began_s = time.perf_counter()
    with speaking(units, _MESSAGES_HZ):
        time.sleep(_SETTLE_S)
        wire = _measure_wire(station, seconds)
        loads = [_measure_load(station, units, count, seconds) for count in (1, consoles)]
        with ExitStack() as closing:
            recorder = Recorder(station.api, closing)
            pages = [measure_page(station.api, rate, seconds) for rate in slowed]
        spoken_s = time.perf_counter() - began_s
        sent = sum(unit.sent.messages for unit in units)
    with ExitStack() as closing:
        recorded = RecordedLive(recorder.recording, closing)
        pages += [measure_page(station.api, rate, seconds, recorded) for rate in slowed]
    return ConsoleReport(len(units), sent / spoken_s, wire, loads, pages)


def _measure_wire(station: StationProcess, seconds: float) -> list[WireReport]:
    with ExitStack() as closing:
        consoles = [
            PacedConsole(station.api, closing, fields=fields, compressed=compressed)
            for fields, compressed in _KINDS
        ]
        time.sleep(_SETTLE_S)  # pictures and trails come first
        before = [(one.messages, one.bytes_received) for one in consoles]
        time.sleep(seconds)
        reports = [
            WireReport(
                fields,
                compressed,
                (one.messages - messages) / seconds,
                (one.bytes_received - received) * 8e-6 / seconds,
            )
            for (fields, compressed), one, (messages, received) in zip(
                _KINDS, consoles, before, strict=True
            )
        ]
        for one in consoles:
            one.close()
    return reports


def _measure_load(
    station: StationProcess, units: list[BenchUnit], count: int, seconds: float
) -> LoadReport:
    """``count`` consoles, one of which looks when positions come."""
    with ExitStack() as closing:
        [watcher] = watching(station.api, 1, closing)
        others = [
            PacedConsole(station.api, closing, fields=True, compressed=True)
            for _ in range(count - 1)
        ]
        time.sleep(_SETTLE_S)
        sent = {unit.unit_id: len(unit.sent.position_times_ns) for unit in units}
        watcher.shown.clear()
        station.begin_measuring()
        time.sleep(seconds)
        share = station.cpu_share()
        latency = _latency(watcher, units, sent)
        watcher.close()
        for one in others:
            one.close()
    return LoadReport(count, latency, share)


def _latency(watcher: Console, units: list[BenchUnit], sent: dict[str, int]) -> Latency:
    times = {unit.unit_id: unit.sent.position_times_ns[sent[unit.unit_id] :] for unit in units}
    return latency_of(latencies_ms(times, {one: dict(seen) for one, seen in watcher.shown.items()}))


def _table(report: ConsoleReport) -> Table:
    table = Table(
        title=f"{report.units} units at 5 Hz; {report.reached_hz:,.0f} messages a second in all",
        caption="Units, station, consoles and browser share a machine; a page alone has no units.",
    )
    table.add_column("")
    table.add_column("measured", justify="right")
    table.add_column("to reach", justify="right")
    for one in report.wire:
        what = "changed fields" if one.fields else "whole units"
        how = "compressed" if one.compressed else "as text"
        goal = "1 Mbit/s" if one.fields and one.compressed else ""
        table.add_row(
            f"a console, {what}, {how}",
            f"{one.mbit_s:.2f} Mbit/s at {one.messages_hz:.1f} messages/s",
            goal,
        )
    for load in report.loads:
        table.add_row(
            f"sensor to WebSocket with {load.consoles} consoles, p50 / p99",
            f"{load.latency.p50_ms:.0f} / {load.latency.p99_ms:.0f} ms",
            "p99 stays" if load.consoles > 1 else "",
        )
        table.add_row("the station meanwhile, of one core", f"{load.cpu_share:.0%}", "")
    for page in report.pages:
        browser = f"{'page alone' if page.is_alone else 'browser'}, slowed {page.slowed:g} times"
        table.add_row(
            f"{browser}: shown",
            f"{page.shown_hz:.1f} /s",
            "20 /s" if page.slowed == 1.0 else "",
        )
        table.add_row(
            f"{browser}: age of what is shown, p50 / p95 / most",
            f"{page.age_p50_ms:.0f} / {page.age_p95_ms:.0f} / {page.age_max_ms:.0f} ms",
            "1,000 ms" if page.slowed > 1.0 else "",
        )
        table.add_row(
            f"{browser}: a press, p50 / p95 of {page.presses}",
            f"{page.press_p50_ms:.0f} / {page.press_p95_ms:.0f} ms",
            "200 ms" if page.slowed > 1.0 else "100 ms",
        )
        work = page.work
        table.add_row(
            f"{browser}: work of its main thread, script / style and layout / all",
            f"{work.script_ms:.0f} / {work.style_and_layout_ms:.0f} / {work.all_ms:.0f} ms/s",
            "",
        )
    return table
