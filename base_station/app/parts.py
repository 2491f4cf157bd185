"""What more than one composition is made of."""

from __future__ import annotations

import logging
from collections.abc import Callable
from pathlib import Path

from base_station.accounts.first_login import USERNAME, ensure_administrator
from base_station.alarms import ALARMS
from base_station.api.hub import Hub
from base_station.api.replays import StartReplay
from base_station.checkpoint import Checkpoint
from base_station.db.accounts import Accounts
from base_station.db.models import Incident
from base_station.db.projecting import project_into
from base_station.db.records import Records
from base_station.db.roster import Roster
from base_station.db.store import Store
from base_station.feed import LogFeed
from base_station.fusion import FUSERS
from base_station.live.sinks import Projection
from base_station.past.past_pipeline import PastPipeline
from base_station.past.playback import Archive
from base_station.past.rebuild import project_log
from base_station.past.replay import ReplaySession, Window
from base_station.pipeline import StationPipeline
from base_station.storage.segment_index import SegmentIndex
from shared.clock import Clock, SystemClock
from shared.mcap_log import SegmentReader, segment_paths

_log = logging.getLogger(__name__)
Announce = Callable[[str], None]


def new_pipeline(checkpoint: Checkpoint | None) -> StationPipeline:
    """The live station's, which sees to its mistakes."""
    return StationPipeline(ALARMS, FUSERS[0], checkpoint)


def past_pipeline(checkpoint: Checkpoint | None) -> StationPipeline:
    return PastPipeline(ALARMS, FUSERS[0], checkpoint)


def replay_starter(
    archive: Archive, roster: Roster, clock: Clock, recorded_until_ns: Callable[[], int]
) -> StartReplay:
    """``recorded_until_ns``, in station time, is where an incident ends that is open."""

    def start(incident: Incident, speed: float, hub: Hub) -> ReplaySession:
        end_ns = incident.closed_ns or max(recorded_until_ns(), incident.opened_ns)
        window = Window(incident.incident_id, incident.opened_ns, end_ns)
        return ReplaySession(archive, window, speed, hub, roster.photo_url, clock)

    return start


def announce_first_login(accounts: Accounts, note: Path, announce: Announce) -> None:
    password = ensure_administrator(accounts, note)
    if password is not None:
        announce(f"first login: {USERNAME}  password: {password}  (also in {note})")


def project_whole_log(store: Store, log: Path, on_progress: Callable[[float], None]) -> int:
    """Cut short, it leaves a database that knows no segment of the log."""
    records = Records(store, SystemClock())
    records.forget_projections()
    segments = []
    for path in segment_paths(log):
        with SegmentReader(path) as reader:
            segments.append(reader.info())
    start_ns = min((one.start_ns for one in segments if one.messages), default=0)
    span_ns = max(max((one.end_ns for one in segments), default=0) - start_ns, 1)

    def write(projection: Projection) -> None:
        with store.write() as session:
            left_out = project_into(session, (projection,))
        if left_out:
            _log.warning("%d places of units are no numbers and are left out", left_out)

    count = project_log(
        LogFeed(log).records(),
        past_pipeline(None),
        write,
        lambda t_ns: on_progress(min(max((t_ns - start_ns) / span_ns, 0.0), 1.0)),
    )
    SegmentIndex(records, {}).update(segments)
    return count
