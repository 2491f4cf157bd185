"""TypeScript declarations of msgspec structs, for the console."""

from __future__ import annotations

from collections.abc import Sequence
from types import ModuleType
from typing import Final

import msgspec
from msgspec import inspect

_NAMES: Final = {
    inspect.IntType: "number",
    inspect.FloatType: "number",
    inspect.BoolType: "boolean",
    inspect.StrType: "string",
    inspect.NoneType: "null",
}


def declarations(module: ModuleType) -> dict[str, str]:
    """Return the declarations of the public structs of a module by their names."""
    structs = [
        item
        for item in vars(module).values()
        if isinstance(item, type)
        if issubclass(item, msgspec.Struct) and item.__module__ == module.__name__
        if not item.__name__.startswith("_")
    ]
    types = inspect.multi_type_info(structs)
    return {one.__name__: _declaration(kind) for one, kind in zip(structs, types, strict=True)}


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
            return array_of(_type(item))
        case inspect.TupleType(item_types=items):
            return f"[{', '.join(map(_type, items))}]"
        case inspect.DictType(value_type=value):
            return f"Record<string, {_type(value)}>"
        case _:
            return _NAMES[type(kind)]


def array_of(item: str) -> str:
    """Return the type of an array of a type."""
    return f"({item})[]" if " " in item and not item.startswith("[") else f"{item}[]"
