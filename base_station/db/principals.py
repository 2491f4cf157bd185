"""Who asks something of the station, and how much they may."""

from __future__ import annotations

from enum import IntEnum

import msgspec

from shared.errors import UserError


class Role(IntEnum):
    """Each may do what those below it may."""

    VIEWER = 1
    COMMANDER = 2
    ADMINISTRATOR = 3

    @property
    def word(self) -> str:
        return self.name.lower()

    @staticmethod
    def of(word: str) -> Role:
        try:
            return Role[word.upper()]
        except KeyError:
            known = ", ".join(role.word for role in Role)
            raise UserError(f"there is no role {word!r}; roles are {known}") from None


class Principal(msgspec.Struct, frozen=True):
    """Who is asking."""

    username: str
    role: Role
    scopes: frozenset[str] = frozenset()  # parts of the API; empty: all that the role may
    token_ends_ns: int | None = None  # None: it does not, or who asks has logged in
