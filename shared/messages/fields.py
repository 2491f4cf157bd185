"""Structs whose fields stand on the wire under the same names and in the same units."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import msgspec
from google.protobuf.descriptor import FieldDescriptor


def put_fields(part: Any, struct: msgspec.Struct) -> None:
    """Fill a wire message from a struct; what is None is left out."""
    for name in struct.__struct_fields__:
        value = getattr(struct, name)
        if isinstance(value, tuple):
            getattr(part, name).extend(value)
        elif isinstance(value, dict):
            getattr(part, name).update(value)
        elif value is not None:
            setattr(part, name, value)


def get_fields(part: Any, struct: type[msgspec.Struct]) -> dict[str, Any]:
    """A struct's fields from a wire message."""
    fields = part.DESCRIPTOR.fields_by_name
    return {name: _get(part, fields[name]) for name in struct.__struct_fields__}


def _get(part: Any, field: FieldDescriptor) -> Any:
    if field.is_repeated:
        value = getattr(part, field.name)
        return dict(value) if isinstance(value, Mapping) else tuple(value)
    if field.has_presence and not part.HasField(field.name):
        return None
    return getattr(part, field.name)
