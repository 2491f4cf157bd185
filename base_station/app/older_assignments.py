"""Renews assignments that an earlier version recorded with the name of the person.

Otherwise the station would continue to write that name into the texts of alarms.
"""

from __future__ import annotations

from base_station.engine.ports import OperatorGate
from base_station.storage.db.roster import Roster
from shared.messages import STATION_ID
from shared.messages.station import Assign


class OlderAssignments:
    """Renewal by the leading station, from one thread."""

    def __init__(self, roster: Roster, gate: OperatorGate) -> None:
        self._roster = roster
        self._gate = gate
        self._is_done = False

    def renew(self) -> None:
        """Submit each such assignment again, once in a run.  Names that are in the log already are
        not changed.
        """
        if self._is_done:
            return
        self._is_done = True
        for unit_id, person_id in self._roster.worn_by_name():
            self._gate.submit(STATION_ID, Assign(unit_id, person_id))
