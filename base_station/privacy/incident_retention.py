"""Retention of incidents: those that were closed long ago are erased by the station itself."""

from __future__ import annotations

import logging
from collections.abc import Callable

from base_station.privacy.erasure_queue import ErasureJob, ErasureQueue
from base_station.storage.db.records import Records
from shared.clock import NS_PER_S, Clock
from shared.errors import UserError

BY_RETENTION = "retention"  # as whose wish the audit has these erasures
POLL_INTERVAL_S = 60.0
_log = logging.getLogger(__name__)

EraseIncident = Callable[[str], ErasureJob]  # raises UserError where it has to wait


class IncidentRetention:
    """Erases one incident at a time, the oldest first, and none while another erasure is under way.

    An incident is erased again where messages of it came from a unit's journal since.  Each is
    tried once between two starts of the station, as what refuses it would refuse it again.
    """

    def __init__(
        self,
        keep_ns: int,
        records: Records,
        erasures: ErasureQueue,
        erase: EraseIncident,
        clock: Clock,
    ) -> None:
        self._keep_ns = keep_ns
        self._records, self._erasures, self._clock = records, erasures, clock
        self._erase = erase
        self._next_check_ns = 0
        self._tried: set[tuple[str, int]] = set()

    def request_next(self) -> None:
        """Request the erasure of the next incident that is due; the check is made once a minute,
        however often this is called.  Raises StoreError.
        """
        now_ns = self._clock.monotonic_ns()
        if now_ns < self._next_check_ns:
            return
        self._next_check_ns = now_ns + round(POLL_INTERVAL_S * NS_PER_S)
        if any(not one.state.is_over for one in self._erasures.all()):
            return
        closed_before_ns = self._clock.utc_ns() - self._keep_ns
        due = self._records.incidents_to_erase(closed_before_ns)
        first = next((one for one in due if one not in self._tried), None)
        if first is None:
            return
        incident_id, _ = first
        try:
            self._erase(incident_id)
        except UserError as refusal:
            _log.info("incident %s is to be erased, and waits: %s", incident_id, refusal)
            return
        self._tried.add(first)
        _log.info("incident %s is older than incidents are kept: it is erased", incident_id)
