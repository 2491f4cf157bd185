"""Administrators that the program creates: at a station's first start, and for a replay."""

from __future__ import annotations

import secrets
from pathlib import Path

from base_station.accounts.principals import Role
from base_station.storage.db.accounts import Accounts
from base_station.storage.private_files import write_atomically

USERNAME = "admin"


def ensure_administrator(accounts: Accounts, note: Path | None) -> str | None:
    """Create an administrator if there is no user, and return the password, which is also written
    to the file ``note`` if the disk takes anything.  None if there are users.

    The note is on disk before the user is created, so that a user can log in after the station was
    switched off right after its first start.  A password that was in a file and on a screen must be
    changed at the first login, except if it ends with this run of the station.  Raises StoreError
    if the disk does not take the user.
    """
    if accounts.users():
        return None
    password = _password()
    if note is not None:
        write_atomically(note, f"username: {USERNAME}\npassword: {password}\n".encode())
    accounts.add_user(USERNAME, password, Role.ADMINISTRATOR, generated=note is not None)
    return password


def add_own_login(accounts: Accounts) -> tuple[str, str]:
    """Add an administrator to a copy of a station's accounts, and return name and password: whoever
    replays a copied folder has no account there.
    """
    username, password = f"replay-{secrets.token_hex(2)}", _password()
    accounts.add_user(username, password, Role.ADMINISTRATOR)
    return username, password


def _password() -> str:
    return "-".join(secrets.token_hex(2) for _ in range(5))
