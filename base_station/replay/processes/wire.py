"""Commands to a process that works on the past for a station, and its answers (msgpack)."""

from __future__ import annotations

import msgspec

from base_station.replay.rehearsal.report import RehearsalReport
from base_station.replay.timelines.unit_timeline import UnitTimeline
from base_station.storage.db.known_people import KnownPerson
from base_station.views.wire import ReplayView
from shared.coded_text import NO_CODE, TextCode, code_of_text, text_of_error, with_code
from shared.errors import MemoryLimitError, MusterError, StoreError


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
    requested: bool  # by one console; else for all consoles, which drop what they show


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
    """Trails of a unit that were not saved (``base_station.storage.db.smoothed.packed``)."""

    unit_id: str
    smoothed: bytes | None
    raw: bytes | None


class PostProcessingResultFrame(msgspec.Struct, frozen=True, tag="looked_back"):
    """The last message: post-processing is complete."""

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
    """The last message: the reason for the failure, as a sentence for a person."""

    reason: str
    is_memory: bool  # too little of it; another attempt would fail too
    code: TextCode = NO_CODE  # of the reason

    @staticmethod
    def of(error: MusterError) -> Failure:
        return Failure(str(error), is_memory=False, code=code_of_text(text_of_error(error)))

    def error(self) -> StoreError:
        kind = MemoryLimitError if self.is_memory else StoreError
        return kind(with_code(self.reason, self.code))


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
