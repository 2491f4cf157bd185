"""Jobs for a process that works on the past for a station: the first message to it (msgpack)."""

from __future__ import annotations

import msgspec

from base_station.core.alarms.thresholds import Thresholds
from base_station.storage.missing_segments import KnownSegment


class ArchivedLog(msgspec.Struct, frozen=True):
    """A copy of an incident in an archive."""

    location: str  # of the archive
    entry: bytes  # its ``catalogue.json``


class ArchivedPart(msgspec.Struct, frozen=True):
    """Part of the log that is read in an archive: station times, ``until_ns`` excluded."""

    from_ns: int
    until_ns: int
    log: ArchivedLog


class LogJob(msgspec.Struct, frozen=True, kw_only=True):
    """Job on a station's log."""

    log: str  # its folder


class IncidentJob(LogJob, frozen=True, kw_only=True):
    """Job on the log of an incident."""

    incident_id: str
    known_segments: tuple[KnownSegment, ...] = ()  # as in the database
    archived: ArchivedLog | None = None  # log that is read instead of the station's own


class WholeIncidentJob(IncidentJob, frozen=True, kw_only=True):
    """Job on an incident from its beginning to its end."""

    database: str
    opened_ns: int
    closed_ns: int | None


class ReplayJob(IncidentJob, frozen=True, kw_only=True, tag="replay"):
    """Job: replay a window of the log for one user's consoles."""

    checkpoints: str
    start_ns: int
    end_ns: int
    speed: float


class PostProcessingJob(WholeIncidentJob, frozen=True, kw_only=True, tag="look_back"):
    """Job: post-process an incident, and save the result."""

    checkpoints: str
    late_data_ns: int
    now_ns: int  # station time
    memory_mb: int  # of its own, at most


class ReportJob(WholeIncidentJob, frozen=True, kw_only=True, tag="report"):
    """Job: write the report on an incident."""

    as_pdf: bool


class RehearsalJob(WholeIncidentJob, frozen=True, kw_only=True, tag="rehearse"):
    """Job: rehearse alarm thresholds over an incident."""

    checkpoints: str
    points: tuple[Thresholds, ...]
    swept: str  # the threshold that a sweep changes; empty: it is none


class CatchUpJob(LogJob, frozen=True, kw_only=True, tag="catch_up"):
    """Job: write the tables from the log, from a time on."""

    checkpoints: str
    database: str
    since_ns: int  # station time


class TimelineJob(LogJob, frozen=True, kw_only=True, tag="timeline"):
    """Job: read the timeline of a unit."""

    database: str
    unit_id: str
    from_ns: int
    until_ns: int
    buckets: int
    known_segments: tuple[KnownSegment, ...] = ()  # as in the database
    archived: tuple[ArchivedPart, ...] = ()  # of which the station's own log has no more


class ArchiveJob(LogJob, frozen=True, kw_only=True, tag="archive"):
    """Job: copy the closed incidents into an archive."""

    database: str
    location: str  # of the archive
    has_radio: bool  # with the audio of the radio channels


Job = (
    ReplayJob | PostProcessingJob | ReportJob | RehearsalJob | CatchUpJob | TimelineJob | ArchiveJob
)


def read_job(encoded: bytes) -> Job:
    job: Job = msgspec.msgpack.decode(encoded, type=Job)
    return job
