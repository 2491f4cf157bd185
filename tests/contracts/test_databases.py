"""Contract of a database file and a database server: writes, refusals and repeated writes."""

from __future__ import annotations

import math
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Any

import msgspec
import pytest
from alembic import command

from base_station.accounts.principals import Role
from base_station.core.erasure.erasure import Erasure, Wearing
from base_station.storage.db.accounts import Accounts
from base_station.storage.db.alembic_migration import alembic_config
from base_station.storage.db.database import Database
from base_station.storage.db.erasure import forget_in
from base_station.storage.db.models import Base
from base_station.storage.db.projecting import project_into
from base_station.storage.db.projection import SqlProjection
from base_station.storage.db.records import Records, TrackSample
from base_station.storage.db.replicated_tables import ReplicatedTables
from base_station.storage.db.roster import Roster
from base_station.storage.db.server_store import ServerStore
from base_station.storage.db.smoothed import SmoothedTracks
from base_station.storage.db.store import Store
from base_station.storage.db.table_copy import copy_tables_of
from base_station.storage.db.window import EVER, FOREVER_NS, Window
from base_station.storage.projection import Projection
from shared.clock import NS_PER_S, ManualClock
from shared.errors import UserError
from shared.messages.station import OpenIncident, RegisterUnit
from tests.contracts.conftest import DATABASE_KINDS, NewDatabase
from tests.rig.database_server import DatabaseServer
from tests.rig.projected_story import STORY, acted, fused
from tests.rig.quick_hash import QUICK_HASH
from tests.rig.waiting import until

ALL = Window(0, FOREVER_NS)


@pytest.fixture
def store(new: NewDatabase) -> Database:
    return new()


def test_tables_are_those_of_the_models(store: Database) -> None:
    with store.write() as session:
        project_into(session, STORY)
    assert isinstance(store, Store | ServerStore)
    with store.engine.connect() as connection:
        command.check(alembic_config(connection))  # raises where models and migrations differ


def contents(store: Database) -> dict[str, list[Any]]:
    with store.read() as session:
        return {
            name: sorted(map(repr, session.execute(table.select())))
            for name, table in Base.metadata.tables.items()
        }


def test_story_is_projected_into_the_tables(store: Database, clock: ManualClock) -> None:
    projection = SqlProjection(store)
    for part in STORY:
        projection.project(part)
    assert projection.flush()
    roster, records = Roster(store, clock), Records(store, clock)
    assert [unit.unit_id for unit, _ in roster.units()] == ["FF-01", "FF-02", "FF-03"]
    assert [unit.registered_ns is not None for unit, _ in roster.units()] == [True, True, False]
    worn = [(one.unit_id, one.from_ns, one.until_ns) for one in roster.assignments(0, FOREVER_NS)]
    second = NS_PER_S
    assert worn == [("FF-01", 3 * second, 7 * second), ("FF-02", 7 * second, 9 * second)]
    (incident,) = records.incidents()
    assert (incident.opened_ns, incident.closed_ns) == (2 * second, 10 * second)
    (stands,) = records.alarms(ALL)
    assert (stands.state, stands.by) == ("acknowledged", "mia")
    assert [one.state for one in records.alarm_life(stands.alarm_id)] == ["raised", "acknowledged"]
    assert [point.north_m for point in records.track("FF-01", ALL)] == [1.0, 2.0]
    projection.close()


def test_repeated_projection_of_the_log_changes_nothing(
    store: Database, clock: ManualClock
) -> None:
    projection = SqlProjection(store)
    for part in STORY:
        projection.project(part)
    projection.flush()
    before = contents(store)
    for part in STORY:
        projection.project(part)
    projection.flush()
    assert contents(store) == before

    Records(store, clock).forget_projections()
    for part in STORY:
        projection.project(part)
    projection.close()
    assert contents(store) == before


def test_wait_for_decisions_does_not_wait_for_positions(store: Database) -> None:
    projection = SqlProjection(store)
    with store.write():  # nothing else is written
        projection.project(
            Projection(NS_PER_S, tracks=(fused(1.0, 1.0),), last_messages=(("FF-01", 1),))
        )
        assert projection.flush_soon()()
        projection.project(acted(2, RegisterUnit("FF-01", "one")))
        is_over = projection.flush_soon()
        projection.project(acted(3, RegisterUnit("FF-02", "two")))
        assert not is_over()
    until(is_over, "the action is in the table")
    projection.close()


def test_failing_projection_is_reported_and_delays_no_other(
    store: Database, clock: ManualClock, monkeypatch: pytest.MonkeyPatch
) -> None:
    projection = SqlProjection(store)
    with monkeypatch.context() as broken:
        broken.setattr("base_station.storage.db.projection.project_into", _break)
        projection.project(STORY[0])
        assert projection.flush()
    projection.project(STORY[1])
    assert projection.flush()
    assert "muster base rebuild" in projection.problem()
    assert [one.incident_id for one in Records(store, clock).incidents()] == ["i-1"]
    projection.close()


def test_change_that_no_table_can_hold_is_lost_alone(store: Database, clock: ManualClock) -> None:
    impossible = Projection(6 * NS_PER_S, tracks=(fused(5.2, math.nan),))
    projection = SqlProjection(store)
    with store.write():  # until all of it waits
        for part in (STORY[0], impossible, *STORY[1:]):
            projection.project(part)
    assert projection.flush()
    assert "1 changes did not get into the database" in projection.problem()
    assert "muster base rebuild" in projection.problem()
    assert [one.incident_id for one in Records(store, clock).incidents()] == ["i-1"]
    assert [point.north_m for point in Records(store, clock).track("FF-01", ALL)] == [1.0, 2.0]
    projection.close()


def test_place_that_is_no_number_costs_only_its_own_row(
    store: Database, clock: ManualClock
) -> None:
    """Tables that are rebuilt from the log take ten seconds in one transaction."""
    tracks = (fused(5.2, math.nan), fused(6.2, 1.0), fused(7.2, math.nan))
    story = msgspec.structs.replace(acted(5.0, OpenIncident("i-9", "Mill Lane")), tracks=tracks)
    with store.write() as session:
        assert project_into(session, (story,)) == 2
    assert [one.incident_id for one in Records(store, clock).incidents()] == ["i-9"]
    assert [point.north_m for point in Records(store, clock).track("FF-01", ALL)] == [1.0]


def _break(*_: object) -> None:
    raise ZeroDivisionError


def test_text_that_a_database_cannot_hold_costs_no_row(store: Database, clock: ManualClock) -> None:
    label = "one\0two"
    with store.write() as session:
        project_into(session, (acted(1, RegisterUnit("FF-01", label)), *STORY[1:]))
    (unit, *_), *_ = Roster(store, clock).units()
    assert unit.label in {label, "one\ufffdtwo"}
    assert Records(store, clock).incidents()


def test_long_track_is_thinned_and_found_in_its_window(store: Database, clock: ManualClock) -> None:
    month_s = 30 * 86_400
    times_s = (*range(100, 110), *range(month_s, month_s + 10), 20 * month_s)
    tracks = tuple(fused(t_s + 0.5, float(t_s)) for t_s in times_s)
    with store.write() as session:
        project_into(session, (Projection(1, tracks=tracks, last_messages=(("FF-01", 7),)),))
        project_into(session, (Projection(2, tracks=tracks, last_messages=(("FF-01", 5),)),))
    records = Records(store, clock)
    assert [one.north_m for one in records.track("FF-01", ALL)] == list(map(float, times_s))
    window = Window(month_s * NS_PER_S, (month_s + 10) * NS_PER_S)
    assert [one.north_m - month_s for one in records.track("FF-01", window, 5)] == [0.0, 5.0]
    assert records.track_units(window) == ["FF-01"]
    assert records.track_units(Window(0, NS_PER_S)) == []
    ((unit, _),) = Roster(store, clock).units()
    assert unit.last_heard_ns == 7


def test_failed_transaction_leaves_nothing(store: Database, clock: ManualClock) -> None:
    with suppress(ZeroDivisionError), store.write() as session:
        project_into(session, STORY)
        _break()
    assert Roster(store, clock).units() == []


def test_users_log_in_and_are_locked_out(store: Database, clock: ManualClock) -> None:
    accounts = Accounts(store, clock, QUICK_HASH)
    accounts.add_user("ada", "a long password", Role.ADMINISTRATOR)
    session = accounts.log_in("ada", "a long password")
    assert session is not None
    _, token = accounts.add_token("ada", "cot", Role.VIEWER, None)
    ticket = accounts.create_login_ticket(session)
    assert ticket is not None
    assert accounts.redeem_login_ticket(ticket) is not None
    assert accounts.open_sessions() == {"ada": 2}
    assert accounts.of_token(token) is not None
    with pytest.raises(UserError, match="only administrator"):
        accounts.remove_user("ada")
    accounts.change_user("ada", "another long password", None)
    assert accounts.of_session(session) is None
    assert accounts.of_token(token) is None
    accounts.add_user("bo", "a long password", Role.ADMINISTRATOR)
    accounts.remove_user("ada")
    assert [one.username for one in accounts.users()] == ["bo"]


def test_post_processing_result_of_an_incident_is_kept_and_replaced(store: Database) -> None:
    kept = SmoothedTracks(store)
    point = TrackSample(1, 2.0, 3.0, 4.0, 0.1, 0.1, 0.1, 0.5, None, "good")
    for made_ns in (1, 2):
        assert kept.put("i-1", "smoother", made_ns, {"FF-01": [point]}, {"FF-02": [point]}, b"r")
    made = kept.of("i-1")
    assert made is not None
    assert (made[:2], dict(made[2])) == (("smoother", 2), {"FF-01": [point]})
    assert dict(kept.raw("i-1") or {}) == {"FF-02": [point]}
    assert kept.report("i-1") == b"r"


def test_person_is_erased_and_the_database_compacted(store: Database, clock: ManualClock) -> None:
    roster, records = Roster(store, clock), Records(store, clock)
    person = roster.add_person("Ada", "A", "", "")
    records.audit("chief", "AddedPerson", f"{person.person_id} Ada")
    with store.write() as session:
        project_into(session, STORY)
        worn = (Wearing("FF-01", 0, 6 * NS_PER_S),)
        forget_in(session, Erasure(worn, ("Ada",), person.person_id))
    store.compact()
    assert [one.north_m for one in records.track("FF-01", ALL)] == [2.0]
    assert roster.people() == []
    assert "Ada" not in str(contents(store)["audit"])
    assert records.audited([""]) is not None


def test_station_copies_users_people_and_audit_of_the_other(
    new: NewDatabase, clock: ManualClock
) -> None:
    active, standby = new(), new()
    Accounts(active, clock, QUICK_HASH).add_user("ada", "a long password", Role.COMMANDER)
    Roster(active, clock).add_person("Ada", "A", "")
    Records(active, clock).audit("chief", "Looked", "")
    one, other = ReplicatedTables(active), ReplicatedTables(standby)
    for _ in range(2):
        other.copy(one.read())
        other.add_audit(one.audit_behind(0, 10))
    assert other.read() == one.read()
    assert len(Records(standby, clock).audit_entries(EVER)) == 1
    other.note_lost(["people"])
    assert other.restore_lost_rows(one.read()) == ()


@pytest.mark.parametrize("to", DATABASE_KINDS)
def test_copy_of_all_tables_is_complete_and_usable(
    store: Database,
    to: str,
    tmp_path: Path,
    clock: ManualClock,
    request: pytest.FixtureRequest,
) -> None:
    Accounts(store, clock, QUICK_HASH).add_user("ada", "a long password", Role.COMMANDER)
    Roster(store, clock).add_person("Ada", "A", "")
    Records(store, clock).audit("chief", "Looked", "")
    with store.write() as session:
        project_into(session, STORY)
    with ExitStack() as closing:
        target: Database = Store(tmp_path / "copy.sqlite")
        if to == "server":
            server: DatabaseServer = request.getfixturevalue("server")
            target = ServerStore(server.new_database(tmp_path))
        closing.enter_context(target)
        copy_tables_of(store, target)
        assert contents(target) == contents(store)
        Records(target, clock).audit("chief", "Looked", "again")
        assert len(Records(target, clock).audit_entries(EVER)) == len(contents(store)["audit"]) + 1
