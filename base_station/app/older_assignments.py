"""Makes assignments anew that are records of an earlier version, which have the name in them.

Else the station would go on writing that name into the texts of alarms.
"""

from __future__ import annotations

from base_station.engine.ports import OperatorGate
from base_station.storage.db.roster import Roster
from shared.messages import STATION_ID
from shared.messages.station import Assign


class OlderAssignments:
    """For the station that leads, from one thread."""

    def __init__(self, roster: Roster, gate: OperatorGate) -> None:
        self._roster = roster
        self._gate = gate
        self._is_done = False

    def look(self) -> None:
        """Once in a run.  Assignments stay; names that only the log has stay there."""
        if self._is_done:
            return
        self._is_done = True
        for unit_id, person_id in self._roster.worn_by_name():
            self._gate.submit(STATION_ID, Assign(unit_id, person_id))
