"""Enumerations from the wire: a number that this program does not know is UNKNOWN, not an error."""

from __future__ import annotations

from enum import IntEnum
from typing import TypeVar

E = TypeVar("E", bound=IntEnum)


def known(enumeration: type[E], number: int) -> E:
    """The member with ``number``, else the member 0; newer senders may say more than we know."""
    try:
        return enumeration(number)
    except ValueError:
        return enumeration(0)
