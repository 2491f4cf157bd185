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


class ReplayJob(msgspec.Struct, frozen=True, tag="replay"):
    """Job: replay a window of the log for one user's consoles."""

    log: str
    checkpoints: str
    incident_id: str
    start_ns: int
    end_ns: int
    speed: float
    known_segments: tuple[KnownSegment, ...] = ()  # as in the database
    archived: ArchivedLog | None = None  # log that is read instead of the station's own


class PostProcessingJob(msgspec.Struct, frozen=True, tag="look_back"):
    """Job: post-process an incident, and save the result."""

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
    archived: ArchivedLog | None = None  # log that is read instead of the station's own


class ReportJob(msgspec.Struct, frozen=True, tag="report"):
    """Job: write the report on an incident."""

    log: str
    database: str
    incident_id: str
    opened_ns: int
    closed_ns: int | None
    as_pdf: bool
    known_segments: tuple[KnownSegment, ...] = ()  # as in the database
    archived: ArchivedLog | None = None  # log that is read instead of the station's own


class RehearsalJob(msgspec.Struct, frozen=True, tag="rehearse"):
    """Job: rehearse alarm thresholds over an incident."""

    log: str
    checkpoints: str
    database: str
    incident_id: str
    opened_ns: int
    closed_ns: int | None
    points: tuple[Thresholds, ...]
    swept: str  # the threshold that a sweep changes; empty: it is none
    known_segments: tuple[KnownSegment, ...] = ()  # as in the database
    archived: ArchivedLog | None = None  # log that is read instead of the station's own


class CatchUpJob(msgspec.Struct, frozen=True, tag="catch_up"):
    """Job: write the tables from the log, from a time on."""

    log: str
    checkpoints: str
    database: str
    since_ns: int  # station time
    known_segments: tuple[KnownSegment, ...] = ()  # as in the database


class TimelineJob(msgspec.Struct, frozen=True, tag="timeline"):
    """Job: read the timeline of a unit."""

    log: str
    database: str
    unit_id: str
    from_ns: int
    until_ns: int
    buckets: int
    known_segments: tuple[KnownSegment, ...] = ()  # as in the database
    archived: tuple[ArchivedPart, ...] = ()  # of which the station's own log has no more


class ArchiveJob(msgspec.Struct, frozen=True, tag="archive"):
    """Job: copy the closed incidents into an archive."""

    log: str
    database: str
    location: str  # of the archive
    has_radio: bool  # with the audio of the radio channels


Job = (
    ReplayJob | PostProcessingJob | ReportJob | RehearsalJob | CatchUpJob | TimelineJob | ArchiveJob
)


def read_job(encoded: bytes) -> Job:
    job: Job = msgspec.msgpack.decode(encoded, type=Job)
    return job
