"""References to people in texts: ``{person ID}`` stands in the log wherever a name is shown.

A name is put in when a text is shown or sent, and taken out when an operator has entered one.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Mapping
from typing import Any

import msgspec

from shared.messages.pins import PlaceBeacon, SetMeeting, SetPin, StartTogether
from shared.messages.station import (
    Action,
    ImportFile,
    NoteDispatch,
    OpenIncident,
    RegisterUnit,
    ResolveAlarm,
    SendCommand,
)

_BEGIN = "{person "
_REFERENCE = re.compile(r"\{person ([A-Za-z0-9_.:-]+)\}")
_NUMBER = re.compile(r"(\{person [^}]*\})|\d+")

# Free texts of operators, by the kind of action and its field.
FREE_TEXTS: Mapping[type[Action], str] = {
    OpenIncident: "name",
    RegisterUnit: "label",
    ResolveAlarm: "note",
    SendCommand: "text",
    NoteDispatch: "remarks",
    ImportFile: "file_name",
    SetPin: "note",
    StartTogether: "note",
    SetMeeting: "note",
    PlaceBeacon: "label",
}


def reference_to(person_id: str) -> str:
    return f"{_BEGIN}{person_id}}}"


def with_names(text: str, name_of: Callable[[str], str]) -> str:
    """Return the text as it is shown; ``name_of``: the name for a person id."""
    if _BEGIN not in text:  # nearly always
        return text
    return _REFERENCE.sub(lambda found: name_of(found[1]), text)


def references_in(text: str) -> set[str]:
    """Return the ids of the people in a text."""
    return set(_REFERENCE.findall(text))


def without_people(text: str, person_ids: Collection[str], instead: str) -> str:
    """The text without the references to these people."""
    return with_names(text, lambda one: instead if one in person_ids else reference_to(one))


def without_numbers(text: str) -> str:
    """Text without its numbers, to compare texts that differ only in an amount; the numbers in a
    reference name its person, and stay.
    """
    return _NUMBER.sub(lambda found: found[1] or "", text)


def name_pattern(names: Collection[str]) -> re.Pattern[str]:
    """Matches any of the names, in whatever case; nothing where there are none.

    A name is a word, or one with an s behind it: of Al and Ana, neither alarms nor Anabel match.
    """
    longest_first = sorted(names, key=lambda one: (-len(one), one))
    any_of = "|".join(map(re.escape, longest_first)) or r"(?!)"
    return re.compile(rf"(?<!\w)(?:{any_of})(?=s?(?!\w))", re.IGNORECASE)


def with_references(action: Action, ids_by_name: Mapping[str, str]) -> Action:
    """Return the action with names of the roster in its free text replaced by references."""
    field = FREE_TEXTS.get(type(action))
    text = getattr(action, field) if field else ""
    if not text or not ids_by_name:
        return action
    by_folded = {name.lower(): person_id for name, person_id in ids_by_name.items()}

    def reference(found: re.Match[str]) -> str:
        person_id = by_folded.get(found[0].lower())
        return found[0] if person_id is None else reference_to(person_id)

    changed: dict[str, Any] = {str(field): name_pattern(list(ids_by_name)).sub(reference, text)}
    return action if changed[str(field)] == text else msgspec.structs.replace(action, **changed)
