"""The first administrator: whoever switches the station off at its first start can still log in."""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Iterator
from pathlib import Path

import pytest

from base_station.accounts.first_login import ensure_administrator
from base_station.accounts.principals import Role
from base_station.db.accounts import Accounts
from base_station.db.store import Store
from shared.clock import SystemClock
from shared.errors import StoreError
from tests.station import QUICK_HASH


@pytest.fixture
def accounts(tmp_path: Path) -> Iterator[Accounts]:
    with Store(tmp_path / "station.sqlite") as store:
        yield Accounts(store, SystemClock(), QUICK_HASH)


def test_the_note_is_on_the_disk_before_there_is_such_a_user(
    accounts: Accounts, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    on_disk = []
    sync, add_user = os.fsync, Accounts.add_user

    def synced(descriptor: int) -> None:
        sync(descriptor)
        on_disk.append(stat.S_ISDIR(os.fstat(descriptor).st_mode))

    def after_both(self: Accounts, username: str, password: str, role: Role) -> None:
        assert on_disk == [False, True]  # what it says, and that it is there
        assert password in (tmp_path / "note").read_text()
        add_user(self, username, password, role)

    monkeypatch.setattr("base_station.storage.private_files.os.fsync", synced)
    monkeypatch.setattr(Accounts, "add_user", after_both)
    password = ensure_administrator(accounts, tmp_path / "note")
    assert password is not None
    assert accounts.log_in("admin", password)
    assert stat.S_IMODE((tmp_path / "note").stat().st_mode) == 0o600


def test_a_disk_that_does_not_take_the_note_makes_no_user_of_whom_nobody_knows(
    accounts: Accounts, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "note").write_text("of a start that was cut short")

    def full(descriptor: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as disk:
        disk.setattr("base_station.storage.private_files.os.fsync", full)
        with pytest.raises(StoreError, match=r"note cannot be written: No space left"):
            ensure_administrator(accounts, tmp_path / "note")
    assert not accounts.users()

    password = ensure_administrator(accounts, tmp_path / "note")
    assert (tmp_path / "note").read_text() == f"username: admin\npassword: {password}\n"


def test_where_there_are_users_nothing_is_made(accounts: Accounts, tmp_path: Path) -> None:
    accounts.add_user("mia", "something long enough", Role.ADMINISTRATOR)
    assert ensure_administrator(accounts, tmp_path / "note") is None
    assert not (tmp_path / "note").exists()
