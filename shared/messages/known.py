"""Enumerations from the wire: a number that this program does not know is UNKNOWN, not an error."""

from __future__ import annotations

from enum import IntEnum
from functools import lru_cache
from typing import TypeVar

E = TypeVar("E", bound=IntEnum)


@lru_cache(maxsize=1024)  # making a member of a number costs more than all else of a message
def known(enumeration: type[E], number: int) -> E:
    """The member with ``number``, else the member 0; newer senders may say more than we know."""
    try:
        return enumeration(number)
    except ValueError:
        return enumeration(0)
