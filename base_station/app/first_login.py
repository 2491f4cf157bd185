"""Administrators that the program makes itself: at a station's first start, and for a replay."""

from __future__ import annotations

import secrets
from pathlib import Path

from base_station.accounts.principals import Role
from base_station.storage.db.accounts import Accounts
from base_station.storage.private_files import write_atomically

USERNAME = "admin"


def ensure_administrator(accounts: Accounts, note: Path | None) -> str | None:
    """The password of a new administrator, also written to ``note``, where the disk takes
    anything; None where users exist.

    The note is on the disk before there is such a user: a user can still log in after the station
    was switched off right after its first start.  A password that has stood in a file and on a
    screen must be changed first; not where it ends with this run of the station.
    Raises StoreError where the disk does not take it.
    """
    if accounts.users():
        return None
    password = _password()
    if note is not None:
        write_atomically(note, f"username: {USERNAME}\npassword: {password}\n".encode())
    accounts.add_user(USERNAME, password, Role.ADMINISTRATOR, generated=note is not None)
    return password


def add_own_login(accounts: Accounts) -> tuple[str, str]:
    """Name and password of an additional administrator, in a copy of a station's accounts: the user
    of a copied folder has no account there.
    """
    username, password = f"replay-{secrets.token_hex(2)}", _password()
    accounts.add_user(username, password, Role.ADMINISTRATOR)
    return username, password


def _password() -> str:
    return "-".join(secrets.token_hex(2) for _ in range(5))
