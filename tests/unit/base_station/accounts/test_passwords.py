"""Checking a password takes 64 MB: only so many are checked at once."""

from __future__ import annotations

import time
from concurrent.futures import ThreadPoolExecutor

import pytest
from pwdlib import PasswordHash

from base_station.accounts.passwords import Passwords

SECRET = "long enough"


def test_only_two_passwords_are_worked_on_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    inside: list[int] = []
    most = 0

    def work(*_: object) -> str:
        nonlocal most
        inside.append(1)
        most = max(most, len(inside))
        time.sleep(0.02)
        inside.pop()
        return SECRET

    for name in ("hash", "verify"):
        monkeypatch.setattr(PasswordHash, name, work)
    passwords = Passwords()
    with ThreadPoolExecutor(8) as pool:
        pool.map(lambda _: passwords.is_right(SECRET, SECRET), range(8))
        pool.map(lambda _: passwords.hash(SECRET), range(8))
    assert 0 < most <= 2
