"""Generator of the console's types: ``wire.ts`` from the structs of the live picture,
``answers.ts`` from the OpenAPI document, and those of the department's page; with ``docs/live.md``,
the page about the WebSocket.

``python -m tests.rig.console_types`` writes the files; a test fails while they are not current.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from types import ModuleType
from typing import Any, Final

import msgspec
from msgspec import inspect

from base_station.department import answers as department_answers
from base_station.views.wire import (
    alarm,
    command,
    incident,
    message,
    place,
    replay,
    station,
    text_code,
    trail,
    unit,
)
from shared.clock import ManualClock
from tests.rig.in_process_station import InProcessStation
from tests.rig.live_page import LIVE_MD, LIVE_SCHEMA, page, schema_file

_SOURCES: Final = Path(__file__).resolve().parents[2] / "base_station/console/src"
WIRE_TS: Final = _SOURCES / "wire.ts"
ANSWERS_TS: Final = _SOURCES / "answers.ts"
DEPARTMENT_TS: Final = _SOURCES / "department/answers.ts"
_WIRE: Final = (text_code, unit, alarm, command, incident, place, station, replay, trail, message)
_HEAD: Final = """\
/** Messages of the station to the console, over the WebSocket.
 *
 * Generated from `base_station/views/wire`, which describes every field; after a change there run
 * `python -m tests.rig.console_types`.
 */
import type { Plan } from "./plan/planFile";

export type { Plan };
"""
_TAIL: Final = """export type Link = UnitView["link"];
export type DeliveryState = DeliveryView["state"];
export type Message = Snapshot | Trail | FieldDelta;

/** The fields of a unit that changed: all of them for a unit that is new. */
export type UnitChange = Changed<UnitView>;
type Changed<T> = { [K in keyof T]?: T[K] extends readonly unknown[] ? T[K] : ChangedValue<T[K]> };
type ChangedValue<V> = V extends object ? (V extends readonly unknown[] ? V : Changed<V>) : V;
"""
_ANSWERS_HEAD: Final = """\
/** Requests and answers of the station's API.
 *
 * Generated from its OpenAPI document, which describes every field; after a change there run
 * `python -m tests.rig.console_types`.
 */
"""
_DEPARTMENT_HEAD: Final = """\
/** Answers of a department's API.
 *
 * Generated from `base_station/department/answers.py`, which describes every field; after a change
 * there run `python -m tests.rig.console_types`.
 */
import type { AlarmParametersView, TextCodeView } from "../wire";
"""
_SCHEMA_NAMES: Final = {
    "integer": "number",
    "number": "number",
    "boolean": "boolean",
    "string": "string",
    "null": "null",
    "object": "object",
}
_NAMES: Final = {
    inspect.IntType: "number",
    inspect.FloatType: "number",
    inspect.BoolType: "boolean",
    inspect.StrType: "string",
    inspect.NoneType: "null",
}


def wire_types() -> str:
    """Return the content of ``wire.ts``."""
    return "\n".join([_HEAD, *(text for module in _WIRE for text in _declarations(module)), _TAIL])


def department_types() -> str:
    """Return the content of ``department/answers.ts``."""
    return "\n".join([_DEPARTMENT_HEAD, *_declarations(department_answers)])


def _declarations(module: ModuleType) -> list[str]:
    """Declarations of its public structs."""
    structs = [
        item
        for item in vars(module).values()
        if isinstance(item, type)
        if issubclass(item, msgspec.Struct) and item.__module__ == module.__name__
        if not item.__name__.startswith("_")
    ]
    return [_declaration(one) for one in inspect.multi_type_info(structs)]


def _declaration(struct: inspect.Type) -> str:
    assert isinstance(struct, inspect.StructType)
    name, omits = struct.cls.__name__, struct.cls.__struct_config__.omit_defaults
    if struct.array_like:  # ends behind its last element that is no default
        elements = [f"  {_field(field, optional=not field.required)}," for field in struct.fields]
        return "\n".join([f"export type {name} = [", *elements, "];\n"])
    lines = [f"export interface {name} {{"]
    if struct.tag is not None:
        lines.append(f'  {struct.tag_field}: "{struct.tag}";')
    lines += [
        f"  {_field(field, optional=omits and not field.required)};" for field in struct.fields
    ]
    return "\n".join([*lines, "}\n"])


def _field(field: inspect.Field, *, optional: bool) -> str:
    if not optional:
        return f"{field.encode_name}: {_type(field.type)}"
    kind: inspect.Type = field.type
    if isinstance(kind, inspect.UnionType) and field.default is None:  # left out, never null
        kind = _union([one for one in kind.types if not isinstance(one, inspect.NoneType)])
    return f"{field.encode_name}?: {_type(kind)}"


def _union(kinds: Sequence[inspect.Type]) -> inspect.Type:
    return kinds[0] if len(kinds) == 1 else inspect.UnionType(tuple(kinds))


def _type(kind: inspect.Type) -> str:
    match kind:
        case inspect.Metadata(type=inner, extra=extra):
            return extra["typescript"] if extra else _type(inner)
        case inspect.StructType(cls=struct):
            return struct.__name__
        case inspect.LiteralType(values=values):
            return " | ".join(f'"{value}"' for value in values)
        case inspect.UnionType(types=types):
            return " | ".join(map(_type, types))
        case inspect.VarTupleType(item_type=item):
            return _array(_type(item))
        case inspect.TupleType(item_types=items):
            return f"[{', '.join(map(_type, items))}]"
        case inspect.DictType(value_type=value):
            return f"Record<string, {_type(value)}>"
        case _:
            return _NAMES[type(kind)]


def _array(item: str) -> str:
    return f"({item})[]" if " " in item and not item.startswith("[") else f"{item}[]"


def answer_types() -> str:
    """Return the content of ``answers.ts``."""
    schemas = _api_schemas()
    declared = [
        f"export interface {name} {{\n{_properties(schema)}}}\n"
        if "properties" in schema
        else f"export type {name} = {_schema_type(schema)};\n"
        for name, schema in sorted(schemas.items())
    ]
    return "\n".join([_ANSWERS_HEAD, *declared])


def _api_schemas() -> dict[str, Any]:
    with TemporaryDirectory() as folder:
        station = InProcessStation(Path(folder), ManualClock())
        try:
            schemas: dict[str, Any] = station.app.openapi()["components"]["schemas"]
        finally:
            station.close()
    return schemas


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
            return _array(_schema_type(item))
        case {"additionalProperties": dict(value)}:
            return f"Record<string, {_schema_type(value)}>"
        case _:
            return _SCHEMA_NAMES[schema["type"]]


def main() -> None:
    """Write the files."""
    WIRE_TS.write_text(wire_types(), encoding="utf-8")
    ANSWERS_TS.write_text(answer_types(), encoding="utf-8")
    DEPARTMENT_TS.write_text(department_types(), encoding="utf-8")
    LIVE_MD.write_text(page(), encoding="utf-8")
    LIVE_SCHEMA.write_text(schema_file(), encoding="utf-8")


if __name__ == "__main__":
    main()
