"""Principals: users and API tokens that send requests, and their roles and scopes."""

from __future__ import annotations

import re
from enum import IntEnum

import msgspec

from shared.coded_text import coded
from shared.errors import UserError

# No name has these: controls, ends of lines, changes of direction, characters invalid in XML.
BARRED = r"\x00-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ufffe\uffff"
_USERNAME = re.compile(rf"(?!\.\.?$)(?=.*\S)[^/\ud800-\udfff{BARRED}]{{1,80}}")


def require_username(username: str) -> None:
    """Raise UserError if the name cannot be used to log in, or in an address of the API."""
    if _USERNAME.fullmatch(username) is None:
        raise UserError(
            coded(
                "username-unfit",
                "a user's name is one line of 1 to 80 plain characters, without '/'",
            )
        )


class Role(IntEnum):
    """Role of a user; each may do what those below it may."""

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
            raise UserError(
                coded(
                    "role-unknown",
                    "there is no role {role!r}; roles are {known}",
                    role=word,
                    known=known,
                )
            ) from None


class Principal(msgspec.Struct, frozen=True):
    """User or token of a request."""

    username: str
    role: Role
    scopes: frozenset[str] = frozenset()  # parts of the API; empty: all that the role may
    token_ends_ns: int | None = None  # None: it does not end, or this is a login
    unit_id: str = ""  # unit that the token may post samples for; empty: not a unit's token
    must_change_password: bool = False  # it was generated; until then nothing else may be done
