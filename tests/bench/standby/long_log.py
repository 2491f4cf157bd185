"""A standby that is new beside a station with a long log: how it joins, and that it takes over."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path
from threading import Event, Thread
from typing import Any

import msgspec
from rich.progress import Progress
from rich.table import Table
from websockets.sync.client import connect

from base_station.core.log_position import is_event
from shared.errors import StoreError
from shared.mcap_log import read_log, segment_paths
from tests.bench.standby.station_of_pair import Place, Station
from tests.bench.standby.two_stations import TwoStations
from tests.rig import processes
from tests.rig.accelerated_station import compressed_station
from tests.rig.pacing import wait_until
from tests.rig.simulated_units import unit_names

_RATE_HZ = 7.0  # messages a second of each unit
_PATIENCE_S = 1200.0
_POLL_INTERVAL_S = 0.2
_TRAILS_WITHIN_S = 10.0
_SHOWN = ("units", "alarms", "commands", "incident", "plan", "anchor", "pins", "beacons")


@dataclass(frozen=True, slots=True)
class LongLogReport:
    units: int
    minutes: float  # that they walked before the standby was there
    messages: int
    log_mb: float
    joined_s: float  # from the start of the standby until it has everything
    joined_cpu_s: float  # of the standby, children included
    memory_leads_mb: float  # at most, of each, while it joined
    memory_follows_mb: float
    same_picture: bool  # both show the same to a console
    apart: int  # last events of the killed one that the other had not got
    take_over_s: float  # from the kill of the one until the other leads


def measure_long_log(folder: Path, units: int, minutes: float, progress: Progress) -> LongLogReport:
    task = progress.add_task(f"{units} units walk for {minutes:g} min", total=minutes)
    with ExitStack() as closing:
        two = TwoStations(folder, (Place(), Place()), closing)
        messages = _walk(two.first.data, units, minutes, progress)
        log_mb = sum(one.stat().st_size for one in segment_paths(two.first.data / "log")) / 1e6
        progress.update(task, description="the standby joins")
        two.first.start()
        wait_until("the first leads", two.first.leads, _PATIENCE_S)
        with _memory(two.first) as leads, _memory(two.second) as follows:
            began_s = time.monotonic()
            two.second.start()
            wait_until("the second follows", two.second.follows, _PATIENCE_S)
            joined_s = time.monotonic() - began_s
        assert two.second.process is not None
        joined_cpu_s = processes.cpu_s(two.second.process.pid)
        same_picture = _same_picture(two)
        began_s = time.monotonic()
        two.first.kill()
        wait_until("the second leads", two.second.leads)
        take_over_s = time.monotonic() - began_s
        two.second.stop()
        apart = _apart(two.first.data, two.second.data)
    return LongLogReport(
        units=units,
        minutes=minutes,
        messages=messages,
        log_mb=log_mb,
        joined_s=joined_s,
        joined_cpu_s=joined_cpu_s,
        memory_leads_mb=max(leads),
        memory_follows_mb=max(follows),
        same_picture=same_picture,
        apart=apart,
        take_over_s=take_over_s,
    )


def table_of(report: LongLogReport) -> Table:
    table = Table(
        title=f"A new standby beside a log of {report.minutes:g} min of {report.units} units: "
        f"{report.messages:,} messages, {report.log_mb:.0f} MB",
        show_header=False,
    )
    table.add_column("")
    table.add_column("", justify="right")
    for row in (
        ("has everything after", f"{report.joined_s:.0f} s, {report.joined_cpu_s:.0f} s of CPU"),
        ("memory of the one that leads, at most", f"{report.memory_leads_mb:.0f} MB"),
        ("memory of the standby, at most", f"{report.memory_follows_mb:.0f} MB"),
        ("both show the same", "yes" if report.same_picture else "NO"),
        ("take-over after kill -9", f"{report.take_over_s:.1f} s"),
        ("last events that only the killed one had", f"{report.apart}"),
    ):
        table.add_row(*row)
    return table


def _walk(data: Path, units: int, minutes: float, progress: Progress) -> int:
    with compressed_station(data, unit_names(units), _RATE_HZ, consoles=0) as station:
        while (left := minutes - progress.tasks[-1].completed) > 0.0:
            station.run(60.0 * min(left, 1.0))
            progress.advance(progress.tasks[-1].id, min(left, 1.0))
        return station.messages


@contextmanager
def _memory(station: Station) -> Iterator[list[float]]:
    """In MB, children included, again and again while it lasts."""
    seen, over = [0.0], Event()

    def look() -> None:
        while not over.wait(_POLL_INTERVAL_S):
            if station.process is not None and station.process.poll() is None:
                seen.append(processes.memory_mb(station.process.pid))

    looking = Thread(target=look, name="bench-memory")
    looking.start()
    try:
        yield seen
    finally:
        over.set()
        looking.join()


def _same_picture(two: TwoStations) -> bool:
    """No unit speaks any more, so the picture stands still but for the time."""
    try:
        wait_until("both show the same", lambda: _shown(two.first) == _shown(two.second), 10.0)
    except StoreError:
        return False
    return True


def _shown(station: Station) -> dict[str, Any]:
    """First snapshot of a console."""
    api = station.logged_in()
    with connect(
        api.live_url,
        additional_headers={"Cookie": api.cookie, "Origin": api.origin},
        max_size=None,
        compression=None,
    ) as socket:
        snapshot = msgspec.json.decode(socket.recv(), type=dict[str, Any])
        trails: dict[str, Any] = {}
        while len(trails) < len(snapshot["units"]):  # everybody walks
            message = msgspec.json.decode(socket.recv(_TRAILS_WITHIN_S), type=dict[str, Any])
            if message["type"] == "trail":
                trails[message["unit_id"]] = message["points"]
    return {name: snapshot.get(name) for name in _SHOWN} | {"trails": trails}


def _apart(one: Path, other: Path) -> int:
    """Events of the one's log from where the other's is another; of what was said in the last
    instant before the kill, they are handed over when it comes back.
    """
    pairs = zip(_events(one), _events(other), strict=False)
    same = sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], pairs))
    return sum(1 for _ in _events(one)) - same


def _events(data: Path) -> Iterator[tuple[int, str, bytes]]:
    return (record for record in read_log(data / "log") if is_event(record[1]))
