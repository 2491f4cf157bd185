"""Hashes of passwords for tests that are not about them.

The station's own take a quarter of a second of a core on purpose, at each start and each login.
"""

from __future__ import annotations

from pwdlib import PasswordHash
from pwdlib.hashers.argon2 import Argon2Hasher

QUICK_HASH = PasswordHash((Argon2Hasher(time_cost=1, memory_cost=8, parallelism=1),))
