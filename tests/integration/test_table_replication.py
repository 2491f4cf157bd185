"""Tables without a log are the same at both stations."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from threading import Event

import pytest

from base_station.accounts.principals import Role
from base_station.privacy.erasure_service import BY_OTHER_STATION
from base_station.security.pki.folder import PkiFolder
from base_station.site.base_map import Corners
from base_station.standby.table_replication import TableReplication, TableServer
from base_station.storage.db.accounts import HAND_OVER_S, SESSION_S, Accounts
from base_station.storage.db.base_maps import BaseMaps
from base_station.storage.db.records import Records
from base_station.storage.db.replicated_tables import ReplicatedTables
from base_station.storage.db.roster import Roster
from base_station.storage.db.store import Store
from base_station.storage.db.window import EVER
from shared.bus_memory import MemoryRouter
from shared.clock import ManualClock
from shared.errors import StoreError
from tests.rig.quick_hash import QUICK_HASH

PASSWORD = "correct horse battery"


class HaMode:
    """One station's database, as its console uses it."""

    def __init__(self, folder: Path, store: Store) -> None:
        self.clock = clock = ManualClock()
        self.tables = ReplicatedTables(store)
        self.accounts = Accounts(store, clock, QUICK_HASH)
        self.roster, self.records = Roster(store, clock), Records(store, clock)
        self.base_maps = BaseMaps(store)
        self.pki = PkiFolder(folder)

    def copy(self, other: HaMode) -> tuple[str, ...]:
        return self.tables.copy(other.tables.read())


@pytest.fixture
def sides(tmp_path: Path) -> Iterator[tuple[HaMode, HaMode]]:
    folders = [tmp_path / name for name in ("active", "standby")]
    for folder in folders:
        folder.mkdir()
    with Store(folders[0] / "s.sqlite") as one, Store(folders[1] / "s.sqlite") as other:
        yield HaMode(folders[0], one), HaMode(folders[1], other)


def test_new_user_of_a_removed_name_has_none_of_its_logins(
    sides: tuple[HaMode, HaMode],
) -> None:
    active, standby = sides
    active.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    active.accounts.add_user("bo", PASSWORD, Role.ADMINISTRATOR)
    standby.copy(active)
    session = standby.accounts.log_in("ada", PASSWORD)
    assert session is not None
    active.accounts.remove_user("ada")
    active.accounts.add_user("ada", "another long password", Role.COMMANDER)
    standby.copy(active)  # which never saw that there was none
    assert standby.accounts.of_session(session) is None


def test_logins_tokens_and_sessions_are_replicated(
    sides: tuple[HaMode, HaMode],
) -> None:
    active, standby = sides
    active.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    session = active.accounts.log_in("ada", PASSWORD)
    _, token = active.accounts.add_token("ada", "cot", Role.VIEWER, None)
    standby.copy(active)
    assert session is not None
    assert standby.accounts.of_session(session) == active.accounts.of_session(session)
    assert standby.accounts.of_token(token) == active.accounts.of_token(token)
    assert standby.accounts.log_in("ada", PASSWORD) is not None
    assert standby.accounts.log_in("ada", "wrong password") is None


def test_ended_logins_are_replicated_and_own_logins_kept(sides: tuple[HaMode, HaMode]) -> None:
    active, standby = sides
    active.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    there = active.accounts.log_in("ada", PASSWORD)
    standby.copy(active)
    here = standby.accounts.log_in("ada", PASSWORD)
    assert there is not None
    assert here is not None
    active.accounts.log_out(there)
    standby.copy(active)
    assert standby.accounts.of_session(there) is None
    assert standby.accounts.of_session(here) is not None


@pytest.mark.parametrize("how", ["new password", "ended by an administrator", "removed"])
def test_revoked_access_is_revoked_at_both_stations(sides: tuple[HaMode, HaMode], how: str) -> None:
    active, standby = sides
    active.accounts.add_user("chief", PASSWORD, Role.ADMINISTRATOR)
    active.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    standby.copy(active)
    here = standby.accounts.log_in("ada", PASSWORD)  # by whoever has found the password
    assert here is not None
    ticket = standby.accounts.hand_over(here)
    assert ticket is not None
    match how:
        case "new password":
            active.accounts.change_user("ada", "another battery", None)
        case "ended by an administrator":
            active.accounts.end_sessions("ada")
        case _:
            active.accounts.remove_user("ada")
    standby.copy(active)
    assert standby.accounts.of_session(here) is None
    assert standby.accounts.take_over(ticket) is None
    assert standby.accounts.open_sessions() == {}


@pytest.mark.parametrize("how", ["new password", "ended by an administrator", "removed"])
@pytest.mark.parametrize("first", ["who leads", "who follows"])
def test_access_revoked_by_a_former_leader_is_revoked_at_both(
    sides: tuple[HaMode, HaMode], how: str, first: str
) -> None:
    """Whichever of the two hears of the other first."""
    leads, follows = apart = sides
    follows.accounts.add_user("chief", PASSWORD, Role.ADMINISTRATOR)
    follows.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    leads.copy(follows)
    here = leads.accounts.log_in("ada", PASSWORD)
    assert here is not None
    _, token = leads.accounts.add_token("ada", "x", Role.VIEWER, None)
    match how:
        case "new password":
            follows.accounts.change_user("ada", "another battery", None)
        case "ended by an administrator":
            follows.accounts.end_sessions("ada")
        case _:
            follows.accounts.remove_user("ada")
    meet(leads, follows, first)
    for one in apart:
        assert one.accounts.of_session(here) is None
        assert (one.accounts.log_in("ada", PASSWORD) is None) == (
            how in ("new password", "removed")
        )
        assert (one.accounts.of_token(token) is None) == (how == "removed")
    meet(leads, follows, first)
    assert leads.tables.read().users == follows.tables.read().users


@pytest.mark.parametrize("first", ["who leads", "who follows"])
def test_removals_by_one_station_alone_apply_at_both(
    sides: tuple[HaMode, HaMode], first: str
) -> None:
    leads, follows = apart = sides
    follows.accounts.add_user("chief", PASSWORD, Role.ADMINISTRATOR)
    follows.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    token_id, token = follows.accounts.add_token("ada", "x", Role.VIEWER, None)
    person = follows.roster.add_person("Zoe", "", "")
    leads.copy(follows)
    follows.accounts.remove_token("ada", token_id)
    follows.accounts.change_user("ada", None, Role.VIEWER)
    follows.roster.remove_person(person.person_id)
    leads.accounts.change_user("ada", "another battery", None)  # later, and of something else
    meet(leads, follows, first)
    for one in apart:
        assert one.accounts.of_token(token) is None
        assert not one.roster.people()
        now = one.accounts.log_in("ada", "another battery")
        assert now is not None
        who = one.accounts.of_session(now)
        assert who is not None
        assert who.role is Role.VIEWER


@pytest.mark.parametrize("first", ["who leads", "who follows"])
def test_later_of_two_new_passwords_is_valid_alone(
    sides: tuple[HaMode, HaMode], first: str
) -> None:
    leads, follows = apart = sides
    follows.accounts.add_user("ada", PASSWORD, Role.ADMINISTRATOR)
    leads.copy(follows)
    leads.accounts.change_user("ada", "the earlier battery", None)
    with_earlier = leads.accounts.log_in("ada", "the earlier battery")
    assert with_earlier is not None
    follows.clock.advance(1.0)
    follows.accounts.change_user("ada", "the later battery", None)
    meet(leads, follows, first)
    for one in apart:
        assert one.accounts.of_session(with_earlier) is None
        assert one.accounts.log_in("ada", "the earlier battery") is None
        assert one.accounts.log_in("ada", "the later battery") is not None


def test_new_user_of_a_removed_name_is_kept(sides: tuple[HaMode, HaMode]) -> None:
    leads, follows = sides
    follows.accounts.add_user("chief", PASSWORD, Role.ADMINISTRATOR)
    follows.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    leads.copy(follows)
    follows.accounts.remove_user("ada")
    leads.clock.advance(1.0)
    leads.accounts.remove_user("ada")
    leads.accounts.add_user("ada", "another battery", Role.VIEWER)
    meet(leads, follows, "who leads")
    for one in sides:
        assert one.accounts.log_in("ada", "another battery") is not None


def test_used_ticket_stays_used(sides: tuple[HaMode, HaMode]) -> None:
    active, standby = sides
    active.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    there = active.accounts.log_in("ada", PASSWORD)
    assert there is not None
    ticket = active.accounts.hand_over(there)
    assert ticket is not None
    standby.copy(active)
    assert standby.accounts.take_over(ticket) is not None
    active.accounts.hand_over(there)  # so that all is copied again
    standby.copy(active)
    assert standby.accounts.take_over(ticket) is None
    assert active.tables.take_away(standby.tables.read())
    assert active.accounts.take_over(ticket) is None


def test_login_ended_while_the_other_was_off_ends_there(
    sides: tuple[HaMode, HaMode], tmp_path: Path
) -> None:
    active, standby = sides
    active.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    there = active.accounts.log_in("ada", PASSWORD)
    standby.copy(active)
    assert there is not None
    active.accounts.log_out(there)
    with Store(tmp_path / "standby" / "s.sqlite") as store:  # its program begins again
        again = HaMode(tmp_path / "standby", store)
        again.copy(active)
        assert again.accounts.of_session(there) is None


def meet(leads: HaMode, follows: HaMode, first: str) -> None:
    """Each hears of the other, one before the other one."""
    if first == "who leads":
        leads.tables.take_away(follows.tables.read())
    follows.copy(leads)
    leads.tables.take_away(follows.tables.read())
    follows.copy(leads)


def test_login_is_transferred_to_the_other_station_once(sides: tuple[HaMode, HaMode]) -> None:
    active, standby = sides
    active.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    there = active.accounts.log_in("ada", PASSWORD)
    assert there is not None
    ticket = active.accounts.hand_over(there)
    assert ticket is not None
    assert standby.accounts.take_over(ticket) is None  # it has not heard of it
    standby.copy(active)
    here = standby.accounts.take_over(ticket)
    assert here is not None
    assert here != there
    assert standby.accounts.of_session(here) == active.accounts.of_session(there)
    assert standby.accounts.take_over(ticket) is None
    standby.copy(active)  # still has the ticket, which was never shown there
    assert active.accounts.hand_over("no session") is None
    last = active.accounts.hand_over(there)
    assert last is not None
    active.accounts.log_out(there)
    assert active.accounts.take_over(last) is None


def test_ticket_and_its_session_expire(sides: tuple[HaMode, HaMode]) -> None:
    active, _ = sides
    active.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    session = active.accounts.log_in("ada", PASSWORD)
    assert session is not None
    late, soon = active.accounts.hand_over(session), active.accounts.hand_over(session)
    assert late is not None
    assert soon is not None
    active.clock.advance(HAND_OVER_S - 1.0)
    went_on = active.accounts.take_over(soon)
    assert went_on is not None
    active.clock.advance(1.0)
    assert active.accounts.take_over(late) is None
    active.clock.advance(SESSION_S - HAND_OVER_S)  # since the login, however often it was handed on
    assert active.accounts.of_session(went_on) is None


def test_local_entries_missing_at_the_leader_are_removed_and_reported(
    sides: tuple[HaMode, HaMode],
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

    def __init__(self, leads: HaMode, follows: HaMode) -> None:
        router = MemoryRouter()
        self.taken_back: list[str] = []
        for name, side in (("leads", leads), ("follows", follows)):
            TableServer(name, router.attach_station(), side.tables, side.pki)
        self._rounds = [
            self._round(router, leads, None, "follows"),
            self._round(router, follows, "leads", "leads"),
        ]

    def look(self, rounds: int = 3) -> None:
        """The standby first, as it does where it has the leader's answer at once."""
        for _ in range(rounds):
            for one in reversed(self._rounds):
                one.look(Event())

    def _round(
        self, router: MemoryRouter, side: HaMode, leader: str | None, other: str
    ) -> TableReplication:
        return TableReplication(
            router.attach_station(),
            side.tables,
            side.pki,
            leader=lambda: leader,
            other=lambda: other,
            others_run=lambda: 1,
            caught_up=lambda: True,
            on_people=side.roster.read_again,
            on_forgotten=lambda _: None,
            on_dropped=pytest.fail,
            on_taken_back=self.taken_back.append,
        )


LOST = ("users", "api_tokens", "people", "base_map", "audit")


@pytest.mark.parametrize("loser", ["who leads", "who follows"])
def test_lost_tables_are_restored_from_the_other_station(
    tmp_path: Path, sides: tuple[HaMode, HaMode], loser: str
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
        lost = HaMode(tmp_path, store)
        lost.tables.note_lost(LOST)
        if loser == "who leads":
            lost.accounts.add_user("admin", "another battery", Role.ADMINISTRATOR, generated=True)
            lost.accounts.add_user("eve", PASSWORD, Role.VIEWER)  # entered since
        pair = Pair(*((lost, had) if loser == "who leads" else (had, lost)))
        pair.look()
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
    sides: tuple[HaMode, HaMode],
) -> None:
    leads, follows = sides
    follows.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    follows.roster.add_person("Ada", "red", "leader")
    leads.accounts.add_user("admin", PASSWORD, Role.ADMINISTRATOR, generated=True)
    leads.tables.note_lost(["users", "api_tokens"])
    follows.copy(leads)
    assert [one.username for one in follows.accounts.users()] == ["ada"]
    assert follows.roster.people() == [], "of which it has lost none"
    leads.tables.take_back(follows.tables.read())
    follows.copy(leads)
    for one in sides:
        assert [user.username for user in one.accounts.users()] == ["ada", "admin"]


def test_stations_that_both_lost_their_tables_agree_again(sides: tuple[HaMode, HaMode]) -> None:
    leads, follows = sides
    leads.accounts.add_user("admin", PASSWORD, Role.ADMINISTRATOR, generated=True)
    for one in sides:
        one.tables.note_lost(LOST)
    Pair(leads, follows).look()
    for one in sides:
        assert one.tables.lost() == ()
        assert [user.username for user in one.accounts.users()] == ["admin"]


def copy_over_the_bus(
    active: HaMode,
    standby: HaMode,
    on_forgotten: Callable[[str], None] = lambda _: None,
    leader: str | None = "active",
) -> TableReplication:
    router = MemoryRouter()
    TableServer("active", router.attach_station(), active.tables, active.pki)
    return copy_from(router, standby, on_forgotten, leader=leader)


def copy_from(
    router: MemoryRouter,
    standby: HaMode,
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
        on_people=standby.roster.read_again,
        on_forgotten=on_forgotten,
        on_dropped=lambda _: None,
        on_taken_back=lambda _: None,
    )


def audit_of(side: HaMode) -> set[str]:
    return {one.detail for one in side.records.audit_entries(EVER)}


def test_audit_is_identical_with_different_clocks(
    sides: tuple[HaMode, HaMode],
) -> None:
    active, standby = sides
    copying = copy_over_the_bus(active, standby)
    standby.clock.advance(86_400.0)  # whoever acts here is a day ahead
    standby.records.audit("bob", "LoggedIn", "here")
    active.tables.add_audit(standby.tables.audit_behind(0, 9))
    copying.look(Event())
    for number in range(1200):  # more than come at once
        active.records.audit("ada", "LoggedIn", f"login {number}")
    active.clock.advance(-3600.0)
    active.records.audit("ada", "LoggedIn", "after the clock was set back")
    for _ in range(4):
        copying.look(Event())
    assert audit_of(standby) == audit_of(active)
    assert len(audit_of(standby)) == 1202


def test_audit_of_a_replacement_machine_is_copied_from_its_start(
    sides: tuple[HaMode, HaMode], tmp_path: Path
) -> None:
    gone, standby = sides
    router = MemoryRouter()
    run = 1
    copying = copy_from(router, standby, others_run=lambda: run)
    serving = TableServer("active", router.attach_station(), gone.tables, gone.pki)
    for number in range(3):
        gone.records.audit("ada", "LoggedIn", f"login {number}")
    copying.look(Event())
    serving.close()
    with Store(tmp_path / "new.sqlite") as store:
        new = HaMode(tmp_path, store)
        new.records.audit("ada", "LoggedIn", "at the new machine")
        new.tables.add_audit(standby.tables.audit_behind(0, 9))  # so it has as many, and more
        TableServer("active", router.attach_station(), new.tables, new.pki)
        run = 2
        copying.look(Event())
        assert "at the new machine" in audit_of(standby)
        assert len(audit_of(standby)) == 4


def test_erasures_of_the_other_station_are_repeated_until_recorded(
    sides: tuple[HaMode, HaMode],
) -> None:
    active, standby = sides
    active.records.audit("ada", "ForgotPerson", "person p9: 3 records of the log in 1 files")
    received: list[str] = []

    def full_disk(what: str) -> None:
        received.append(what)
        raise StoreError("the disk is full")

    with pytest.raises(StoreError):
        copy_over_the_bus(active, standby, full_disk).look(Event())
    copy_over_the_bus(active, standby, received.append).look(Event())  # as after a kill
    copy_over_the_bus(active, standby, received.append).look(Event())
    assert received == ["person p9", "person p9"]


@pytest.mark.parametrize(("leads", "heeds"), [("active", ["person p8"]), (None, [])])
def test_erasure_requested_by_a_station_is_applied_again_after_copying(
    sides: tuple[HaMode, HaMode], leads: str | None, heeds: list[str]
) -> None:
    """And by no other: the two would ask each other for ever."""
    active, standby = sides
    active.records.audit(BY_OTHER_STATION, "ForgotPerson", "person p8: as this one had asked")
    received: list[str] = []
    copy_over_the_bus(active, standby, received.append, leads).look(Event())
    assert received == heeds


def test_the_base_map_is_the_active_stations(sides: tuple[HaMode, HaMode]) -> None:
    active, standby = sides
    copying = copy_over_the_bus(active, standby)
    corners = Corners((1.0, 2.0), (1.0, 3.0), (0.0, 2.0))
    for hash_, image in (("a1", b"a map"), ("b2", b"another")):
        active.base_maps.put(image, hash_, corners)
        copying.look(Event())
        assert standby.base_maps.corners() == (hash_, corners)
        assert standby.base_maps.image(hash_) == image
    moved = Corners((1.5, 2.0), (1.5, 3.0), (0.0, 2.0))
    active.base_maps.put(b"another", "b2", moved)
    copying.look(Event())
    assert standby.base_maps.corners() == ("b2", moved)
    active.base_maps.remove()
    copying.look(Event())
    assert standby.base_maps.corners() is None


def test_people_photos_audit_and_enrolments_are_replicated_over_the_bus(
    sides: tuple[HaMode, HaMode],
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
    look = partial(copying.look, Event())
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
