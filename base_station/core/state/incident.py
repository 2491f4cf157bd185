"""An incident, and a dispatch that has opened none yet, as the pipeline keeps them."""

from __future__ import annotations

import msgspec

from base_station.core.state.site import OWN_SITE_ID
from base_station.core.work_limits import PAR_INTERVAL_S, WORK_LIMIT_S
from shared.messages.station import NoteDispatch


class Incident(msgspec.Struct, frozen=True):
    incident_id: str
    name: str
    opened_ns: int
    closed_ns: int | None = None
    par_interval_s: float = PAR_INTERVAL_S  # between two confirmations of a member
    work_limit_s: float = WORK_LIMIT_S  # of work, after which a member should rest
    site_id: str = OWN_SITE_ID  # its ground
    dispatch: NoteDispatch | None = None  # newest report of the dispatch from which it was opened

    @property
    def is_open(self) -> bool:
        return self.closed_ns is None


class Dispatch(msgspec.Struct, frozen=True):
    """Report of the dispatch centre about an incident that is not opened here."""

    report: NoteDispatch  # the newest
    received_ns: int  # station time of the first report
    is_dismissed: bool = False
