"""Who was let in stays in while the disk hangs, and nobody else comes in."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from threading import Event

import pytest

from base_station.accounts.principals import Role
from base_station.storage.db.accounts import Accounts
from base_station.storage.db.store import Store
from shared.clock import SystemClock
from shared.errors import DiskHangsError
from tests.rig.quick_hash import QUICK_HASH


@pytest.fixture
def hangs() -> Event:
    return Event()


@pytest.fixture
def accounts(tmp_path: Path, hangs: Event) -> Iterator[Accounts]:
    with Store(tmp_path / "station.sqlite", hangs.is_set) as store:
        accounts = Accounts(store, SystemClock(), QUICK_HASH)
        accounts.add_user("ada", "a long password", Role.COMMANDER)
        yield accounts


def ada_in(accounts: Accounts) -> str:
    secret = accounts.log_in("ada", "a long password")
    assert secret is not None
    return secret


@pytest.mark.slow
def test_who_was_let_in_stays_in_while_the_disk_hangs(accounts: Accounts, hangs: Event) -> None:
    session, (_, token) = ada_in(accounts), accounts.add_token("ada", "board", Role.VIEWER, None)
    before = accounts.of_session(session), accounts.of_token(token)
    assert [one and one.role for one in before] == [Role.COMMANDER, Role.VIEWER]
    hangs.set()
    assert (accounts.of_session(session), accounts.of_token(token)) == before


def test_nobody_comes_in_who_was_not_seen_in_before(accounts: Accounts, hangs: Event) -> None:
    session = ada_in(accounts)
    assert accounts.of_session("guessed") is None
    hangs.set()
    for secret in (session, "guessed"):
        with pytest.raises(DiskHangsError, match="does not answer"):
            accounts.of_session(secret)


@pytest.mark.slow
@pytest.mark.parametrize("how", ["logs out", "is ended", "another password", "is removed"])
def test_who_is_out_stays_out_though_the_disk_hangs(
    accounts: Accounts, hangs: Event, how: str
) -> None:
    session = ada_in(accounts)
    assert accounts.of_session(session) is not None
    match how:
        case "logs out":
            accounts.log_out(session)
        case "is ended":
            accounts.end_sessions("ada")
        case "another password":
            accounts.change_user("ada", "another long password", None)
        case "is removed":
            accounts.remove_user("ada")
    hangs.set()
    with pytest.raises(DiskHangsError):
        accounts.of_session(session)


def test_who_was_put_out_from_elsewhere_is_out_once_that_was_seen(
    accounts: Accounts, hangs: Event
) -> None:
    """By another program, or at the other station."""
    session = ada_in(accounts)
    assert accounts.of_session(session) is not None
    Accounts(accounts._store, SystemClock(), QUICK_HASH).end_sessions("ada")
    assert accounts.of_session(session) is None
    hangs.set()
    with pytest.raises(DiskHangsError):
        accounts.of_session(session)


@pytest.mark.slow
def test_a_token_that_was_taken_back_is_of_no_use(accounts: Accounts, hangs: Event) -> None:
    token_id, token = accounts.add_token("ada", "board", Role.VIEWER, None)
    assert accounts.of_token(token) is not None
    assert accounts.remove_token("ada", token_id)
    hangs.set()
    with pytest.raises(DiskHangsError):
        accounts.of_token(token)


@pytest.mark.slow
def test_of_any_number_the_last_are_known(accounts: Accounts, hangs: Event) -> None:
    first, last = ada_in(accounts), ada_in(accounts)
    for secret in (first, *map(str, range(1000)), last):
        known = accounts._let_in.resolve(secret, lambda _: accounts.of_session(last))
        assert known is not None
    assert len(accounts._let_in._known) == 1000
    hangs.set()
    assert accounts.of_session(last) is not None
    with pytest.raises(DiskHangsError):
        accounts.of_session(first)
