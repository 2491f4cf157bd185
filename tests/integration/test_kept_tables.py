"""What is in no log is the same at both stations."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path
from threading import Event

import pytest

from base_station.db.accounts import Accounts, Role
from base_station.db.kept import KeptTables
from base_station.db.records import Records
from base_station.db.roster import Roster
from base_station.db.store import Store
from base_station.pki.folder import PkiFolder
from base_station.standby.kept_copy import KeptCopy, KeptServer
from shared.bus_memory import MemoryRouter
from shared.clock import ManualClock
from tests.station import QUICK_HASH

PASSWORD = "correct horse battery"


class Side:
    """One station's database, as its console uses it."""

    def __init__(self, folder: Path, store: Store) -> None:
        clock = ManualClock()
        self.tables = KeptTables(store)
        self.accounts = Accounts(store, clock, QUICK_HASH)
        self.roster, self.records = Roster(store, clock), Records(store, clock)
        self.pki = PkiFolder(folder)

    def copy(self, other: Side) -> tuple[str, ...]:
        return self.tables.copy(other.tables.read())


@pytest.fixture
def sides(tmp_path: Path) -> Iterator[tuple[Side, Side]]:
    folders = [tmp_path / name for name in ("active", "standby")]
    for folder in folders:
        folder.mkdir()
    with Store(folders[0] / "s.sqlite") as one, Store(folders[1] / "s.sqlite") as other:
        yield Side(folders[0], one), Side(folders[1], other)


def test_the_same_people_log_in_with_the_same_passwords_tokens_and_sessions(
    sides: tuple[Side, Side],
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


def test_what_ends_there_ends_here_and_a_login_here_stays(sides: tuple[Side, Side]) -> None:
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


def test_who_was_only_here_goes_and_is_named(sides: tuple[Side, Side]) -> None:
    active, standby = sides
    active.accounts.add_user("ada", PASSWORD, Role.ADMINISTRATOR)
    standby.accounts.add_user("mallory", PASSWORD, Role.ADMINISTRATOR)
    standby.accounts.add_token("mallory", "x", Role.VIEWER, None)
    dropped = standby.copy(active)
    assert [one.partition(" ")[0] for one in dropped] == ["user", "token"]
    assert [user.username for user in standby.accounts.users()] == ["ada"]


def test_people_photos_audit_and_enrolments_come_over_the_bus(sides: tuple[Side, Side]) -> None:
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
    router = MemoryRouter()
    KeptServer("active", router.attach_station(), active.tables, active.pki)
    copying = KeptCopy(
        router.attach_station(),
        standby.tables,
        standby.pki,
        leader=lambda: "active",
        other=lambda: "active",
        caught_up=lambda: True,
        on_people=standby.roster.read_again,
        on_forgotten=forgotten.append,
        on_dropped=lambda _: None,
    )
    look = partial(copying.look, Event())
    look()
    assert standby.roster.photo(person.person_id) == (b"jpeg", "hash")
    assert standby.roster.photo_url(person.person_id) is not None
    assert {one.by for one in standby.records.audit_entries(2**62, 9)} == {"ada", "bob"}
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
