"""Post-processing of an incident in a process of its own."""

from __future__ import annotations

import shutil
import socket
import threading
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import msgspec
import psutil
import pytest

from base_station.app import folder_commands as station_app
from base_station.app.pipeline_factory import past_pipeline
from base_station.engine.log_feed import FolderFeed
from base_station.fusion.smoothing import SMOOTHERS
from base_station.replay.playback import Archive
from base_station.replay.post_processing import PostProcessor, read_report
from base_station.replay.processes.frame_channel import FrameChannel
from base_station.replay.processes.jobs import Job, PostProcessingJob
from base_station.replay.processes.post_processing_process import (
    MEMORY_MB,
    PostProcessingContext,
    PostProcessingProcess,
)
from base_station.replay.processes.server import ReplayProcesses
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.records import Records
from base_station.storage.db.smoothed import SmoothedTracks
from base_station.storage.db.store import Store
from base_station.storage.missing_segments import KnownSegment
from shared.clock import NS_PER_S, SystemClock
from shared.errors import MemoryLimitError, StoreError
from shared.mcap_log import SegmentWriter, segment_paths
from shared.messages import Header, Position
from shared.messages.pins import SetPin
from shared.messages.station import CloseIncident, OpenIncident, RegisterUnit, SetStart
from tests.rig.live_station import LiveStation
from tests.rig.small_log import KEY, T0_NS
from tests.rig.waiting import until


class IncidentFolder:
    """A station's folder after an incident, and what looks back on it."""

    def __init__(self, path: Path) -> None:
        self.folder = DataFolder(path)
        self.store = Store(self.folder.database)
        self.kept = SmoothedTracks(self.store)
        self.records = Records(self.store, SystemClock())
        log = FolderFeed(self.folder.log)
        self.archive = Archive(
            log.records, Checkpoints(self.folder.checkpoints), past_pipeline, log.watch
        )

    @property
    def incident(self) -> IncidentRow:
        incident = self.records.incident("i1")
        assert incident is not None
        return incident

    def here(self) -> PostProcessor:
        return PostProcessor(self.archive, SMOOTHERS[0], self.kept, SystemClock())

    def beside(
        self,
        processes: ReplayProcesses,
        memory_mb: int = MEMORY_MB,
        known: tuple[KnownSegment, ...] = (),
    ) -> PostProcessingProcess:
        place = PostProcessingContext(
            processes=processes,
            log=str(self.folder.log),
            checkpoints=str(self.folder.checkpoints),
            database=str(self.folder.database),
            prepare=lambda: None,
            note_damage=lambda _: None,
            memory_mb=memory_mb,
            known_segments=lambda: known,
        )
        return PostProcessingProcess(place, self.archive, SMOOTHERS[0], self.kept, SystemClock())


@pytest.fixture(scope="module")
def processes() -> Iterator[ReplayProcesses]:
    with ReplayProcesses() as processes:
        yield processes


@pytest.fixture
def desk(tmp_path: Path, make_position) -> Iterator[IncidentFolder]:
    position: Position = make_position()
    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit("FF-01", ""))
        station.act(OpenIncident("i1", "Mill Lane"))
        station.act(SetStart("FF-01", 0.0, 0.0, 0.0, 0.0, 0.5, 0.1))
        for step in range(40):
            header = Header("FF-01", 7, step + 1, step * NS_PER_S // 10)
            stated = msgspec.structs.replace(
                position, header=header, north_m=0.1 * step, east_m=0.0
            )
            station.publish(stated)
        until(lambda: station.pipeline.state.counts.messages >= 40)
        station.act(SetPin("p", "FF-01", 0, 0.5, 0.5, 0.5, None, None, 0.0, "door"))
        station.act(CloseIncident("i1"))
    station_app.rebuild(tmp_path, lambda _: None)
    desk = IncidentFolder(tmp_path)
    yield desk
    desk.store.close()


def test_process_computes_the_same_result_and_stores_it(
    desk: IncidentFolder, processes: ReplayProcesses
) -> None:
    post_processor = desk.beside(processes)
    report = post_processor.assess(desk.incident, {})
    made, raw = post_processor.smoothed(desk.incident), post_processor.raw(desk.incident)
    assert made.is_kept
    assert desk.kept.report("i1") is not None
    here = desk.here()
    again = here.post_process(desk.incident, desk.records.tracks_of(desk.incident))
    assert made.tracks == again.smoothed
    assert raw == again.raw
    assert report == msgspec.structs.replace(again.report, made_ms=report.made_ms)


def test_missing_segments_are_in_the_report(
    desk: IncidentFolder, processes: ReplayProcesses
) -> None:
    """A segment that only the database knows, and one of another log."""
    known = KnownSegment("000007-20231114T221320Z.mcap", T0_NS, T0_NS + NS_PER_S, 10)
    with closing(SegmentWriter(desk.folder.path / "other")) as other:
        other.write(desk.incident.opened_ns + 3600 * NS_PER_S, KEY, b"")
    (beside,) = segment_paths(desk.folder.path / "other")
    shutil.move(beside, desk.folder.log / f"000008{beside.name[6:]}")
    report = desk.beside(processes, known=(known,)).assess(desk.incident, {})
    foreign, gone = report.flaws
    assert foreign.endswith("is no segment of this log and is left out: it is of another log")
    assert gone.startswith("segment 7 of the log is missing")
    kept = desk.kept.report("i1")
    assert kept is not None
    again = read_report(kept)
    assert again is not None
    assert again.flaws == report.flaws
    codes = [one.code for one in again.flaw_codes]
    assert codes == ["segment-foreign", "log-segment-missing"]
    assert again.flaw_codes[0].texts["reason:"] == "foreign-log"


def test_result_of_an_open_incident_is_not_stored(
    desk: IncidentFolder, processes: ReplayProcesses
) -> None:
    is_open = IncidentRow(
        incident_id="i1", name="Mill Lane", opened_ns=desk.incident.opened_ns, closed_ns=None
    )
    fractions: list[float] = []
    made = desk.beside(processes).smooth(is_open, fractions.append)
    assert not made.is_kept
    assert not desk.kept.has("i1")
    assert made.tracks == desk.here().smooth(is_open).tracks
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1.0


def test_excess_of_the_memory_limit_is_refused_and_not_retried(
    desk: IncidentFolder, processes: ReplayProcesses, caplog: pytest.LogCaptureFixture
) -> None:
    post_processor = desk.beside(processes, memory_mb=10)
    with pytest.raises(MemoryLimitError, match=r"i1 takes more memory than the 10 MB.*base smooth"):
        post_processor.smoothed(desk.incident)
    asked: list[str] = []

    def shown(incident: IncidentRow) -> dict[str, list[object]]:
        asked.append(incident.incident_id)
        return {}

    for _ in range(2):
        post_processor.catch_up([desk.incident], shown)  # type: ignore[arg-type]  # nothing was shown
    assert asked == ["i1"]
    assert "takes more memory" in caplog.text
    assert desk.beside(processes).smoothed(desk.incident).is_kept


class KilledProcesses(ReplayProcesses):
    """Once: all of them, by somebody who needs memory."""

    is_killed = False

    def start(self, job: Job) -> FrameChannel:
        line = super().start(job)
        if not self.is_killed:
            self.is_killed = True
            assert self.pid is not None
            server = psutil.Process(self.pid)
            for process in (*server.children(), server):
                process.kill()
        return line


def test_killed_process_is_reported_and_a_new_request_succeeds(desk: IncidentFolder) -> None:
    with KilledProcesses() as processes:
        post_processor = desk.beside(processes)
        with pytest.raises(StoreError, match="the process that did so has ended; ask again"):
            post_processor.smoothed(desk.incident)
        assert not desk.kept.has("i1")
        assert post_processor.smoothed(desk.incident).is_kept


class SlowProcesses(ReplayProcesses):
    """One that takes its time."""

    def __init__(self) -> None:
        super().__init__()
        self.begun = threading.Event()
        self.far_end: socket.socket | None = None

    def start(self, job: Job) -> FrameChannel:
        assert isinstance(job, PostProcessingJob)
        assert job.incident_id == "i1"
        ours, self.far_end = socket.socketpair()
        self.begun.set()
        return FrameChannel(ours)


def test_stopping_station_does_not_wait_for_post_processing(desk: IncidentFolder) -> None:
    processes, reported = SlowProcesses(), list[str]()
    post_processor, incident = desk.beside(processes), desk.incident

    def ask() -> None:
        try:
            post_processor.smoothed(incident)
        except StoreError as error:
            reported.append(str(error))

    asking = threading.Thread(target=ask)
    asking.start()
    assert processes.begun.wait(60.0)
    post_processor.close()
    asking.join(60.0)
    assert reported == ["the station is stopping"]
    assert processes.far_end is not None
    assert processes.far_end.recv(1) == b""  # whoever works there learns of it
    processes.far_end.close()
    with pytest.raises(StoreError, match="stopping"):
        post_processor.smoothed(incident)
