"""Messages between a station and a process that looks at the past for it (msgpack)."""

from __future__ import annotations

import select
import socket
import struct
from contextlib import suppress
from threading import Lock

import msgspec

from base_station.core.alarms.thresholds import Thresholds
from base_station.replay.rehearsal.report import RehearsalReport
from base_station.replay.timelines.unit_timeline import UnitTimeline
from base_station.storage.db.known_people import KnownPerson
from base_station.storage.missing_segments import KnownSegment
from base_station.views.wire import ReplayView
from shared.coded_text import NO_CODE, TextCode, code_of_text, coded, text_of_error, text_with_code
from shared.errors import MemoryLimitError, MusterError, StoreError

_LENGTH = struct.Struct("<Q")  # before each message


class ArchivedLog(msgspec.Struct, frozen=True):
    """A copy of an incident in an archive."""

    location: str  # of the archive
    entry: bytes  # its ``catalogue.json``


class ArchivedPart(msgspec.Struct, frozen=True):
    """Part of the log that is read in an archive: station times, ``until_ns`` excluded."""

    from_ns: int
    until_ns: int
    log: ArchivedLog


class ReplayJob(msgspec.Struct, frozen=True, tag="replay"):
    """First to a new process: the replay that it is to be."""

    log: str
    checkpoints: str
    incident_id: str
    start_ns: int
    end_ns: int
    speed: float
    known_segments: tuple[KnownSegment, ...] = ()  # as in the database
    archived: ArchivedLog | None = None  # read in the place of the station's own


class PostProcessingJob(msgspec.Struct, frozen=True, tag="look_back"):
    """First to a new process: to post-process an incident, and keep the result."""

    log: str
    checkpoints: str
    database: str
    incident_id: str
    opened_ns: int
    closed_ns: int | None
    late_data_ns: int
    now_ns: int  # station time
    memory_mb: int  # of its own, at most
    known_segments: tuple[KnownSegment, ...] = ()  # as in the database
    archived: ArchivedLog | None = None  # read in the place of the station's own


class ReportJob(msgspec.Struct, frozen=True, tag="report"):
    """First to a new process: to write the report on an incident."""

    log: str
    database: str
    incident_id: str
    opened_ns: int
    closed_ns: int | None
    as_pdf: bool
    known_segments: tuple[KnownSegment, ...] = ()  # as in the database
    archived: ArchivedLog | None = None  # read in the place of the station's own


class RehearsalJob(msgspec.Struct, frozen=True, tag="rehearse"):
    """First to a new process: to rehearse thresholds over an incident."""

    log: str
    checkpoints: str
    database: str
    incident_id: str
    opened_ns: int
    closed_ns: int | None
    points: tuple[Thresholds, ...]
    swept: str  # the threshold that a sweep changes; empty: it is none
    known_segments: tuple[KnownSegment, ...] = ()  # as in the database
    archived: ArchivedLog | None = None  # read in the place of the station's own


class CatchUpJob(msgspec.Struct, frozen=True, tag="catch_up"):
    """First to a new process: to project the log from some time on into the tables."""

    log: str
    checkpoints: str
    database: str
    since_ns: int  # station time
    known_segments: tuple[KnownSegment, ...] = ()  # as in the database


class TimelineJob(msgspec.Struct, frozen=True, tag="timeline"):
    """First to a new process: to read the timeline of a unit."""

    log: str
    database: str
    unit_id: str
    from_ns: int
    until_ns: int
    buckets: int
    known_segments: tuple[KnownSegment, ...] = ()  # as in the database
    archived: tuple[ArchivedPart, ...] = ()  # of which the station's own log has no more


class ArchiveJob(msgspec.Struct, frozen=True, tag="archive"):
    """First to a new process: to copy the incidents that are closed into an archive."""

    log: str
    database: str
    location: str  # of the archive
    has_radio: bool  # with the audio of the radio channels


class Play(msgspec.Struct, frozen=True, tag="play"):
    pass


class Pause(msgspec.Struct, frozen=True, tag="pause"):
    pass


class Seek(msgspec.Struct, frozen=True, tag="seek"):
    t_ns: int


class SetSpeed(msgspec.Struct, frozen=True, tag="speed"):
    speed: float


class People(msgspec.Struct, frozen=True, tag="people"):
    """People by the person ids of the log."""

    known: dict[str, KnownPerson]


class SnapshotRequest(msgspec.Struct, frozen=True, tag="snapshot"):
    pass


class DeltaFrame(msgspec.Struct, frozen=True, tag="delta"):
    whole: bytes  # as consoles get it that ask for whole units
    changes: bytes  # as those get it that ask for changed fields
    redrawn: tuple[str, ...]  # the units whose whole trail it has


class SnapshotFrame(msgspec.Struct, frozen=True, tag="picture"):
    encoded: bytes
    trails: dict[str, bytes]  # by unit: its points, encoded
    requested: bool  # else everybody begins again


class ViewFrame(msgspec.Struct, frozen=True, tag="view"):
    """View of the replay after so many commands; sent before the frames that it describes."""

    view: ReplayView
    commands: int


class Damage(msgspec.Struct, frozen=True, tag="damage"):
    """A part of the log cannot be read."""

    what: str


class ProgressFrame(msgspec.Struct, frozen=True, tag="progress"):
    done: float


class UnitTrailsFrame(msgspec.Struct, frozen=True, tag="trails"):
    """Result that was not kept (``base_station.storage.db.smoothed.packed``)."""

    unit_id: str
    smoothed: bytes | None
    raw: bytes | None


class PostProcessingResultFrame(msgspec.Struct, frozen=True, tag="looked_back"):
    """The last message, where all was worked out."""

    made_ns: int
    report: bytes
    is_kept: bool


class ReportFrame(msgspec.Struct, frozen=True, tag="reported"):
    """The last message: the report as a file."""

    content: bytes


class RehearsalFrame(msgspec.Struct, frozen=True, tag="rehearsed"):
    """The last message: the outcome of the rehearsal."""

    report: RehearsalReport


class CaughtUp(msgspec.Struct, frozen=True, tag="caught_up"):
    """The last message: the log is projected to where it ended."""


class CopyFrame(msgspec.Struct, frozen=True, tag="copied"):
    """An incident is in the archive, and was read there."""

    incident_id: str
    damage: tuple[str, ...]  # unreadable parts of the station's log


class CopiesDone(msgspec.Struct, frozen=True, tag="copies_done"):
    """The last message: all that was due is in the archive."""


class TimelineFrame(msgspec.Struct, frozen=True, tag="timeline_read"):
    """The last message: the timeline."""

    timeline: UnitTimeline


class Failure(msgspec.Struct, frozen=True, tag="failure"):
    """The last message: why there is no more, as a sentence for a person."""

    reason: str
    is_memory: bool  # there is not enough of it, nor would there be the next time
    code: TextCode = NO_CODE  # of the reason

    @staticmethod
    def of(error: MusterError) -> Failure:
        return Failure(str(error), is_memory=False, code=code_of_text(text_of_error(error)))

    def error(self) -> StoreError:
        kind = MemoryLimitError if self.is_memory else StoreError
        return kind(text_with_code(self.reason, self.code))


Job = (
    ReplayJob | PostProcessingJob | ReportJob | RehearsalJob | CatchUpJob | TimelineJob | ArchiveJob
)
Command = Play | Pause | Seek | SetSpeed | People | SnapshotRequest
ReplayReport = DeltaFrame | SnapshotFrame | ViewFrame | Damage
PostProcessingReport = (
    ProgressFrame | UnitTrailsFrame | PostProcessingResultFrame | Damage | Failure
)
IncidentReportResult = ReportFrame | Damage | Failure
RehearsalResult = RehearsalFrame | Damage | Failure
CatchUpResult = CaughtUp | Damage | Failure
ArchiveReport = CopyFrame | CopiesDone | Damage | Failure
TimelineResult = TimelineFrame | Damage | Failure


class FrameChannel:
    """One end of a stream of messages; one thread reads, and any may call the rest."""

    def __init__(self, end: socket.socket) -> None:
        self._end = end
        self._sending = Lock()

    def send(
        self,
        message: Job
        | Command
        | ReplayReport
        | PostProcessingReport
        | ReportFrame
        | RehearsalFrame
        | CaughtUp
        | TimelineFrame
        | CopyFrame
        | CopiesDone,
    ) -> None:
        """Raises StoreError where the other end is gone."""
        encoded = msgspec.msgpack.encode(message)
        with self._sending:
            try:
                self._end.sendall(_LENGTH.pack(len(encoded)) + encoded)
            except OSError as error:
                raise StoreError(
                    coded("process-ended", "the other process has ended: {error}", error=str(error))
                ) from error

    def has_message(self, timeout_s: float) -> bool:
        """A message has come, or the other end is gone; waits for it."""
        poll = select.poll()  # not select, which knows only the first 1,024 files of a program
        poll.register(self._end, select.POLLIN)
        return bool(poll.poll(1000.0 * timeout_s))

    def receive(self) -> bytes | None:
        """The next message, waiting for it; None: the other end is gone."""
        length = self._bytes(_LENGTH.size)
        return None if length is None else self._bytes(_LENGTH.unpack(length)[0])

    def hang_up(self) -> None:
        """Shut down: readers at both ends find that the other one is gone."""
        with suppress(OSError):  # it is
            self._end.shutdown(socket.SHUT_RDWR)

    def stop_sending(self) -> None:
        """Shut down one direction: the other process ends, and ``receive`` waits for that."""
        with suppress(OSError):  # it has ended
            self._end.shutdown(socket.SHUT_WR)

    def close(self) -> None:
        """By who reads."""
        self._end.close()

    def _bytes(self, count: int) -> bytes | None:
        found = bytearray(count)
        view, begin = memoryview(found), 0
        while begin < count:
            try:
                came = self._end.recv_into(view[begin:])
            except OSError:
                return None
            if not came:
                return None
            begin += came
        return bytes(found)


def read_job(encoded: bytes) -> Job:
    job: Job = msgspec.msgpack.decode(encoded, type=Job)
    return job


def read_command(encoded: bytes) -> Command:
    command: Command = msgspec.msgpack.decode(encoded, type=Command)
    return command


def read_replay(encoded: bytes) -> ReplayReport:
    report: ReplayReport = msgspec.msgpack.decode(encoded, type=ReplayReport)
    return report


def read_post_processing_report(encoded: bytes) -> PostProcessingReport:
    report: PostProcessingReport = msgspec.msgpack.decode(encoded, type=PostProcessingReport)
    return report


def read_report_result(encoded: bytes) -> IncidentReportResult:
    result: IncidentReportResult = msgspec.msgpack.decode(encoded, type=IncidentReportResult)
    return result


def read_rehearsal_result(encoded: bytes) -> RehearsalResult:
    result: RehearsalResult = msgspec.msgpack.decode(encoded, type=RehearsalResult)
    return result


def read_catch_up(encoded: bytes) -> CatchUpResult:
    result: CatchUpResult = msgspec.msgpack.decode(encoded, type=CatchUpResult)
    return result


def read_archive_report(encoded: bytes) -> ArchiveReport:
    report: ArchiveReport = msgspec.msgpack.decode(encoded, type=ArchiveReport)
    return report


def read_timeline_result(encoded: bytes) -> TimelineResult:
    result: TimelineResult = msgspec.msgpack.decode(encoded, type=TimelineResult)
    return result
