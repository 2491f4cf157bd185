"""TypeScript declarations of the API's requests and answers, a file a subject.

They are made from the OpenAPI document.  A type belongs to the subject whose addresses use it, and
to ``common`` if several do.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

import msgspec

from shared.clock import ManualClock
from tests.rig.in_process_station import InProcessStation
from tests.rig.struct_types import array_of
from tests.rig.type_files import type_files

_COMMON: Final = "common"
# Subject to the tags of its addresses.
_SUBJECTS: Final[Mapping[str, tuple[str, ...]]] = {
    "accounts": ("login", "users", "tokens"),
    "alarms": ("alarms",),
    "commands": ("commands",),
    "incidents": ("incidents", "dispatch"),
    "people": ("people", "accountability", "assignments", "forgetting"),
    "site": ("site", "pins"),
    "station": ("health", "standby", "audit"),
    "tracks": ("tracks", "replays", "exports"),
    "units": ("units", "enrolments", "recordings", "radio", "samples"),
}
_HEAD: Final = """\
/** {title}
 *
 * Generated from the OpenAPI document of the station, which describes every field; after a change
 * there run `python -m tests.rig.console_types`.
 */
"""
_TITLES: Final = {
    "accounts": "Requests and answers about login, users and tokens.",
    "alarms": "Requests and answers about alarms.",
    "commands": "Requests and answers about orders to units, and routes.",
    _COMMON: "Requests and answers of several subjects.",
    "incidents": "Requests and answers about incidents and dispatches.",
    "people": "Requests and answers about people: roster, duty, assignments, erasure.",
    "site": "Requests and answers about the site: plan, base map, anchor, pins, beacons.",
    "station": "Requests and answers about the station: health, standby, audit.",
    "tracks": "Requests and answers about recorded tracks: timeline, replay, export.",
    "units": "Requests and answers about units: enrolment, recordings, radio, samples.",
}
_SCHEMA_NAMES: Final = {
    "integer": "number",
    "number": "number",
    "boolean": "boolean",
    "string": "string",
    "null": "null",
    "object": "object",
}


def answer_files() -> dict[str, str]:
    """Return the content of each file in ``answers/`` by its name."""
    document = _api_document()
    schemas = document["components"]["schemas"]
    subjects = _subjects_of(document)
    declared: dict[str, dict[str, str]] = {subject: {} for subject in _TITLES}
    for name, schema in sorted(schemas.items()):
        declared[subjects[name]][name] = _declaration(name, schema)
    heads = {subject: _HEAD.format(title=title) for subject, title in _TITLES.items()}
    return type_files(heads, declared)


def _api_document() -> dict[str, Any]:
    with TemporaryDirectory() as folder:
        station = InProcessStation(Path(folder), ManualClock())
        try:
            document: dict[str, Any] = station.app.openapi()
        finally:
            station.close()
    return document


def _subjects_of(document: dict[str, Any]) -> dict[str, str]:
    """Return the subject of each schema by its name."""
    schemas = document["components"]["schemas"]
    subject_of_tag = {tag: subject for subject, tags in _SUBJECTS.items() for tag in tags}
    subjects: dict[str, set[str]] = {name: set() for name in schemas}
    for methods in document["paths"].values():
        for operation in methods.values():
            subject = subject_of_tag[operation["tags"][0]]
            unvisited = list(_references(operation))
            while unvisited:
                name = unvisited.pop()
                if subject not in subjects[name]:
                    subjects[name].add(subject)
                    unvisited.extend(_references(schemas[name]))
    return {name: one.pop() if len(one) == 1 else _COMMON for name, one in subjects.items()}


def _references(part: Any) -> Iterable[str]:
    """Yield the names of the schemas that a part of the document refers to."""
    match part:
        case {"$ref": str(reference)}:
            yield reference.rpartition("/")[2]
        case dict():
            for value in part.values():
                yield from _references(value)
        case list():
            for value in part:
                yield from _references(value)


def _declaration(name: str, schema: dict[str, Any]) -> str:
    if "properties" in schema:
        return f"export interface {name} {{\n{_properties(schema)}}}\n"
    return f"export type {name} = {_schema_type(schema)};\n"


def _properties(schema: dict[str, Any]) -> str:
    required = schema.get("required", ())
    return "".join(
        f"  {name}{'' if name in required else '?'}: {_schema_type(one)};\n"
        for name, one in schema["properties"].items()
    )


def _schema_type(schema: dict[str, Any]) -> str:
    match schema:
        case {"$ref": str(reference)}:
            return reference.rpartition("/")[2]
        case {"enum": values}:
            return " | ".join(f'"{value}"' for value in values)
        case {"const": value}:
            return msgspec.json.encode(value).decode()
        case {"anyOf": kinds} | {"oneOf": kinds}:
            return " | ".join(map(_schema_type, kinds))
        case {"prefixItems": items}:
            return f"[{', '.join(map(_schema_type, items))}]"
        case {"items": item}:
            return array_of(_schema_type(item))
        case {"additionalProperties": dict(value)}:
            return f"Record<string, {_schema_type(value)}>"
        case _:
            return _SCHEMA_NAMES[schema["type"]]
