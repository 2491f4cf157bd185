"""Work of a process for replays and post-processing (``base_station.replay.processes``)."""

from __future__ import annotations

from pathlib import Path

import msgspec

from base_station.app.factories import project_since
from base_station.app.pipeline_factory import past_pipeline
from base_station.archive.copying import ArchiveCopier
from base_station.archive.partly_archived import opened_copy, partly_archived, without_archived
from base_station.archive.store import open_store
from base_station.engine.log_feed import FolderFeed, LogFeed
from base_station.fusion import FUSERS
from base_station.fusion.smoothing import SMOOTHERS
from base_station.radio.radio_log import RadioLog
from base_station.replay.playback import Archive
from base_station.replay.post_processing import PostProcessor
from base_station.replay.processes.frame_channel import FrameChannel
from base_station.replay.processes.jobs import (
    ArchivedLog,
    ArchiveJob,
    CatchUpJob,
    IncidentJob,
    Job,
    PostProcessingJob,
    RehearsalJob,
    ReplayJob,
    ReportJob,
    TimelineJob,
    WholeIncidentJob,
    read_job,
)
from base_station.replay.processes.post_processing_work import (
    StationTime,
    bounded,
    incident_of,
    lower_priority,
    post_process,
)
from base_station.replay.processes.replay_work import replay
from base_station.replay.processes.wire import (
    CaughtUp,
    CopiesDone,
    CopyFrame,
    Damage,
    Failure,
    RehearsalFrame,
    ReportFrame,
    TimelineFrame,
)
from base_station.replay.rehearsal.rehearse import Rehearser
from base_station.replay.timelines.unit_timeline import TimelineRequest, read_timeline
from base_station.report.data_collection import ReportSources, collect_report_data
from base_station.report.document import html_document
from base_station.report.pdf import pdf_document
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.opening import open_database
from base_station.storage.db.records import Records
from base_station.storage.db.roster import Roster
from base_station.storage.db.smoothed import SmoothedTracks
from base_station.storage.db.window import Window
from base_station.storage.imports import ImportFolder
from base_station.storage.log_defects import LogDefects
from base_station.views.text_code import coded_views
from shared.clock import SystemClock
from shared.errors import MusterError


def work(line: FrameChannel) -> None:
    """Do the first job that comes, until it is finished or the connection is closed."""
    encoded = line.receive()
    if encoded is None:
        return  # it is not wanted any more
    job = read_job(encoded)
    flaws = _flaws_of(job)

    def note_damage(what: str) -> None:
        if flaws.note_damage(what):
            line.send(Damage(str(what)))

    own = FolderFeed(Path(job.log), on_damage=note_damage)
    log = _log_of(job, own, flaws)
    match job:
        case ReplayJob():
            replay(job, _archive(job, log, flaws), SystemClock(), line)
        case PostProcessingJob():
            _post_process(job, _archive(job, log, flaws), line)
        case ReportJob():
            _report(job, log, flaws, line)
        case RehearsalJob():
            _rehearse(job, _archive(job, log, flaws), line)
        case CatchUpJob():
            _catch_up(job, _archive(job, log, flaws), line)
        case TimelineJob():
            _timeline(job, own, flaws, line)
        case ArchiveJob():
            _copy_incidents(job, own, line)


def _log_of(job: Job, own: FolderFeed, flaws: LogDefects) -> LogFeed:
    match job:
        case IncidentJob(archived=ArchivedLog() as archived):
            return opened_copy(archived, flaws)
    return own


def _archive(
    job: ReplayJob | PostProcessingJob | RehearsalJob | CatchUpJob, log: LogFeed, flaws: LogDefects
) -> Archive:
    return Archive(
        log.records,
        Checkpoints(Path(job.checkpoints)),
        past_pipeline,
        log.watch,
        flaws=flaws,
        check_next_chunk=flaws.check_next_chunk,
        note=flaws.note,
        console=log.everything,
    )


def _flaws_of(job: Job) -> LogDefects:
    log = Path(job.log)
    match job:
        case IncidentJob(archived=ArchivedLog()):
            return LogDefects(Path(job.incident_id))  # no folder of this machine
        case ArchiveJob():
            return LogDefects(log, (), is_written=True)
        case ReplayJob():
            return LogDefects(log, job.known_segments, is_written=True, until_ns=job.end_ns)
        case CatchUpJob():
            return LogDefects(log, (), is_written=True, from_ns=job.since_ns)
        case WholeIncidentJob():
            return LogDefects(
                log,
                job.known_segments,
                is_written=True,
                from_ns=job.opened_ns,
                until_ns=job.closed_ns,
            )
        case TimelineJob():
            return LogDefects(
                log,
                without_archived(job.known_segments, job.archived),
                is_written=True,
                from_ns=job.from_ns,
                until_ns=job.until_ns,
            )


def _post_process(job: PostProcessingJob, archive: Archive, line: FrameChannel) -> None:
    lower_priority(line)
    with bounded(job, line), open_database(Path(job.database)) as store:
        clock = StationTime(job.now_ns, SystemClock())
        post_processor = PostProcessor(archive, SMOOTHERS[0], SmoothedTracks(store), clock)
        post_process(job, post_processor, Records(store, clock).tracks_of(incident_of(job)), line)


def _catch_up(job: CatchUpJob, archive: Archive, line: FrameChannel) -> None:
    lower_priority(line)
    try:
        with open_database(Path(job.database)) as store:
            project_since(store, archive, job.since_ns)
        line.send(CaughtUp())
    except MusterError as error:
        line.send(Failure.of(error))


def _report(job: ReportJob, log: LogFeed, flaws: LogDefects, line: FrameChannel) -> None:
    lower_priority(line)
    try:
        with open_database(Path(job.database)) as store:
            clock = SystemClock()
            records = Records(store, clock)
            sources = ReportSources(
                records=records,
                roster=Roster(store, clock),
                kept=SmoothedTracks(store),
                log=log,
                imports=ImportFolder(DataFolder(Path(job.log).parent).imports),
                defects=flaws,
                recorded_until_ns=DataFolder(Path(job.log).parent).recorded_until_ns,
            )
            page = html_document(
                collect_report_data(sources, records.require_incident(job.incident_id))
            )
        line.send(ReportFrame(pdf_document(page) if job.as_pdf else page))
    except MusterError as error:
        line.send(Failure.of(error))


def _rehearse(job: RehearsalJob, archive: Archive, line: FrameChannel) -> None:
    lower_priority(line)
    try:
        with open_database(Path(job.database)) as store:
            records = Records(store, SystemClock())
            rehearser = Rehearser(
                lambda _: archive,
                FUSERS[0],
                records,
                DataFolder(Path(job.log).parent).recorded_until_ns,
            )
            incident = records.require_incident(job.incident_id)
            line.send(RehearsalFrame(rehearser.rehearse([incident], job.points, job.swept)))
    except MusterError as error:
        line.send(Failure.of(error))


def _copy_incidents(job: ArchiveJob, log: FolderFeed, line: FrameChannel) -> None:
    lower_priority(line)
    try:
        with open_database(Path(job.database)) as store:
            folder = DataFolder(Path(job.log).parent)
            copier = ArchiveCopier(
                open_store(job.location), store, log, SystemClock(), ImportFolder(folder.imports),
                RadioLog(folder.radio) if job.has_radio else None,
            )  # fmt: skip
            for done in copier.copy_due(lambda _: None):
                line.send(CopyFrame(done.incident_id, done.damage))
        line.send(CopiesDone())
    except MusterError as error:
        line.send(Failure.of(error))


def _timeline(job: TimelineJob, own: FolderFeed, flaws: LogDefects, line: FrameChannel) -> None:
    log = partly_archived(own, job.archived, flaws) if job.archived else own
    lower_priority(line)
    request = TimelineRequest(job.unit_id, Window(job.from_ns, job.until_ns), job.buckets)
    try:
        with open_database(Path(job.database)) as store:
            timeline = read_timeline(Records(store, SystemClock()), log, request)
            timeline = msgspec.structs.replace(
                timeline,
                defects=tuple(map(str, flaws())),
                defect_codes=coded_views(flaws()),
            )
        line.send(TimelineFrame(timeline))
    except MusterError as error:
        line.send(Failure.of(error))
