"""``muster bench backfill``: one unit's long backlog is fetched while others keep publishing."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import typer
from rich.console import Console as Terminal
from rich.progress import Progress
from rich.table import Table

from base_station.process import gc_tuning
from shared.bench_figures import FiguresFile, write_figures
from shared.bus_zenoh import UnitEndpoint, ZenohBus
from shared.channels import CHANNELS, POSITION, ROOT, Direction, Qos, backfilled_key, channel_of
from shared.clock import NS_PER_S, ManualClock
from shared.codec import encode
from shared.mcap_log import read_log
from shared.messages import JournalBoot, JournalChunk, JournalEntry, JournalIndex, Message
from tests.rig.console_client import Console, watching
from tests.rig.latency import Latency, latencies_ms, latency_of
from tests.rig.pacing import wait_until
from tests.rig.simulated_units import BenchUnit, Wearer, speak_in_turn, unit_names
from tests.rig.station_process import Membership, PlainTcp, StationProcess, station_process

_BACKLOG_UNIT = "bench-backlog"
_MESSAGES_HZ = 7.0
_FETCH_HZ = 10_000.0  # to reach
_TIMES_SLOWER = 2.0  # to reach, of live data
_WARM_S = 4.0
_PIECE_S = 0.5
_STALLED_S = 15.0  # nothing more comes: what was lost is told
_REPORTED_LATE_S = 2.0  # the console hears so late of how much was stepped, at most


@dataclass(frozen=True, slots=True)
class BackfillReport:
    units: int
    backlog: int
    fetched_s: float
    fetched_hz: float
    recorded: int
    lost: int
    repeated: int
    before: Latency  # of live positions
    meanwhile: Latency
    cpu_share: float  # of one core, while fetching


def bench_backfill(
    backlog: Annotated[int, typer.Option(min=1, help="Messages that one unit has kept.")] = 100_000,
    units: Annotated[int, typer.Option(min=1, help="Other units, which publish meanwhile.")] = 50,
    seconds: Annotated[float, typer.Option(min=1.0, help="Duration before the backfill.")] = 10.0,
    plain: PlainTcp = False,
    json_file: FiguresFile = None,
) -> None:
    """Measure the speed at which a station fetches a unit's backlog, and its effect on the delay of
    other units.
    """
    with Progress(transient=True) as progress:
        report = measure(backlog, units, seconds, progress, plain=plain)
    Terminal().print(_table(report))
    write_figures(json_file, report)


def measure(
    backlog: int, units: int, seconds: float, progress: Progress, *, plain: bool = False
) -> BackfillReport:
    gc_tuning.configure()  # units, journal and console share this process, as no station's do
    with TemporaryDirectory(prefix="muster-bench-") as folder, ExitStack() as closing:
        names = unit_names(units)
        members = Membership(Path(folder), [*names, _BACKLOG_UNIT], plain=plain)
        station = closing.enter_context(station_process(Path(folder), members.address))
        others = [BenchUnit(name, members.endpoint_of(name), closing) for name in names]
        for name in [*names, _BACKLOG_UNIT]:
            station.api.post("/units", {"unit_id": name})
        wait_until("the station listens", lambda: all(unit.is_received for unit in others))
        [console] = watching(station.api, 1, closing)
        return _fetch(
            station,
            others,
            console,
            _Backlog(backlog, members.endpoint_of(_BACKLOG_UNIT), closing),
            seconds,
            progress,
        )


def _fetch(
    station: StationProcess,
    others: Sequence[BenchUnit],
    console: Console,
    backlog: _Backlog,
    seconds: float,
    progress: Progress,
) -> BackfillReport:
    task = progress.add_task("live only", total=backlog.count)
    rate_hz = _MESSAGES_HZ * len(others)
    speak_in_turn(others, rate_hz, _WARM_S, lambda: None)
    before_ns = time.time_ns()
    speak_in_turn(others, rate_hz, seconds, lambda: None)
    began_ns = time.time_ns()
    known = station.api.get("/health")["messages"] - _stated_by(others)
    station.begin_measuring()
    backlog.appear()
    progress.update(task, description="fetching")
    nearly = backlog.count - round(_REPORTED_LATE_S * rate_hz)
    for fetched in _coming(others, console, known):
        backlog.speak()
        progress.update(task, completed=fetched)
        if fetched >= nearly:
            break
    cpu_share = station.cpu_share()
    end_ns = time.time_ns()
    time.sleep(_REPORTED_LATE_S)
    console.close()
    station.stop()
    recorded = station.recorded()
    fetched, took_s = _fetched(station.log, began_ns)
    sent = _stated_by(others) + backlog.output
    return BackfillReport(
        units=len(others),
        backlog=backlog.count,
        fetched_s=took_s,
        fetched_hz=fetched / took_s if took_s else 0.0,
        recorded=recorded.from_units,
        lost=sent - recorded.from_units,
        repeated=recorded.repeated,
        before=_latency_between(others, console, before_ns, began_ns),
        meanwhile=_latency_between(others, console, began_ns, end_ns),
        cpu_share=cpu_share,
    )


def _coming(others: Sequence[BenchUnit], console: Console, known: int) -> Iterator[int]:
    """Numbers of fetched messages that the console has, polled during live traffic; ends
    where no more come.  ``known``: of all that it knew before, those that the others had not said.
    """
    fetched, came_s = 0, time.perf_counter()
    while time.perf_counter() - came_s < _STALLED_S:
        speak_in_turn(others, _MESSAGES_HZ * len(others), _PIECE_S, lambda: None)
        now = console.messages_stepped - known - _stated_by(others)
        if now > fetched:
            fetched, came_s = now, time.perf_counter()
        yield fetched


def _stated_by(units: Sequence[BenchUnit]) -> int:
    return sum(unit.sent.messages for unit in units)


class _Backlog:
    """A unit that was away: its journal is in memory, and served as ``docs/journal.md`` says."""

    def __init__(self, count: int, endpoint: UnitEndpoint, closing: ExitStack) -> None:
        """``count`` messages of the time until now."""
        self.count = count
        self._clock = ManualClock(time.time_ns() - round(count / _MESSAGES_HZ * NS_PER_S))
        self._wearer = Wearer(_BACKLOG_UNIT, self._clock)
        self._entries: list[JournalEntry] = []
        for _ in range(count):
            self._boot_id = self._next().header.boot_id
        self._acknowledged = 0
        self._bus = ZenohBus(endpoint)
        closing.callback(self._bus.close)
        prefix = f"{ROOT}/{_BACKLOG_UNIT}/journal"
        self._serving = self._bus.serve(f"{prefix}/**", self._replies)

    @property
    def output(self) -> int:
        """Messages, the backlog and what was said live."""
        return len(self._entries)

    def appear(self) -> None:
        """Say the next message live: the station sees that all before it are missing."""
        key = POSITION.key(_BACKLOG_UNIT)
        wait_until("the station listens", lambda: self._bus.has_subscriber(key))
        self.speak()

    def speak(self) -> None:
        """Say the next message live; who says nothing for ten seconds is asked for nothing."""
        message = self._next()
        self._bus.publish(channel_of(message).key(_BACKLOG_UNIT), encode(message), Qos.LIVE)

    def _next(self) -> Message:
        self._clock.advance(1.0 / _MESSAGES_HZ)
        message = self._wearer.next_message()
        entry = JournalEntry(self.output + 1, channel_of(message).suffix, encode(message))
        self._entries.append(entry)
        return message

    def _replies(self, key: str, parameters: str, payload: bytes) -> Iterator[bytes]:
        del payload
        asked = dict(pair.split("=", 1) for pair in parameters.split(";") if pair)
        what = key.rpartition("/")[2]
        if what == "acknowledge":
            self._acknowledged = int(asked["to"])
        if what in ("index", "acknowledge"):
            boot = JournalBoot(self._boot_id, 1, self.output, self._acknowledged, 0)
            yield JournalIndex((boot,)).to_bytes()
            return
        first, last = int(asked["from"]), min(int(asked["to"]), self.output)
        if what == "urgent":
            yield JournalChunk(self._boot_id, first, last, (), urgent_only=True).to_bytes()
            return
        yield from self._range(first, last, int(asked["bytes"]), int(asked["total"]))

    def _range(self, first: int, last: int, reply_bytes: int, total: int) -> Iterator[bytes]:
        entries: list[JournalEntry] = []
        size = 0
        for entry in self._entries[first - 1 : last]:
            entries.append(entry)
            size += len(entry.payload)
            total -= len(entry.payload)
            if size >= reply_bytes or total <= 0:
                yield JournalChunk(self._boot_id, first, entry.seq, tuple(entries)).to_bytes()
                first, entries, size = entry.seq + 1, [], 0
            if total <= 0:
                return
        if entries:
            yield JournalChunk(self._boot_id, first, last, tuple(entries)).to_bytes()


def _fetched(log: Path, began_ns: int) -> tuple[int, float]:
    """Number of fetched messages in the log, and the time until the last of them."""
    suffixes = {channel.suffix for channel in CHANNELS if channel.direction is Direction.UP}
    keys = {backfilled_key(_BACKLOG_UNIT, suffix) for suffix in suffixes}
    times_ns = [t_ns for t_ns, _, _ in read_log(log, keys=keys)]
    return len(times_ns), (max(times_ns, default=began_ns) - began_ns) / NS_PER_S


def _latency_between(
    units: Sequence[BenchUnit], console: Console, begin_ns: int, end_ns: int
) -> Latency:
    sent = {
        unit.unit_id: [t for t in unit.sent.position_times_ns if begin_ns <= t < end_ns]
        for unit in units
    }
    return latency_of(latencies_ms(sent, console.shown))


def _table(report: BackfillReport) -> Table:
    table = Table(
        title=f"{report.backlog:,} messages of one unit, {report.units} others speaking",
    )
    for title in ("", "measured", "to reach"):
        table.add_column(title, justify="left" if title == "" else "right")
    before, meanwhile = report.before, report.meanwhile
    rows = [
        ("fetched", f"{report.fetched_hz:,.0f} /s", f"{_FETCH_HZ:,.0f} /s"),
        ("in", f"{report.fetched_s:.1f} s", ""),
        ("lost", f"{report.lost:,}", "0"),
        ("twice in the log", f"{report.repeated:,}", "0"),
        ("live before, p50, p99", f"{before.p50_ms:.0f}, {before.p99_ms:.0f} ms", ""),
        (
            "live meanwhile, p50, p99",
            f"{meanwhile.p50_ms:.0f}, {meanwhile.p99_ms:.0f} ms",
            f"p99 {_TIMES_SLOWER * before.p99_ms:.0f} ms",
        ),
        ("station, of one core", f"{report.cpu_share:.0%}", ""),
    ]
    for row in rows:
        table.add_row(*row)
    return table
