"""The first administrator: a station switched off at its first start can still be logged in to."""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Iterator
from pathlib import Path

import pytest

from base_station.accounts.principals import Role
from base_station.app.first_login import ensure_administrator
from base_station.storage.db.accounts import Accounts
from base_station.storage.db.store import Store
from shared.clock import SystemClock
from shared.errors import StoreError
from tests.rig.quick_hash import QUICK_HASH


@pytest.fixture
def accounts(tmp_path: Path) -> Iterator[Accounts]:
    with Store(tmp_path / "station.sqlite") as store:
        yield Accounts(store, SystemClock(), QUICK_HASH)


def test_note_is_on_the_disk_before_the_user_exists(
    accounts: Accounts, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    on_disk = []
    sync, add_user = os.fsync, Accounts.add_user

    def synced(descriptor: int) -> None:
        sync(descriptor)
        on_disk.append(stat.S_ISDIR(os.fstat(descriptor).st_mode))

    def after_both(
        self: Accounts, username: str, password: str, role: Role, *, generated: bool
    ) -> None:
        assert on_disk == [False, True]  # its text, and that it is on the disk
        assert password in (tmp_path / "note").read_text()
        add_user(self, username, password, role, generated=generated)

    monkeypatch.setattr("base_station.storage.private_files.os.fsync", synced)
    monkeypatch.setattr(Accounts, "add_user", after_both)
    password = ensure_administrator(accounts, tmp_path / "note")
    assert password is not None
    assert accounts.log_in("admin", password)
    assert stat.S_IMODE((tmp_path / "note").stat().st_mode) == 0o600


def test_disk_that_refuses_the_note_creates_no_user(
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


def test_station_with_users_creates_none(accounts: Accounts, tmp_path: Path) -> None:
    accounts.add_user("mia", "something long enough", Role.ADMINISTRATOR)
    assert ensure_administrator(accounts, tmp_path / "note") is None
    assert not (tmp_path / "note").exists()


def test_generated_password_must_be_changed_and_no_other(tmp_path: Path) -> None:
    with Store(tmp_path / "station.sqlite") as store:
        accounts = Accounts(store, SystemClock(), QUICK_HASH)
        password = ensure_administrator(accounts, tmp_path / "note") or ""
        accounts.add_user("mia", "a long password", Role.VIEWER)
        assert must_change(accounts, "admin", password)
        assert not must_change(accounts, "mia", "a long password")
        accounts.change_user("admin", "another battery", None)
        assert not must_change(accounts, "admin", "another battery")
    with Store(tmp_path / "memory.sqlite") as store:  # of a station whose disk refuses writes
        accounts = Accounts(store, SystemClock(), QUICK_HASH)
        password = ensure_administrator(accounts, None) or ""
        assert not must_change(accounts, "admin", password)


def must_change(accounts: Accounts, username: str, password: str) -> bool:
    principal = accounts.of_session(accounts.log_in(username, password) or "")
    assert principal is not None
    return principal.must_change_password
