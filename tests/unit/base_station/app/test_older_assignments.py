"""Assignments of earlier versions with a name: made again without the name, once, and no others."""

from __future__ import annotations

from concurrent.futures import Future
from pathlib import Path

from base_station.app.older_assignments import OlderAssignments
from base_station.engine.ports import ActionResult
from base_station.storage.db.models import Assignment
from base_station.storage.db.roster import Roster
from base_station.storage.db.store import Store
from shared.clock import SystemClock
from shared.messages.station import Action, Assign


class Gate:
    def __init__(self) -> None:
        self.acted: list[tuple[str, Action]] = []

    def submit(self, by: str, action: Action, _action_id: str = "") -> Future[ActionResult]:
        self.acted.append((by, action))
        return Future()


def test_name_of_an_earlier_version_does_not_stay_in_force(tmp_path: Path) -> None:
    gate = Gate()
    with Store(tmp_path / "station.sqlite") as store:
        roster = Roster(store, SystemClock())
        ada = roster.add_person("Ada", "red", "").person_id
        worn = [
            ("FF-01", ada, "Ada", None), ("FF-02", ada, "Ada", 5), ("FF-03", ada, "", None),
            ("FF-04", "p-lost", "Bo", None),
        ]  # fmt: skip
        with store.write() as session:
            for unit_id, person_id, name, until_ns in worn:
                session.add(
                    Assignment(
                        action_id=unit_id, unit_id=unit_id, person_id=person_id, person_name=name,
                        crew="", role="", from_ns=1, until_ns=until_ns,
                    )
                )  # fmt: skip
        older = OlderAssignments(roster, gate)
        older.renew()
        older.renew()
    assert gate.acted == [("station", Assign("FF-01", ada))]
