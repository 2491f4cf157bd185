"""Passwords as argon2 hashes.  Making and checking a hash takes long, and 64 MB, on purpose.

Two threads of low priority do all of it, so that many attempts take little time from other
requests.  While they compute they do not hold the interpreter's lock.
"""

from __future__ import annotations

import os
import secrets
import threading
from concurrent.futures import ThreadPoolExecutor

from pwdlib import PasswordHash

from shared.coded_text import coded
from shared.errors import UserError

MIN_PASSWORD, MAX_PASSWORD = 10, 256
_AT_ONCE = 2
_NICENESS = 5  # of the thread, and of those that argon2 makes for its lanes


class Passwords:
    """Maker and checker of hashes.  Thread-safe."""

    def __init__(self, hasher: PasswordHash | None = None) -> None:
        self._hasher = hasher or PasswordHash.recommended()
        self._worker = ThreadPoolExecutor(_AT_ONCE, "passwords", initializer=_lower_priority)
        # Checked for unknown names, so that the answer takes as long.
        self._unknown_user_hash = self._worker.submit(self._hasher.hash, secrets.token_urlsafe())

    def hash(self, password: str) -> str:
        """Return the hash.  Raises UserError if the password is too short, or longer than a login
        may be.
        """
        if len(password) < MIN_PASSWORD:
            raise UserError(
                coded(
                    "password-too-short",
                    "a password needs at least {least} characters",
                    least=MIN_PASSWORD,
                )
            )
        if len(password) > MAX_PASSWORD:
            raise UserError(
                coded(
                    "password-too-long",
                    "a password has at most {most} characters",
                    most=MAX_PASSWORD,
                )
            )
        return self._worker.submit(self._hasher.hash, password).result()

    def is_valid(self, password: str, stored: str | None) -> bool:
        """True if the password has this hash.  ``stored`` is None for an unknown user; the answer
        then takes as long.
        """
        against = self._unknown_user_hash.result() if stored is None else stored
        verified = self._worker.submit(self._hasher.verify, password, against).result()
        return verified and stored is not None


def _lower_priority() -> None:
    """Lower the priority of this thread: on Linux each thread has its own niceness."""
    os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), _NICENESS)
