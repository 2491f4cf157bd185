"""Parts of more than one composition root."""

from __future__ import annotations

import logging
from collections.abc import Callable
from pathlib import Path

from base_station.api.hub import Hub
from base_station.api.replays import StartReplay
from base_station.app.first_login import USERNAME, ensure_administrator
from base_station.app.pipeline_factory import past_pipeline
from base_station.engine.log_feed import FolderFeed
from base_station.replay.playback import Archive
from base_station.replay.processes.jobs import ArchivedLog
from base_station.replay.processes.replay_process import ReplayContext, ReplayProcess
from base_station.replay.rebuild import project_log
from base_station.replay.session import ReplaySession, ReplayWindow
from base_station.storage.db.accounts import Accounts
from base_station.storage.db.database import Database
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.projecting import project_into
from base_station.storage.db.records import Records
from base_station.storage.db.roster import Roster
from base_station.storage.projection import Projection
from base_station.storage.segment_index import SegmentIndex
from shared.channels import OPERATOR
from shared.clock import NS_PER_S, Clock, SystemClock
from shared.mcap_log import SegmentInfo, SegmentReader, own_segments
from shared.messages import STATION_ID

_log = logging.getLogger(__name__)
_OVERLAP_NS = 60 * NS_PER_S  # longer than the time of one projection
Announce = Callable[[str], None]


def replay_starter(
    archive: Archive, roster: Roster, clock: Clock, recorded_until_ns: Callable[[], int]
) -> StartReplay:
    """Return a function that starts replays in threads of this process.  ``recorded_until_ns``
    returns the station time up to which an open incident can be replayed.
    """

    def start(incident: IncidentRow, speed: float, hub: Hub) -> ReplaySession:
        window = _window_of(incident, recorded_until_ns)
        return ReplaySession(archive, window, speed, hub, roster.known, clock)

    return start


def replay_process_starter(
    place: ReplayContext,
    recorded_until_ns: Callable[[], int],
    instead_of_log: Callable[[IncidentRow], ArchivedLog | None],
) -> StartReplay:
    """Return a function that starts replays in processes of their own.  ``instead_of_log`` returns
    the copy of an incident whose log is not here; the caller who opens the replay gets its errors.
    """

    def start(incident: IncidentRow, speed: float, hub: Hub) -> ReplayProcess:
        window, archived = _window_of(incident, recorded_until_ns), instead_of_log(incident)
        return ReplayProcess(place, window, speed, hub, archived)

    return start


def _window_of(incident: IncidentRow, recorded_until_ns: Callable[[], int]) -> ReplayWindow:
    end_ns = incident.closed_ns or max(recorded_until_ns(), incident.opened_ns)
    return ReplayWindow(incident.incident_id, incident.opened_ns, end_ns)


def announce_first_login(accounts: Accounts, note: Path | None, announce: Announce) -> None:
    """Announce the first administrator's password.  ``note``: file that has it too; None if the
    disk did not take it.
    """
    password = ensure_administrator(accounts, note)
    if password is not None:
        where = "only here: the disk takes nothing" if note is None else f"also in {note}"
        announce(f"first login: {USERNAME}  password: {password}  ({where})")


def project_since(store: Database, archive: Archive, since_ns: int) -> None:
    """Project the log again from a time on; rows that are in the tables stay as they are."""

    def write(projection: Projection) -> None:
        if projection.t_ns >= since_ns - _OVERLAP_NS:
            with store.write() as session:
                project_into(session, (projection,))

    pipeline, records = archive.resume(since_ns - _OVERLAP_NS)
    project_log(records, pipeline, write, lambda _: None)


def project_whole_log(store: Database, log: Path, on_progress: Callable[[float], None]) -> int:
    """Project the whole log.  If it is interrupted, the database does not know any segment of the
    log.
    """
    records = Records(store, SystemClock())
    records.forget_projections()
    segments = _segments(log)
    start_ns = min((one.start_ns for one in segments if one.messages), default=0)
    span_ns = max(max((one.end_ns for one in segments), default=0) - start_ns, 1)
    count = project_log(
        FolderFeed(log).records(),
        past_pipeline(None),
        _writer(store),
        lambda t_ns: on_progress(min(max((t_ns - start_ns) / span_ns, 0.0), 1.0)),
    )
    SegmentIndex(records, {}).update(segments)
    return count


def project_actions(store: Database, log: Path) -> None:
    """Project operators' actions alone: incidents, their units and people, without positions and
    alarms.  Takes seconds at most, as no message of a unit is read.
    """
    actions = FolderFeed(log).records(keys={OPERATOR.key(STATION_ID)})
    project_log(actions, past_pipeline(None), _writer(store), lambda _: None)


def note_segments(store: Database, log: Path) -> None:
    """Note the segments of a log as projected."""
    SegmentIndex(Records(store, SystemClock()), {}).update(_segments(log))


def _writer(store: Database) -> Callable[[Projection], None]:
    def write(projection: Projection) -> None:
        with store.write() as session:
            left_out = project_into(session, (projection,))
        if left_out:
            _log.warning("%d places of units are no numbers and are left out", left_out)

    return write


def _segments(log: Path) -> list[SegmentInfo]:
    segments = []
    for path in own_segments(log)[0]:
        with SegmentReader(path) as reader:
            segments.append(reader.info())
    return segments
