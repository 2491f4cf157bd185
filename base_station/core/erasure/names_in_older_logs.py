"""Names in what earlier versions recorded, taken out by regular expressions.

Only for logs of earlier versions, and for the tables made from them: they have a name in the
assignment of a unit and in any text.  Records of this version have person ids
(``base_station.core.person_references``) and are not changed here.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

import msgspec

from base_station.core.person_references import name_pattern
from base_station.core.state import ERASED_TEXT
from shared.messages import OperatorAction
from shared.messages.station import Assign

# Texts of the program, also for a person called Heat or Fall, and names of actors.
_PROGRAM_FIELDS = frozenset(
    {"rule", "level", "part", "code", "reasons", "thresholds", "station", "who"}
)


def has_names(actions: Iterable[OperatorAction]) -> bool:
    """True where an earlier version wrote at least a part of the log."""
    return any(isinstance(one.action, Assign) and one.action.person_name for one in actions)


class OlderNames:
    """Names of the erased people; none where the log is of this version."""

    def __init__(self, names: Iterable[str]) -> None:
        known = tuple(names)
        self._pattern = name_pattern(known)
        letters = "|".join(map(re.escape, known)) or r"(?!)"
        self._letters = re.compile(letters, re.IGNORECASE)

    def may_be_in(self, payload: bytes) -> bool:
        """True if the bytes have a name; beginnings of words cannot be found in bytes."""
        return self._letters.search(payload.decode("utf-8", "replace")) is not None

    def erased(self, text: str) -> str:
        return self._pattern.sub(ERASED_TEXT, text)

    def erased_in_json(self, detail: str) -> str:
        """Erase names in an audit entry.  It is decoded first: JSON escapes quotation marks within
        names, and names of fields must stay.
        """
        try:
            entry = msgspec.json.decode(detail)
        except msgspec.DecodeError:
            return self.erased(detail)
        if not isinstance(entry, dict):
            return self.erased(detail)
        left = self._erased_in(entry)
        return detail if left == entry else msgspec.json.encode(left).decode()

    def _erased_in(self, value: Any) -> Any:
        match value:
            case str():
                return self.erased(value)
            case list():
                return [self._erased_in(one) for one in value]
            case dict():
                return {
                    field: one if is_program_text(field) else self._erased_in(one)
                    for field, one in value.items()
                }
            case _:
                return value


def is_program_text(field: str) -> bool:
    """True if the program reads fields of this name; they hold no name of a person."""
    return field in _PROGRAM_FIELDS or field.endswith(("_id", "_ids"))
