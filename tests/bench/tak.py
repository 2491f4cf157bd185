"""``muster bench tak``: delay of positions in TAK, over a real station and TAK server."""

from __future__ import annotations

import time
from contextlib import ExitStack
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import psutil
import typer
from rich.console import Console as Terminal
from rich.table import Table

from base_station.forwarders.tak.cot import PERSON
from shared.bench_figures import FiguresFile, write_figures
from shared.bus_zenoh import ZenohBus
from shared.channels import channel_of
from shared.clock import NS_PER_MS, SystemClock
from shared.codec import encode
from tests.rig.latency import Latency, latency_of
from tests.rig.pacing import paced, wait_until
from tests.rig.simulated_units import Wearer, unit_names
from tests.rig.station_process import Membership, StationProcess, station_process
from tests.rig.tak_server import ReceivedEvent, TakClient, TakServer

_POSITIONS_SHARE = 5 / 7  # of what a simulated wearer's unit sends
_SETTLE_S = 3.0
_ANCHOR = {"lat_deg": 52.5, "lon_deg": 13.4, "height_m": 40.0}


@dataclass(frozen=True, slots=True)
class TakReport:
    """Figures of one run."""

    people: int
    positions_hz: float  # of each person
    arrived_hz: float  # positions of all people
    latency: Latency  # from the time to which a position belongs to the TAK client
    latency_at_start: Latency  # of the first position of each, when all units appear at once
    people_arrived: int
    cpu_share: float  # of one core, all of the station
    idle_share: float  # of all cores; close to 0 the figures are those of a machine with other work


def bench_tak(
    people: Annotated[int, typer.Option(min=1, help="People with units.")] = 500,
    rate: Annotated[float, typer.Option(min=0.1, help="Positions a second of each unit.")] = 1.0,
    seconds: Annotated[float, typer.Option(min=2.0, help="Duration of the walks.")] = 30.0,
    json_file: FiguresFile = None,
) -> None:
    """Measure the latency from a position to a TAK client, over a station and a TAK server
    (taky).
    """
    report = measure(people, rate, seconds)
    Terminal().print(_table_of(report))
    write_figures(json_file, report)


def measure(people: int, rate_hz: float, seconds: float) -> TakReport:
    with TemporaryDirectory(prefix="muster-bench-") as folder, ExitStack() as closing:
        data = Path(folder)
        server = closing.enter_context(TakServer(data / "tak"))
        client = closing.enter_context(TakClient(server.port))
        settings = data / "station.toml"
        # Twice as often as positions come: each is forwarded, and none waits for its turn.
        every = f"every_s = {max(0.5 / rate_hz, 0.2)}"
        settings.write_text(f'[tak.bench]\nurl = "{server.url}"\n{every}\n')
        members = Membership(data, (), plain=True)
        station = closing.enter_context(station_process(data, members.address, settings=settings))
        bus = ZenohBus(members.endpoint_of("bench"))
        closing.callback(bus.close)
        return _run(station, bus, client, people, rate_hz, seconds)


def _run(
    station: StationProcess,
    bus: ZenohBus,
    client: TakClient,
    people: int,
    rate_hz: float,
    seconds: float,
) -> TakReport:
    wearers = [Wearer(name, SystemClock()) for name in unit_names(people)]
    for wearer in wearers:
        station.api.post("/units", {"unit_id": wearer.unit_id})
    station.api.put("/site/anchor", _ANCHOR)
    station.api.post("/incidents", {"name": "Bench"})
    wait_until("the station listens", lambda: bus.has_subscriber("muster/v1/x/up/position"))
    station.begin_measuring()
    psutil.cpu_times_percent()  # the next call gives the shares since this one
    for number in paced(people * rate_hz / _POSITIONS_SHARE, seconds):
        message = wearers[number % people].next_message()
        channel = channel_of(message)
        bus.publish(channel.key(message.header.unit_id), encode(message), channel.qos)
    cpu_share, idle_share = station.cpu_share(), psutil.cpu_times_percent().idle / 100.0
    time.sleep(_SETTLE_S)
    arrived = _first_of_each_position([one for one in client.events if one.kind == PERSON])
    first = {one.uid: one for one in reversed(arrived)}
    return TakReport(
        people=people,
        positions_hz=rate_hz,
        arrived_hz=len(arrived) / seconds,
        latency=latency_of([_latency_ms(one) for one in arrived]),
        latency_at_start=latency_of([_latency_ms(one) for one in first.values()]),
        people_arrived=len(first),
        cpu_share=cpu_share,
        idle_share=idle_share,
    )


def _first_of_each_position(arrived: list[ReceivedEvent]) -> list[ReceivedEvent]:
    """Without events that repeat a position, as when the state of a person changes."""
    first: dict[tuple[str, str], ReceivedEvent] = {}
    for one in arrived:
        first.setdefault((one.uid, one.event.get("time", "")), one)
    return list(first.values())


def _latency_ms(one: ReceivedEvent) -> float:
    at = datetime.fromisoformat(one.event.get("time", ""))
    return one.t_ns / NS_PER_MS - at.timestamp() * 1000.0


def _table_of(report: TakReport) -> Table:
    table = Table(title=f"{report.people} people, {report.positions_hz:g} positions/s each")
    for name in ("positions/s", "people", "p50 ms", "p99 ms", "max ms", "max ms of the first"):
        table.add_column(name, justify="right")
    table.add_column("CPU of the station", justify="right")
    table.add_column("idle cores", justify="right")
    latency = report.latency
    table.add_row(
        f"{report.arrived_hz:.0f}",
        str(report.people_arrived),
        f"{latency.p50_ms:.0f}",
        f"{latency.p99_ms:.0f}",
        f"{latency.max_ms:.0f}",
        f"{report.latency_at_start.max_ms:.0f}",
        f"{100.0 * report.cpu_share:.0f} %",
        f"{100.0 * report.idle_share:.0f} %",
    )
    return table
