"""Cache of authenticated users: they stay logged in while the disk hangs, and nobody else
logs in.
"""

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
def test_authenticated_user_stays_in_while_the_disk_hangs(accounts: Accounts, hangs: Event) -> None:
    session, (_, token) = ada_in(accounts), accounts.add_token("ada", "board", Role.VIEWER, None)
    before = accounts.of_session(session), accounts.of_token(token)
    assert [one and one.role for one in before] == [Role.COMMANDER, Role.VIEWER]
    hangs.set()
    assert (accounts.of_session(session), accounts.of_token(token)) == before


def test_user_not_authenticated_before_is_refused_while_the_disk_hangs(
    accounts: Accounts, hangs: Event
) -> None:
    session = ada_in(accounts)
    assert accounts.of_session("guessed") is None
    hangs.set()
    for secret in (session, "guessed"):
        with pytest.raises(DiskHangsError, match="does not answer"):
            accounts.of_session(secret)


@pytest.mark.slow
@pytest.mark.parametrize("how", ["logs out", "is ended", "another password", "is removed"])
def test_disabled_user_stays_out_while_the_disk_hangs(
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


def test_user_disabled_elsewhere_is_out_once_that_was_read(
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
def test_revoked_token_is_refused(accounts: Accounts, hangs: Event) -> None:
    token_id, token = accounts.add_token("ada", "board", Role.VIEWER, None)
    assert accounts.of_token(token) is not None
    assert accounts.remove_token("ada", token_id)
    hangs.set()
    with pytest.raises(DiskHangsError):
        accounts.of_token(token)


@pytest.mark.slow
def test_cache_keeps_the_latest_of_any_number(accounts: Accounts, hangs: Event) -> None:
    first, last = ada_in(accounts), ada_in(accounts)
    for secret in (first, *map(str, range(1000)), last):
        known = accounts._let_in.resolve(secret, lambda _: accounts.of_session(last))
        assert known is not None
    assert len(accounts._let_in._known) == 1000
    hangs.set()
    assert accounts.of_session(last) is not None
    with pytest.raises(DiskHangsError):
        accounts.of_session(first)
