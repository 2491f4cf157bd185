"""Passwords as argon2 hashes; making and checking one takes long, and 64 MB, on purpose."""

from __future__ import annotations

import secrets
import threading

from pwdlib import PasswordHash

from shared.errors import UserError

MIN_PASSWORD, MAX_PASSWORD = 10, 256
_AT_ONCE = 2


class Passwords:
    """Thread-safe."""

    def __init__(self, hasher: PasswordHash | None = None) -> None:
        self._hasher = hasher or PasswordHash.recommended()
        self._hashing = threading.BoundedSemaphore(_AT_ONCE)
        # Checked for names that do not exist, so that the answer takes as long.
        self._nobody = self._hasher.hash(secrets.token_urlsafe())

    def hash(self, password: str) -> str:
        """UserError where it is too short to be one, or longer than what is read at a login."""
        if len(password) < MIN_PASSWORD:
            raise UserError(f"a password needs at least {MIN_PASSWORD} characters")
        if len(password) > MAX_PASSWORD:
            raise UserError(f"a password has at most {MAX_PASSWORD} characters")
        with self._hashing:
            return self._hasher.hash(password)

    def is_right(self, password: str, stored: str | None) -> bool:
        """``stored``: the hash; None: there is no such user, which takes as long to say."""
        with self._hashing:
            verified = self._hasher.verify(password, self._nobody if stored is None else stored)
        return verified and stored is not None
