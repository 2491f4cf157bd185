"""Tables without a log are the same at both stations; logins are in `test_login_replication`."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from threading import Event

import pytest

from base_station.accounts.principals import Role
from base_station.privacy.erasure_service import BY_OTHER_STATION
from base_station.site.base_map import Corners
from base_station.standby.table_replication import TableReplication, TableServer
from base_station.storage.db.store import Store
from base_station.storage.db.window import EVER
from shared.bus_memory import MemoryRouter
from shared.errors import StoreError
from tests.rig.table_side import PASSWORD, TableSide, audit_of


def test_local_entries_missing_at_the_leader_are_removed_and_reported(
    sides: tuple[TableSide, TableSide],
) -> None:
    active, standby = sides
    active.accounts.add_user("ada", PASSWORD, Role.ADMINISTRATOR)
    standby.accounts.add_user("mallory", PASSWORD, Role.ADMINISTRATOR)
    standby.accounts.add_token("mallory", "x", Role.VIEWER, None)
    dropped = standby.copy(active)
    assert [one.partition(" ")[0] for one in dropped] == ["user", "token"]
    assert [user.username for user in standby.accounts.users()] == ["ada"]


class Pair:
    """A leader and its standby in rounds, of which either may lose its database."""

    def __init__(self, leads: TableSide, follows: TableSide) -> None:
        router = MemoryRouter()
        self.taken_back: list[str] = []
        for name, side in (("leads", leads), ("follows", follows)):
            TableServer(name, router.attach_station(), side.tables, side.pki)
        self._rounds = [
            self._round(router, leads, None, "follows"),
            self._round(router, follows, "leads", "leads"),
        ]

    def run_rounds(self, rounds: int = 3) -> None:
        """The standby first, as it does where it has the leader's answer at once."""
        for _ in range(rounds):
            for one in reversed(self._rounds):
                one.run_round(Event())

    def _round(
        self, router: MemoryRouter, side: TableSide, leader: str | None, other: str
    ) -> TableReplication:
        return TableReplication(
            router.attach_station(),
            side.tables,
            side.pki,
            leader=lambda: leader,
            other=lambda: other,
            others_run=lambda: 1,
            caught_up=lambda: True,
            has_until=lambda _: True,
            on_people=side.roster.read_again,
            on_forgotten=lambda _: None,
            on_dropped=pytest.fail,
            on_restored_rows=self.taken_back.append,
        )


LOST = ("users", "api_tokens", "people", "base_map", "audit")


@pytest.mark.parametrize("loser", ["who leads", "who follows"])
def test_lost_tables_are_restored_from_the_other_station(
    tmp_path: Path, sides: tuple[TableSide, TableSide], loser: str
) -> None:
    had = sides[0]
    had.accounts.add_user("ada", PASSWORD, Role.ADMINISTRATOR)
    had.accounts.add_user("admin", PASSWORD, Role.VIEWER)
    login = had.accounts.log_in("ada", PASSWORD)
    _, token = had.accounts.add_token("ada", "cot", Role.VIEWER, None)
    person = had.roster.add_person("Ada", "red", "leader")
    had.roster.set_photo(person.person_id, b"jpeg", "hash")
    had.base_maps.put(b"webp", "map", Corners((1.0, 2.0), (1.0, 3.0), (0.0, 2.0)))
    had.records.audit("ada", "LoggedIn", "there")
    with Store(tmp_path / "new.sqlite") as store:
        lost = TableSide(tmp_path, store)
        lost.tables.note_lost(LOST)
        if loser == "who leads":
            lost.accounts.add_user("admin", "another battery", Role.ADMINISTRATOR, generated=True)
            lost.accounts.add_user("eve", PASSWORD, Role.VIEWER)  # entered since
        pair = Pair(*((lost, had) if loser == "who leads" else (had, lost)))
        pair.run_rounds()
        for one in (lost, had):
            names = {"ada", "admin", "eve"} if loser == "who leads" else {"ada", "admin"}
            assert {user.username for user in one.accounts.users()} == names
            assert one.accounts.log_in("admin", PASSWORD), "not the one that was made meanwhile"
            assert login is not None
            assert one.accounts.of_session(login)
            assert one.accounts.of_token(token)
            assert one.roster.photo(person.person_id) == (b"jpeg", "hash")
            assert one.base_maps.image("map") == b"webp"
            assert "there" in audit_of(one)
            assert one.tables.lost() == ()
    [reported] = pair.taken_back
    assert "user" in reported


def test_tables_lost_by_the_leader_are_kept_at_the_standby(
    sides: tuple[TableSide, TableSide],
) -> None:
    leads, follows = sides
    follows.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    follows.roster.add_person("Ada", "red", "leader")
    leads.accounts.add_user("admin", PASSWORD, Role.ADMINISTRATOR, generated=True)
    leads.tables.note_lost(["users", "api_tokens"])
    follows.copy(leads)
    assert [one.username for one in follows.accounts.users()] == ["ada"]
    assert follows.roster.people() == [], "of which it has lost none"
    leads.tables.restore_lost_rows(follows.tables.read())
    follows.copy(leads)
    for one in sides:
        assert [user.username for user in one.accounts.users()] == ["ada", "admin"]


def test_stations_that_both_lost_their_tables_agree_again(
    sides: tuple[TableSide, TableSide],
) -> None:
    leads, follows = sides
    leads.accounts.add_user("admin", PASSWORD, Role.ADMINISTRATOR, generated=True)
    for one in sides:
        one.tables.note_lost(LOST)
    Pair(leads, follows).run_rounds()
    for one in sides:
        assert one.tables.lost() == ()
        assert [user.username for user in one.accounts.users()] == ["admin"]


def copy_over_the_bus(
    active: TableSide,
    standby: TableSide,
    on_forgotten: Callable[[str], None] = lambda _: None,
    leader: str | None = "active",
) -> TableReplication:
    router = MemoryRouter()
    TableServer("active", router.attach_station(), active.tables, active.pki)
    return copy_from(router, standby, on_forgotten, leader=leader)


def copy_from(
    router: MemoryRouter,
    standby: TableSide,
    on_forgotten: Callable[[str], None] = lambda _: None,
    others_run: Callable[[], int] = lambda: 1,
    leader: str | None = "active",
) -> TableReplication:
    return TableReplication(
        router.attach_station(),
        standby.tables,
        standby.pki,
        leader=lambda: leader,
        other=lambda: "active",
        others_run=others_run,
        caught_up=lambda: True,
        has_until=lambda _: True,
        on_people=standby.roster.read_again,
        on_forgotten=on_forgotten,
        on_dropped=lambda _: None,
        on_restored_rows=lambda _: None,
    )


def test_audit_is_identical_with_different_clocks(
    sides: tuple[TableSide, TableSide],
) -> None:
    active, standby = sides
    copying = copy_over_the_bus(active, standby)
    standby.clock.advance(86_400.0)  # whoever acts here is a day ahead
    standby.records.audit("bob", "LoggedIn", "here")
    active.tables.add_audit(standby.tables.audit_behind(0, 9))
    copying.run_round(Event())
    for number in range(1200):  # more than come at once
        active.records.audit("ada", "LoggedIn", f"login {number}")
    active.clock.advance(-3600.0)
    active.records.audit("ada", "LoggedIn", "after the clock was set back")
    for _ in range(4):
        copying.run_round(Event())
    assert audit_of(standby) == audit_of(active)
    assert len(audit_of(standby)) == 1202


def test_audit_of_a_replacement_machine_is_copied_from_its_start(
    sides: tuple[TableSide, TableSide], tmp_path: Path
) -> None:
    gone, standby = sides
    router = MemoryRouter()
    run = 1
    copying = copy_from(router, standby, others_run=lambda: run)
    serving = TableServer("active", router.attach_station(), gone.tables, gone.pki)
    for number in range(3):
        gone.records.audit("ada", "LoggedIn", f"login {number}")
    copying.run_round(Event())
    serving.close()
    with Store(tmp_path / "new.sqlite") as store:
        new = TableSide(tmp_path, store)
        new.records.audit("ada", "LoggedIn", "at the new machine")
        new.tables.add_audit(standby.tables.audit_behind(0, 9))  # so it has as many, and more
        TableServer("active", router.attach_station(), new.tables, new.pki)
        run = 2
        copying.run_round(Event())
        assert "at the new machine" in audit_of(standby)
        assert len(audit_of(standby)) == 4


def test_erasures_of_the_other_station_are_repeated_until_recorded(
    sides: tuple[TableSide, TableSide],
) -> None:
    active, standby = sides
    active.records.audit("ada", "ForgotPerson", "person p9: 3 records of the log in 1 files")
    received: list[str] = []

    def full_disk(what: str) -> None:
        received.append(what)
        raise StoreError("the disk is full")

    with pytest.raises(StoreError):
        copy_over_the_bus(active, standby, full_disk).run_round(Event())
    copy_over_the_bus(active, standby, received.append).run_round(Event())  # as after a kill
    copy_over_the_bus(active, standby, received.append).run_round(Event())
    assert received == ["person p9", "person p9"]


@pytest.mark.parametrize(("leads", "heeds"), [("active", ["person p8"]), (None, [])])
def test_erasure_requested_by_a_station_is_applied_again_after_copying(
    sides: tuple[TableSide, TableSide], leads: str | None, heeds: list[str]
) -> None:
    """And by no other: the two would ask each other for ever."""
    active, standby = sides
    active.records.audit(BY_OTHER_STATION, "ForgotPerson", "person p8: as this one had asked")
    received: list[str] = []
    copy_over_the_bus(active, standby, received.append, leads).run_round(Event())
    assert received == heeds


def test_the_base_map_is_the_active_stations(sides: tuple[TableSide, TableSide]) -> None:
    active, standby = sides
    copying = copy_over_the_bus(active, standby)
    corners = Corners((1.0, 2.0), (1.0, 3.0), (0.0, 2.0))
    for hash_, image in (("a1", b"a map"), ("b2", b"another")):
        active.base_maps.put(image, hash_, corners)
        copying.run_round(Event())
        assert standby.base_maps.corners() == (hash_, corners)
        assert standby.base_maps.image(hash_) == image
    moved = Corners((1.5, 2.0), (1.5, 3.0), (0.0, 2.0))
    active.base_maps.put(b"another", "b2", moved)
    copying.run_round(Event())
    assert standby.base_maps.corners() == ("b2", moved)
    active.base_maps.remove()
    copying.run_round(Event())
    assert standby.base_maps.corners() is None


def test_people_photos_audit_and_enrolments_are_replicated_over_the_bus(
    sides: tuple[TableSide, TableSide],
) -> None:
    active, standby = sides
    active.pki.create("Test", [], ["tls/10.0.0.1:7447"])
    standby.pki.join(active.pki.enroll_station("standby", [], "tls/10.0.0.2:7447"))
    active.pki.enroll("FF-01")
    person = active.roster.add_person("Ada", "red", "leader")
    active.roster.set_photo(person.person_id, b"jpeg", "hash")
    active.records.audit("ada", "LoggedIn", "there")
    standby.records.audit("bob", "LoggedIn", "here")
    active.records.audit("ada", "ForgotPerson", "person p9: 3 records of the log in 1 files")
    forgotten: list[str] = []
    copying = copy_over_the_bus(active, standby, forgotten.append)
    look = partial(copying.run_round, Event())
    look()
    assert standby.roster.photo(person.person_id) == (b"jpeg", "hash")
    assert standby.roster.known(person.person_id).photo_url is not None
    assert {one.by for one in standby.records.audit_entries(EVER)} == {"ada", "bob"}
    assert forgotten == ["person p9"]
    assert standby.pki.registry().entries == active.pki.registry().entries
    active.pki.revoke("FF-01")
    active.roster.set_photo(person.person_id, b"other", "hash 2")
    look()
    assert any(entry.revoked for entry in standby.pki.registry().entries)
    assert standby.roster.photo(person.person_id) == (b"other", "hash 2")
    active.roster.remove_person(person.person_id)
    look()
    assert not standby.roster.people()
    assert forgotten == ["person p9"]
