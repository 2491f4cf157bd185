"""Names in what earlier versions recorded, taken out by regular expressions.

Only for logs of earlier versions, and for the tables made from them: there a name stands in the
assignment of a unit and in any text.  What this version records has person ids
(``base_station.core.person_references``), and of that nothing is changed here.
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
    """True where a log was written, in part at least, by an earlier version."""
    return any(isinstance(one.action, Assign) and one.action.person_name for one in actions)


class OlderNames:
    """The names of whom is to be forgotten; none where the log is of this version."""

    def __init__(self, names: Iterable[str]) -> None:
        known = tuple(names)
        self._pattern = name_pattern(known)
        letters = "|".join(map(re.escape, known)) or r"(?!)"
        self._letters = re.compile(letters, re.IGNORECASE)

    def may_be_in(self, payload: bytes) -> bool:
        """In bytes nothing tells where a word begins."""
        return self._letters.search(payload.decode("utf-8", "replace")) is not None

    def erased(self, text: str) -> str:
        return self._pattern.sub(ERASED_TEXT, text)

    def erased_in_json(self, detail: str) -> str:
        """Erase names in an entry of the audit: in JSON a quotation mark within one is written in
        another way, and a field may be called like a person.
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
    """True if what is in a field of this name is what the program goes by, and nobody's name."""
    return field in _PROGRAM_FIELDS or field.endswith(("_id", "_ids"))
