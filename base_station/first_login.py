"""The first administrator: made at the first start, with a password of its own."""

from __future__ import annotations

import os
import secrets
from pathlib import Path

from base_station.db.accounts import Accounts
from base_station.db.principals import Role
from shared.errors import StoreError

USERNAME = "admin"


def ensure_administrator(accounts: Accounts, note: Path) -> str | None:
    """The password of a new administrator, also written to ``note``; None where users exist."""
    if accounts.users():
        return None
    password = "-".join(secrets.token_hex(2) for _ in range(5))
    try:
        note.unlink(missing_ok=True)
        descriptor = os.open(note, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        with os.fdopen(descriptor, "w", encoding="utf-8") as written:
            written.write(f"username: {USERNAME}\npassword: {password}\n")
    except OSError as error:
        raise StoreError(f"the first login cannot be written to {note}: {error}") from error
    accounts.add_user(USERNAME, password, Role.ADMINISTRATOR)
    return password
