"""Password checks: each takes 64 MB, so their number at once is limited."""

from __future__ import annotations

import time
from concurrent.futures import ThreadPoolExecutor

import pytest
from pwdlib import PasswordHash

from base_station.accounts.passwords import Passwords

SECRET = "long enough"


def test_at_most_two_password_checks_run_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
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
        pool.map(lambda _: passwords.is_valid(SECRET, SECRET), range(8))
        pool.map(lambda _: passwords.hash(SECRET), range(8))
    assert 0 < most <= 2
