"""The tables.  Times are integer nanoseconds since 1970 (station time), hashes are hex.

A table is either a *projection*, which ``muster base rebuild`` makes again from the log, or
*kept*: people, users, sessions, tokens, what is over of these, and the audit are nowhere else.
"""

from __future__ import annotations

from base_station.storage.db.models.accounts import (
    ApiToken,
    AuditEntry,
    LoginSession,
    LoginTransferTicket,
    User,
)
from base_station.storage.db.models.alarms import AlarmRow, AlarmTransition
from base_station.storage.db.models.archive import (
    OUTDATED_NS,
    ArchivedIncident,
    ArchivedObject,
    ArchivedRange,
)
from base_station.storage.db.models.base import Base
from base_station.storage.db.models.incidents import (
    DispatchRow,
    ImportRow,
    IncidentMember,
    IncidentRow,
)
from base_station.storage.db.models.log_segments import LogSegment
from base_station.storage.db.models.replication import LostTable, Tombstone
from base_station.storage.db.models.roster import Assignment, PersonRow, Unit
from base_station.storage.db.models.search import IndexedIncident, SearchTerm
from base_station.storage.db.models.site import AnchorRow, BaseMap, PlanRow, UnitStart
from base_station.storage.db.models.tracks import (
    IncidentTrails,
    PostProcessingCache,
    SmoothedIncident,
    TrackPoint,
)

PROJECTIONS: tuple[type[Base], ...] = (
    Unit,
    IncidentRow,
    IncidentMember,
    DispatchRow,
    ImportRow,
    Assignment,
    AlarmRow,
    AlarmTransition,
    TrackPoint,
    AnchorRow,
    PlanRow,
    UnitStart,
    SmoothedIncident,
    IncidentTrails,
    PostProcessingCache,
    IndexedIncident,
    SearchTerm,
    LogSegment,
)

__all__ = [
    "OUTDATED_NS",
    "PROJECTIONS",
    "AlarmRow",
    "AlarmTransition",
    "AnchorRow",
    "ApiToken",
    "ArchivedIncident",
    "ArchivedObject",
    "ArchivedRange",
    "Assignment",
    "AuditEntry",
    "Base",
    "BaseMap",
    "DispatchRow",
    "ImportRow",
    "IncidentMember",
    "IncidentRow",
    "IncidentTrails",
    "IndexedIncident",
    "LogSegment",
    "LoginSession",
    "LoginTransferTicket",
    "LostTable",
    "PersonRow",
    "PlanRow",
    "PostProcessingCache",
    "SearchTerm",
    "SmoothedIncident",
    "Tombstone",
    "TrackPoint",
    "Unit",
    "UnitStart",
    "User",
]
