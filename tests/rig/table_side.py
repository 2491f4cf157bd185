"""Database of one of two stations, whose tables without a log are replicated."""

from __future__ import annotations

from pathlib import Path

from base_station.security.pki.folder import PkiFolder
from base_station.storage.db.accounts import Accounts
from base_station.storage.db.base_maps import BaseMaps
from base_station.storage.db.records import Records
from base_station.storage.db.replicated_tables import ReplicatedTables
from base_station.storage.db.roster import Roster
from base_station.storage.db.store import Store
from base_station.storage.db.window import EVER
from shared.clock import ManualClock
from tests.rig.quick_hash import QUICK_HASH

PASSWORD = "correct horse battery"


class TableSide:
    """One station's database, as its console uses it."""

    def __init__(self, folder: Path, store: Store) -> None:
        self.clock = clock = ManualClock()
        self.tables = ReplicatedTables(store)
        self.accounts = Accounts(store, clock, QUICK_HASH)
        self.roster, self.records = Roster(store, clock), Records(store, clock)
        self.base_maps = BaseMaps(store)
        self.pki = PkiFolder(folder)

    def copy(self, other: TableSide) -> tuple[str, ...]:
        return self.tables.copy(other.tables.read())


def audit_of(side: TableSide) -> set[str]:
    return {one.detail for one in side.records.audit_entries(EVER)}
