"""A replay in a process of its own, through the console's API."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from functools import partial
from pathlib import Path

import msgspec
import psutil
import pytest

from base_station.app.pipeline_factory import past_pipeline
from base_station.engine.ports import Trails
from base_station.replay.processes.replay_process import ReplayContext, ReplayProcess
from base_station.replay.processes.server import ReplayProcesses
from base_station.replay.session import ReplayWindow
from base_station.replay.version_check import DIFFERS
from base_station.storage.db.known_people import KnownPerson
from base_station.storage.missing_segments import KnownSegment
from base_station.views.wire import Delta, Snapshot
from shared.clock import NS_PER_MS, NS_PER_S
from shared.errors import UserError
from shared.mcap_log import SegmentPolicy, SegmentReader, SegmentWriter, segment_paths
from tests.rig.live_station import Screen
from tests.rig.logged_walk import DURATION_S, MAYDAY_S, logged, north, walk_with_mayday
from tests.rig.shown_replay import requested_snapshot
from tests.rig.station_script import START_NS
from tests.rig.waiting import until

pytestmark = pytest.mark.slow

WAIT_S = 300.0  # a loaded machine loads the program slowly
WINDOW = ReplayWindow("i1", START_NS, START_NS + DURATION_S * NS_PER_S)


class EncodedScreen(Screen):
    """A screen that takes encoded messages, as a hub does."""

    def __init__(self) -> None:
        super().__init__()
        self.messages: list[bytes] = []

    def broadcast_delta(self, whole: bytes, changes: bytes, redrawn: tuple[str, ...]) -> None:
        self.messages.append(whole)

    def broadcast_reset(self, message: bytes, trails: Trails) -> None:
        self.resets.append(msgspec.json.decode(message, type=Snapshot))


@pytest.fixture(scope="module")
def processes() -> Iterator[ReplayProcesses]:
    with ReplayProcesses() as processes:
        yield processes


@pytest.fixture
def place(tmp_path: Path, processes: ReplayProcesses) -> ReplayContext:
    writer = SegmentWriter(tmp_path / "log")
    for t_ns, key, payload in walk_with_mayday():
        writer.write(t_ns, key, payload)
    writer.close()
    return ReplayContext(
        processes=processes,
        log=str(tmp_path / "log"),
        checkpoints=str(tmp_path / "checkpoints"),
        prepare=lambda: None,
        note_damage=lambda _: None,
        people=lambda: {"p1": KnownPerson("Ada", photo_url="/photo")},
        empty_pipeline=lambda: past_pipeline(None),
    )


@pytest.fixture
def screen() -> EncodedScreen:
    return EncodedScreen()


@pytest.fixture
def replay(place: ReplayContext, screen: EncodedScreen) -> Iterator[ReplayProcess]:
    replay = ReplayProcess(place, WINDOW, 1.0, screen)
    yield replay
    replay.close()


def has_begun_again(screen: EncodedScreen, count: int) -> bool:
    """More restarts than this number."""
    return len(screen.resets) > count


def rules_reported(screen: EncodedScreen) -> set[str]:
    deltas = [msgspec.json.decode(one, type=Delta) for one in tuple(screen.messages)]
    return {alarm.rule for delta in deltas for alarm in delta.alarms}


def working(processes: ReplayProcesses) -> list[int]:
    assert processes.pid is not None
    return [one.pid for one in psutil.Process(processes.pid).children()]


def test_consoles_get_the_same_as_from_a_replay_in_this_process(
    replay: ReplayProcess, screen: EncodedScreen
) -> None:
    until(lambda: screen.resets, "the replay is shown", WAIT_S)
    replay.pause()
    for second in (100, 30, 119, 61):
        count = len(screen.resets)
        replay.seek(START_NS + second * NS_PER_S)
        assert replay.view().at_ms == START_NS // NS_PER_MS + second * 1000  # at once
        until(partial(has_begun_again, screen, count), "the place is shown", WAIT_S)
        seen = requested_snapshot(replay)
        (unit,) = seen.units
        assert unit.position is not None
        assert unit.position.north_m == pytest.approx(second - 1.0)
        assert unit.person is not None
        assert unit.person.photo_url == "/photo"
        assert bool(seen.alarms) == (second > MAYDAY_S)
        assert seen.replay is not None
        assert not seen.replay.playing
    replay.seek(START_NS)
    replay.set_speed(1000.0)
    replay.play()
    until(lambda: not replay.view().playing, "it has come to its end", WAIT_S)
    assert replay.view().at_ms == WINDOW.end_ns // NS_PER_MS
    until(lambda: "mayday" in rules_reported(screen), "its alarm is told", WAIT_S)


def test_impossible_speed_is_refused(replay: ReplayProcess, place: ReplayContext) -> None:
    with pytest.raises(UserError, match="times real time"):
        replay.set_speed(0.0)
    assert replay.view().speed == 1.0
    with pytest.raises(UserError, match="times real time"):
        ReplayProcess(place, WINDOW, 0.0, EncodedScreen())


def test_consoles_see_a_loading_replay_before_its_process_is_ready(
    place: ReplayContext, screen: EncodedScreen
) -> None:
    with ReplayProcesses() as fresh:
        replay = ReplayProcess(replace(place, processes=fresh), WINDOW, 1.0, screen)
        seen = requested_snapshot(replay)
        assert seen.replay is not None
        assert seen.replay.seeking
        assert replay.view().seeking
        replay.pause()
        replay.seek(START_NS + 100 * NS_PER_S)  # is done when it is there
        until(lambda: screen.resets and screen.resets[-1].alarms, "it is shown", WAIT_S)
        assert not replay.view().playing
        until(lambda: not replay.view().seeking, "it is there", WAIT_S)
        replay.close()


def test_killed_replay_is_over_and_another_can_be_begun(
    replay: ReplayProcess,
    place: ReplayContext,
    processes: ReplayProcesses,
    screen: EncodedScreen,
    caplog: pytest.LogCaptureFixture,
) -> None:
    until(lambda: screen.resets, "the replay is shown", WAIT_S)
    for pid in working(processes):
        os.kill(pid, signal.SIGKILL)
    until(lambda: replay.is_over, "it is over", WAIT_S)
    assert "the replay of i1 broke off: its process has ended" in caplog.text
    assert processes.pid is not None
    copied = psutil.Process(processes.pid)
    copied.kill()  # the one that others are copied from, too
    until(lambda: not _goes_on(copied), "it has ended", WAIT_S)
    other = ReplayProcess(place, WINDOW, 1.0, screen)
    assert requested_snapshot(other).replay is not None
    until(lambda: len(screen.resets) > 1, "the other one is shown", WAIT_S)
    other.close()
    until(lambda: not working(processes), "its process has ended", WAIT_S)


def test_stopping_station_starts_no_more_replays(place: ReplayContext) -> None:
    with ReplayProcesses() as stopped:
        pass
    replay = ReplayProcess(replace(place, processes=stopped), WINDOW, 1.0, EncodedScreen())
    until(lambda: replay.is_over, "it is over")
    replay.close()


_STATION = """
import sys, time
from base_station.replay.processes.server import ReplayProcesses
from base_station.replay.processes.jobs import ReplayJob
log, checkpoints, start_ns = sys.argv[1:]
processes = ReplayProcesses()
line = processes.start(
    ReplayJob(
        log=log, checkpoints=checkpoints, incident_id="i1", start_ns=int(start_ns), end_ns=2**62,
        speed=1.0,
    )
)
line.receive()
print(processes.pid, flush=True)
time.sleep(600)
"""


def test_killed_station_leaves_no_process(place: ReplayContext) -> None:
    command = [sys.executable, "-c", _STATION, place.log, place.checkpoints, str(START_NS)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as station:
        try:
            assert station.stdout is not None
            server = psutil.Process(int(station.stdout.readline()))
            left = [server, *server.children()]
            assert len(left) == 2
        finally:
            station.kill()
    until(lambda: not any(_goes_on(one) for one in left), "all have ended", WAIT_S)


def _goes_on(process: psutil.Process) -> bool:
    """The process runs; one that nobody has waited for yet has ended."""
    try:
        return process.is_running() and process.status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return False


def test_missing_part_of_the_log_is_reported_in_a_replay_at_a_running_station(
    place: ReplayContext, tmp_path: Path
) -> None:
    """A segment that is gone and was known, and flipped bits that no reader needs."""
    log = tmp_path / "damaged" / "log"
    with closing(SegmentWriter(log, SegmentPolicy(segment_s=20.0))) as writer:
        for t_ns, key, payload in walk_with_mayday():
            writer.write(t_ns, key, payload)
    _, second, third, *_ = segment_paths(log)
    with SegmentReader(second) as reader:
        info = reader.info()
    known = KnownSegment(second.name, info.start_ns, info.end_ns, info.messages)
    second.unlink()
    content = bytearray(third.read_bytes())
    content[200] ^= 0xFF
    third.write_bytes(content)
    damaged = replace(place, log=str(log), known_segments=lambda: (known,))
    session = ReplayProcess(damaged, WINDOW, 1.0, EncodedScreen())
    session.pause()
    try:
        until(lambda: len(session.view().flaws) == 2, "both are told", WAIT_S)
        gone, flipped = session.view().flaws
    finally:
        session.close()
    assert gone.startswith("segment 2 of the log is missing: what happened from 2023-")
    assert flipped.startswith(f"a part of the log cannot be read: {third.name}: the chunk at byte")


@pytest.mark.parametrize("is_other", [True, False])
def test_log_of_another_version_is_reported_at_a_running_station(
    is_other: bool, place: ReplayContext, tmp_path: Path
) -> None:
    """Once its first picture is shown; a log of the same version is checked meanwhile."""
    log, screen = tmp_path / "recorded" / "log", EncodedScreen()
    with closing(SegmentWriter(log, SegmentPolicy(segment_s=20.0))) as writer:
        for record in logged(north(2.0) if is_other else north(0.0)):
            writer.write(*record)
    if not is_other:  # found at the end of the check
        newest = segment_paths(log)[-1]
        content = bytearray(newest.read_bytes())
        content[300] ^= 0xFF
        newest.write_bytes(content)
    session = ReplayProcess(replace(place, log=str(log)), WINDOW, 1.0, screen)
    session.pause()
    try:
        until(lambda: session.view().flaws, "it is told", WAIT_S)
        assert screen.resets
        assert [flaw == DIFFERS for flaw in session.view().flaws] == [is_other]
    finally:
        session.close()
