"""Post-processing of an incident in a process of its own.

The live station would stand still for it: it takes minutes of a long incident, and hundreds of
megabytes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from threading import Lock

from base_station.fusion.lazy_mapping import LastValueMapping
from base_station.fusion.smoothing.interface import Smoother
from base_station.replay.playback import Archive
from base_station.replay.post_processing import (
    PostProcessingResult,
    PostProcessor,
    Progress,
    Smoothed,
    read_report,
)
from base_station.replay.processes import frame_channel, jobs, wire
from base_station.replay.processes.server import STOPPING, ReplayProcesses
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.smoothed import SmoothedTracks, Tracks, unpacked
from base_station.storage.missing_segments import KnownSegment
from shared.clock import Clock
from shared.coded_text import coded
from shared.errors import StoreError

MEMORY_MB = 575  # mapped for data; of these 75 are not touched, so that some 500 are resident


@dataclass(frozen=True)
class PostProcessingContext:
    """Parts of the station that it needs."""

    processes: ReplayProcesses
    log: str
    checkpoints: str
    database: str
    prepare: Callable[[], object]  # brings recorded data to the disk
    note_damage: Callable[[str], None]  # of the log
    memory_mb: int = MEMORY_MB
    known_segments: Callable[[], Iterable[KnownSegment]] = tuple  # of the log, by the database
    # Copy in an archive of an incident whose log is not here; None: it is.
    instead_of_log: Callable[[IncidentRow], jobs.ArchivedLog | None] = lambda _: None


class PostProcessingProcess(PostProcessor):
    """Gives kept results; others are made by a process, one at a time."""

    def __init__(
        self,
        place: PostProcessingContext,
        archive: Archive,
        smoother: Smoother,
        store: SmoothedTracks,
        clock: Clock,
    ) -> None:
        super().__init__(archive, smoother, store, clock)
        self._place = place
        self._lock = Lock()  # guards the fields below
        self._line: frame_channel.FrameChannel | None = None  # to the process that is at work
        self._closed = False

    def smooth(self, incident: IncidentRow, on_progress: Progress = lambda _: None) -> Smoothed:
        made = self.post_process(incident, {}, on_progress)
        name = self._smoother.name
        return Smoothed(incident.incident_id, name, made.made_ns, made.smoothed, made.is_kept)

    def post_process(
        self,
        incident: IncidentRow,
        live: Tracks,  # noqa: ARG002  # the process reads the shown tracks by itself
        on_progress: Progress = lambda _: None,
    ) -> PostProcessingResult:
        """Raises StoreError where it was not done; MemoryLimitError, where it never will be;
        ArchiveError where the log is in an archive that does not answer.
        """
        with self._working:
            line = self._begin(incident)
            try:
                return self._follow(incident, line, on_progress)
            finally:
                with self._lock:
                    self._line = None
                line.hang_up()
                line.close()

    def close(self) -> None:
        """Cancels the work under way; its callers get an error."""
        with self._lock:
            self._closed = True
            if self._line is not None:
                self._line.hang_up()

    def _begin(self, incident: IncidentRow) -> frame_channel.FrameChannel:
        self._place.prepare()
        job = self._job(incident)  # may wait for an archive
        with self._lock:
            if self._closed:
                raise StoreError(STOPPING)
            self._line = self._place.processes.start(job)
            return self._line

    def _make_raw(self, incident: IncidentRow) -> Tracks:
        return self.post_process(incident, {}).raw

    def _job(self, incident: IncidentRow) -> jobs.PostProcessingJob:
        return jobs.PostProcessingJob(
            log=self._place.log,
            checkpoints=self._place.checkpoints,
            database=self._place.database,
            incident_id=incident.incident_id,
            opened_ns=incident.opened_ns,
            closed_ns=incident.closed_ns,
            late_data_ns=incident.late_data_ns or 0,
            now_ns=self._clock.utc_ns(),
            memory_mb=self._place.memory_mb,
            known_segments=tuple(self._place.known_segments()),
            archived=self._place.instead_of_log(incident),
        )

    def _follow(
        self, incident: IncidentRow, line: frame_channel.FrameChannel, on_progress: Progress
    ) -> PostProcessingResult:
        smoothed, raw = dict[str, bytes](), dict[str, bytes]()
        while (encoded := line.receive()) is not None:
            match wire.read_post_processing_report(encoded):
                case wire.ProgressFrame(done):
                    on_progress(done)
                case wire.UnitTrailsFrame(unit_id, of_unit, own):
                    smoothed |= {} if of_unit is None else {unit_id: of_unit}
                    raw |= {} if own is None else {unit_id: own}
                case wire.PostProcessingResultFrame() as made:
                    return self._made(incident, made, _tracks(smoothed), _tracks(raw))
                case wire.Damage(what):
                    self._place.note_damage(what)
                case wire.Failure() as failure:
                    raise failure.error()
        if self._closed:
            raise StoreError(STOPPING)
        raise StoreError(
            coded(
                "trails-process-ended",
                "what is known afterwards of {incident} was not worked out: the process that did "
                "so has ended; ask again",
                incident=incident.incident_id,
            )
        )

    def _made(
        self,
        incident: IncidentRow,
        made: wire.PostProcessingResultFrame,
        smoothed: Tracks,
        raw: Tracks,
    ) -> PostProcessingResult:
        report = read_report(made.report)
        if report is None:
            raise StoreError(
                coded(
                    "program-of-two-versions",
                    "another version of the program is at work; start the station again",
                )
            )
        kept = self._cached_trails(incident) if made.is_kept else None
        if kept is not None:
            smoothed, raw = kept.tracks, self._store.raw(incident.incident_id) or {}
        return PostProcessingResult(made.made_ns, smoothed, raw, report, made.is_kept)


def _tracks(packed: dict[str, bytes]) -> Tracks:
    return LastValueMapping(packed, lambda unit_id: unpacked(packed[unit_id]))
