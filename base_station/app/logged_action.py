"""Logs an action in a folder on which no station runs, in the way the station would."""

from __future__ import annotations

import secrets

from base_station.storage.data_folder import DataFolder
from base_station.storage.db.database import Database
from base_station.storage.db.projecting import project_into
from base_station.storage.projection import Projection
from shared.channels import OPERATOR
from shared.clock import SystemClock
from shared.codec import encode
from shared.errors import LogError
from shared.header_factory import HeaderFactory
from shared.mcap_log import SegmentWriter
from shared.messages import STATION_ID, OperatorAction
from shared.messages.station import Action


def log_action(folder: DataFolder, store: Database, by: str, action: Action) -> None:
    """Log an action in a segment of its own after all others, and project it to the tables.  The
    folder is locked.

    Raises LogError if the disk does not take it.
    """
    clock = SystemClock()
    behind_all = max((one.end_ns for one in folder.segments()), default=0) + 1
    t_ns = max(clock.utc_ns(), behind_all)  # station time never goes back
    header = HeaderFactory(STATION_ID, secrets.randbits(63), clock).header()
    done = OperatorAction(header, f"{header.boot_id:016x}-{header.seq}", by, action)
    writer = SegmentWriter(folder.log)
    writer.write(t_ns, OPERATOR.key(STATION_ID), encode(done), urgent=True)
    writer.close()
    if writer.problem:
        raise LogError(writer.problem)
    with store.write() as session:
        project_into(session, (Projection(t_ns, actions=(done,)),))
