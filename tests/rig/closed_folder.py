"""Data folder of a stopped station, in which an incident is closed afterwards."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

from base_station.engine.log_feed import FolderFeed
from shared.clock import NS_PER_S
from shared.mcap_log import SegmentWriter
from shared.messages.station import CloseIncident
from tests.rig.archived_station import succeeded
from tests.rig.station_script import START_NS, Script


def close_incident(data: Path, incident_id: str) -> None:
    """Close an incident one second after the last record, and rebuild the database."""
    records = list(FolderFeed(data / "log").records())
    script = Script()
    script.now_s = (records[-1][0] - START_NS) / NS_PER_S + 1.0
    script.act(CloseIncident(incident_id))
    with closing(SegmentWriter(data / "log")) as log:
        for record in script.records:
            log.write(*record)
    succeeded("rebuild", "--data", data)
