"""``muster bench replay``: a replay of an incident of many units, as a console gets it."""

from __future__ import annotations

import os
import statistics
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import psutil
import typer
from rich.console import Console
from rich.progress import Progress
from rich.table import Table

from base_station.app.offline_log import open_offline_log
from base_station.app.pipeline_factory import past_pipeline
from base_station.engine.log_feed import FolderFeed
from base_station.engine.ports import Trails
from base_station.replay.playback import Archive
from base_station.replay.processes.replay_process import ReplayContext, ReplayProcess
from base_station.replay.processes.server import ReplayProcesses
from base_station.replay.session import FASTEST, ReplaySession, ReplayWindow
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.known_people import person_lookup
from base_station.storage.db.records import Records
from base_station.storage.db.store import Store
from base_station.views.wire import Delta, Snapshot
from shared.bench_figures import FiguresFile, write_figures
from shared.channels import OPERATOR
from shared.clock import SystemClock
from shared.mcap_log import can_be_packed, is_console, pack_segment, read_log, segment_paths
from shared.messages import STATION_ID
from tests.bench.past.command import walk_incident
from tests.bench.past.live_positions import PositionAges, live_positions
from tests.rig.latency import Latency, latency_of

_PATIENCE_S = 1800.0
_RATE_HZ = 7.0  # messages a second of each unit
_REPLAYS = 8
_WARM = (0.9, 0.2, 0.55, 0.99, 0.01, 0.7, 0.35)  # of the way, one after the other
_COLD = (0.8, 0.4)
_AGAIN = (0.5, 0.25)  # by deciding again


class Watcher:
    """An ``EncodedSink`` that notes when it got a picture, and keeps nothing."""

    def __init__(self) -> None:
        self._came = threading.Condition()
        self._pictures = 0
        self.deltas = 0

    def delta(self, _: Delta) -> None:
        self.deltas += 1

    def reset(self, _: Snapshot, __: Trails) -> None:
        with self._came:
            self._pictures += 1
            self._came.notify_all()

    def broadcast_delta(self, _: bytes, __: bytes, ___: tuple[str, ...]) -> None:
        self.deltas += 1

    def broadcast_reset(self, _: bytes, __: Trails) -> None:
        with self._came:
            self._pictures += 1
            self._came.notify_all()

    def wait_for(self, pictures: int) -> None:
        with self._came:
            came = self._came.wait_for(lambda: self._pictures >= pictures, _PATIENCE_S)
        assert came, "no picture came"

    @property
    def pictures(self) -> int:
        return self._pictures


@dataclass(frozen=True)
class ReplayFigures:
    units: int
    minutes: float
    messages: int
    written_mb: float  # of the log, as it comes to the disk
    log_mb: float  # packed, as a station keeps it
    console_share: float  # of the bytes before compression
    checkpoints_mb: float
    first_process_s: float  # until the first picture; the program is loaded first
    first_s: float  # with a program that is loaded
    no_checkpoints_s: float  # of a backup: the same
    log_alone_s: float  # of the log's files without a database: opened, and the first picture
    actions_s: float  # all that operators did, out of the whole log
    warm_s: float  # a seek, the middle one
    warm_worst_s: float
    cold_s: float  # with a log that is not in memory
    times_real: float
    times_a_core: float  # the same, a second of a core
    peak_mb: float  # of its process
    again_first_s: float  # by deciding again
    again_seek_s: float
    again_times_real: float
    alone: Latency  # of live positions as consoles get them, before and after
    meanwhile: Latency  # beside eight replays at real time


def bench_replay(
    units: Annotated[int, typer.Option(min=1, help="Wearers.")] = 100,
    minutes: Annotated[float, typer.Option(min=1.0, help="Duration of the walks.")] = 60.0,
    live_units: Annotated[int, typer.Option(min=1, help="Wearers at the live station.")] = 20,
    live_s: Annotated[float, typer.Option(min=0.5, help="Duration beside eight replays.")] = 20.0,
    json_file: FiguresFile = None,
) -> None:
    """Measure first picture, seeks, speed and memory of replays of a simulated incident: as it was
    shown, in a process of its own, and by deciding everything again.
    """
    with TemporaryDirectory(prefix="muster-bench-") as name, Progress(transient=True) as progress:
        folder = DataFolder(Path(name))
        messages = walk_incident(folder, units, minutes, progress)
        written_mb = _log_mb(folder)
        for segment in filter(can_be_packed, segment_paths(folder.log)):  # as a station does
            pack_segment(segment)
        progress.add_task("replaying", total=None)
        with Store(folder.database) as store:
            incident = Records(store, SystemClock()).require_incident("i1")
        assert incident.closed_ns is not None
        window = ReplayWindow("i1", incident.opened_ns, incident.closed_ns)
        figures = _figures(folder, window, units, minutes, messages, written_mb, live_units, live_s)
    Console().print(_table(figures))
    write_figures(json_file, figures)


def _figures(
    folder: DataFolder,
    window: ReplayWindow,
    units: int,
    minutes: float,
    messages: int,
    written_mb: float,
    live_units: int,
    live_s: float,
) -> ReplayFigures:
    with ReplayProcesses() as processes:
        context = ReplayContext(
            processes=processes,
            log=str(folder.log),
            checkpoints=str(folder.checkpoints),
            prepare=lambda: None,
            note_damage=typer.echo,
            people=dict,
            empty_pipeline=lambda: past_pipeline(None),
        )
        first_process_s = _first_picture_s(context, window)
        first_s = _first_picture_s(context, window)
        backup = replace(context, checkpoints=str(folder.path / "no-checkpoints"))
        no_checkpoints_s = _first_picture_s(backup, window)
        with _replay(context, window) as (player, watcher):
            warm_s = [_seek_s(player, watcher, window, share) for share in _WARM]
            cold_s = []
            for share in _COLD:
                _drop_from_memory(folder)
                cold_s.append(_seek_s(player, watcher, window, share))
            worker = _worker(processes)
            before_s = _cpu_s(worker)
            times_real, played_s = _times_real(player, watcher, window)
            times_a_core = played_s / (_cpu_s(worker) - before_s)
            peak_mb = _peak_mb(worker)
        alone, meanwhile = _live_ages(folder, context, window, live_units, live_s)
    log_alone_s, actions_s = _log_alone_s(folder, window), _actions_s(folder)
    again_first_s, again_s, again_times = _decided_again(folder, window)
    return ReplayFigures(
        units=units,
        minutes=minutes,
        messages=messages,
        written_mb=written_mb,
        log_mb=_log_mb(folder),
        console_share=_console_share(folder),
        checkpoints_mb=sum(one.stat().st_size for one in folder.checkpoints.iterdir()) / 1e6,
        first_process_s=first_process_s,
        first_s=first_s,
        no_checkpoints_s=no_checkpoints_s,
        log_alone_s=log_alone_s,
        actions_s=actions_s,
        warm_s=statistics.median(warm_s),
        warm_worst_s=max(warm_s),
        cold_s=max(cold_s),
        times_real=times_real,
        times_a_core=times_a_core,
        peak_mb=peak_mb,
        again_first_s=again_first_s,
        again_seek_s=max(again_s),
        again_times_real=again_times,
        alone=alone,
        meanwhile=meanwhile,
    )


@contextmanager
def _replay(
    context: ReplayContext, window: ReplayWindow
) -> Iterator[tuple[ReplayProcess, Watcher]]:
    watcher = Watcher()
    player = ReplayProcess(context, window, 1.0, watcher)
    try:
        player.pause()
        watcher.wait_for(1)
        yield player, watcher
    finally:
        player.close()


def _first_picture_s(context: ReplayContext, window: ReplayWindow) -> float:
    began_s = time.perf_counter()
    with _replay(context, window):
        return time.perf_counter() - began_s


def _log_alone_s(folder: DataFolder, window: ReplayWindow) -> float:
    """Time to open the files of the log as ``muster base replay`` does, until the first picture."""
    watcher, began_s = Watcher(), time.perf_counter()
    with ExitStack() as closing:
        offline_log = open_offline_log(
            folder.log,
            "i1",
            closing,
            lambda _: None,
            lambda _: None,
            in_place=False,
            decides_again=False,
            tables_later=True,
        )
        archive = offline_log.archive()
        session = ReplaySession(archive, window, 1.0, watcher, person_lookup({}), SystemClock())
        closing.callback(session.close)
        watcher.wait_for(1)
        return time.perf_counter() - began_s


def _actions_s(folder: DataFolder) -> float:
    """Time to read one topic, of a few records, out of the whole log."""
    began_s = time.perf_counter()
    assert list(read_log(folder.log, keys={OPERATOR.key(STATION_ID)}))
    return time.perf_counter() - began_s


def _seek_s(
    player: ReplayProcess | ReplaySession, watcher: Watcher, window: ReplayWindow, share: float
) -> float:
    pictures, began_s = watcher.pictures, time.perf_counter()
    player.seek(window.start_ns + round(share * (window.end_ns - window.start_ns)))
    watcher.wait_for(pictures + 1)
    return time.perf_counter() - began_s


def _times_real(
    player: ReplayProcess | ReplaySession, watcher: Watcher, window: ReplayWindow
) -> tuple[float, float]:
    """Speed of the whole replay, or of half a minute of it, and the part that was replayed."""
    _seek_s(player, watcher, window, 0.0)
    player.set_speed(FASTEST)
    began_s, began_ms = time.perf_counter(), player.view().at_ms
    player.play()
    while (view := player.view()).playing and time.perf_counter() - began_s < 30.0:
        time.sleep(0.01)
    player.pause()
    played_s = (view.at_ms - began_ms) / 1e3
    return played_s / (time.perf_counter() - began_s), played_s


def _decided_again(folder: DataFolder, window: ReplayWindow) -> tuple[float, list[float], float]:
    """First picture, seeks and speed without what consoles were shown."""
    log = FolderFeed(folder.log)
    archive = Archive(log.records, Checkpoints(folder.checkpoints), past_pipeline, log.watch)
    watcher, began_s = Watcher(), time.perf_counter()
    session = ReplaySession(archive, window, 1.0, watcher, person_lookup({}), SystemClock())
    try:
        session.pause()
        watcher.wait_for(1)
        first_s = time.perf_counter() - began_s
        times_real, _ = _times_real(session, watcher, window)
        return first_s, [_seek_s(session, watcher, window, one) for one in _AGAIN], times_real
    finally:
        session.close()


def _live_ages(
    folder: DataFolder,
    context: ReplayContext,
    window: ReplayWindow,
    live_units: int,
    live_s: float,
) -> tuple[Latency, Latency]:
    with live_positions(folder.path / "live", live_units, _RATE_HZ) as ages:
        alone_ms = _ages_ms(ages, live_s)
        players = [ReplayProcess(context, window, 1.0, Watcher()) for _ in range(_REPLAYS)]
        meanwhile_ms = _ages_ms(ages, live_s)
        for player in players:
            player.close()
        alone_ms += _ages_ms(ages, live_s)
    return latency_of(alone_ms), latency_of(meanwhile_ms)


def _ages_ms(ages: PositionAges, seconds: float) -> list[float]:
    ages.take()  # of before
    time.sleep(seconds)
    return ages.take()


def _drop_from_memory(folder: DataFolder) -> None:
    """The next reader of the log waits for the disk."""
    for path in segment_paths(folder.log):
        file = os.open(path, os.O_RDONLY)
        try:
            os.posix_fadvise(file, 0, 0, os.POSIX_FADV_DONTNEED)
        finally:
            os.close(file)


def _worker(processes: ReplayProcesses) -> psutil.Process:
    assert processes.pid is not None
    (child,) = psutil.Process(processes.pid).children()
    return child


def _cpu_s(worker: psutil.Process) -> float:
    times = worker.cpu_times()
    return float(times.user + times.system)


def _peak_mb(worker: psutil.Process) -> float:
    """Peak memory of the replay's process, with the pages shared with its parent."""
    status = Path(f"/proc/{worker.pid}/status").read_text(encoding="ascii")
    (peak_kb,) = (line.split()[1] for line in status.splitlines() if line.startswith("VmHWM"))
    return int(peak_kb) / 1e3


def _log_mb(folder: DataFolder) -> float:
    return sum(path.stat().st_size for path in segment_paths(folder.log)) / 1e6


def _console_share(folder: DataFolder) -> float:
    total = console = 0
    for _, key, payload in read_log(folder.log, derived=True):
        total += len(payload)
        console += len(payload) if is_console(key) else 0
    return console / total


def _table(figures: ReplayFigures) -> Table:
    table = Table(
        title=f"Replaying {figures.minutes:g} min of {figures.units} units: "
        f"{figures.messages:,} messages, "
        f"log {figures.log_mb:.0f} MB, {figures.written_mb:.0f} MB as written "
        f"(before compression {figures.console_share:.0%} of it what consoles were shown), "
        f"checkpoints {figures.checkpoints_mb:.0f} MB"
    )
    for title in ("", "as shown", "to reach", "decided again"):
        table.add_column(title, justify="right" if title else "left")
    again = f"{figures.again_first_s:.2f} s"
    table.add_row("first picture, program to be loaded", f"{figures.first_process_s:.2f} s")
    table.add_row("first picture", f"{figures.first_s:.2f} s", "1 s", again)
    table.add_row("first picture, no checkpoints", f"{figures.no_checkpoints_s:.2f} s", "1 s")
    table.add_row("first picture, files of the log alone", f"{figures.log_alone_s:.2f} s", "2 s")
    table.add_row("one topic of the whole log", f"{figures.actions_s:.2f} s", "0.2 s")
    seek = f"{figures.warm_s:.2f} s, worst {figures.warm_worst_s:.2f} s"
    table.add_row("seek", seek, "0.3 s", f"{figures.again_seek_s:.2f} s")
    table.add_row("seek, log not in memory", f"{figures.cold_s:.2f} s", "1 s")
    times = f"{figures.times_real:.0f} x", "300 x", f"{figures.again_times_real:.0f} x"
    table.add_row("fastest, times real time", *times)
    table.add_row("the same, a second of a core", f"{figures.times_a_core:.0f} x")
    table.add_row("memory of its process, at most", f"{figures.peak_mb:.0f} MB")
    for name, ages in (("no replay", figures.alone), ("eight replays", figures.meanwhile)):
        shown = f"{ages.p50_ms:.0f}, {ages.p99_ms:.0f} ms"
        table.add_row(f"live positions beside {name}, p50, p99", shown)
    return table
