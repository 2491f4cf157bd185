"""Events of stations are stored once, in any order and number of deliveries, in a file and on a
server.
"""

from __future__ import annotations

import msgspec
import pytest

from base_station.department_wire import (
    AlarmEvent,
    Event,
    EventBatch,
    EventBody,
    IncidentEvent,
    PersonEvent,
    pack,
)
from base_station.storage.db.database import Database
from base_station.storage.db.department_models import DepartmentSchema
from base_station.storage.db.department_tables import DepartmentTables, Reported
from shared.errors import StoreError, WireError
from tests.contracts.conftest import NewDatabase


@pytest.fixture
def store(new: NewDatabase) -> Database:
    return new()


@pytest.fixture
def tables(store: Database) -> DepartmentTables:
    return DepartmentTables(store)


def alarm(state: str, changed_ms: int) -> AlarmEvent:
    return AlarmEvent("a1", "fall", "FF-01", 1, state, "", "{person p1} fell", "", 1, changed_ms)


def event(seq: int, event_id: str, body: EventBody) -> Event:
    return Event(seq, event_id, 1000 + seq, msgspec.Raw(pack(body)))


def take(
    tables: DepartmentTables,
    *events: Event,
    epoch: int = 7,
    after_seq: int = 0,
    dropped_seq: int = 0,
) -> Reported:
    return tables.take("engine-7", EventBatch(epoch, 0, after_seq, events, dropped_seq), 5, 9)


def test_repeated_batch_changes_nothing(tables: DepartmentTables) -> None:
    first = event(1, "a", alarm("raised", 10)), event(2, "b", alarm("resolved", 20))
    assert take(tables, *first) == Reported(2, 2, ())
    assert take(tables, *first) == Reported(2, 0, ())
    anna = PersonEvent("p1", "Anna Berg", "", "")
    later = event(3, "c", anna)
    assert take(tables, *first, later, after_seq=2) == Reported(3, 1, (anna,))
    assert [one.event_id for one in tables.events(None, 10)] == ["c", "b", "a"]
    assert tables.missing() == {}
    assert tables.open_alarms(10) == ([], 0)
    names = {key: one.name for key, one in tables.people().items()}
    assert names == {("engine-7", "p1"): "Anna Berg"}
    (person, *_) = tables.events(None, 1)
    assert person.body == b""  # a name stands in its own table alone


def test_same_events_of_the_other_machine_of_a_pair_are_stored_once(
    tables: DepartmentTables,
) -> None:
    take(tables, event(1, "a", alarm("raised", 10)), event(2, "b", alarm("acknowledged", 20)))
    again = event(41, "a", alarm("raised", 10)), event(42, "d", alarm("raised", 15))
    assert take(tables, *again, epoch=8, dropped_seq=40).new == 1
    ((shown,), count) = tables.open_alarms(10)
    assert (shown.state, count) == ("acknowledged", 1)  # an older transition that came later
    assert tables.missing() == {}  # events that it dropped as a standby came from the other


def test_missing_numbers_are_counted(tables: DepartmentTables) -> None:
    take(tables, event(1, "a", alarm("raised", 10)))
    take(tables, event(4, "d", alarm("raised", 40)), after_seq=1)
    assert tables.missing() == {"engine-7": 2}
    take(tables, event(31, "e", alarm("raised", 50)), epoch=9, after_seq=30)
    assert tables.missing() == {"engine-7": 32}  # this database is older than its receipts


def test_closed_incident_stays_closed_and_open_ones_come_first(tables: DepartmentTables) -> None:
    take(
        tables,
        event(1, "a", IncidentEvent("i1", "Mill street", 10, 20)),
        event(2, "b", IncidentEvent("i1", "Mill street 4", 10, None)),
        event(3, "c", IncidentEvent("i2", "Harbour", 5, None)),
    )
    shown = [(one.incident_id, one.name, one.closed_ms) for one in tables.incidents(10)]
    assert shown == [("i2", "Harbour", None), ("i1", "Mill street 4", 20)]


def test_event_of_a_newer_station_is_kept_and_a_damaged_one_stores_nothing(
    tables: DepartmentTables,
) -> None:
    newer = Event(1, "a", 1, msgspec.Raw(msgspec.msgpack.encode({"type": "drone", "x": 1})))
    assert take(tables, newer).new == 1
    damaged = Event(3, "c", 1, msgspec.Raw(msgspec.msgpack.encode({"type": "par", "x": 1})))
    with pytest.raises(WireError):
        take(tables, event(2, "b", alarm("raised", 10)), damaged)
    assert [one.event_id for one in tables.events(None, 10)] == ["a"]


def test_tables_of_a_newer_program_are_refused(store: Database, tables: DepartmentTables) -> None:
    with store.write() as session:
        session.merge(DepartmentSchema(version=1)).version = 2
    with pytest.raises(StoreError, match="a newer Muster made them"):
        DepartmentTables(store)


def test_incidents_are_found_by_all_words_in_parts(tables: DepartmentTables) -> None:
    names = ("Öl fire at MILL Road", "öl spill", "Mill fire", "mill ÖL store")
    for seq, name in enumerate(names, start=1):
        closed_ms = None if name == "Mill fire" else 900
        incident = IncidentEvent(f"i{seq}", name, 100 * seq, closed_ms)
        take(tables, event(seq, f"e{seq}", incident), after_seq=seq - 1)

    def found(search: str, skip: int = 0, limit: int = 10) -> tuple[list[str], int]:
        rows, total = tables.find_incidents(search, skip, limit)
        return [one.incident_id for one in rows], total

    assert found("öl MILL") == (["i4", "i1"], 2)
    assert found("engine-7 mill") == (["i3", "i4", "i1"], 3)  # the open one first
    assert found("", skip=1, limit=2) == (["i4", "i2"], 4)
    assert found("%") == ([], 0)
