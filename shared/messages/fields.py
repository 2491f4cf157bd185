"""Structs whose fields stand on the wire under the same names and in the same units."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import msgspec
from google.protobuf.descriptor import FieldDescriptor

from shared.coded_text import TextCode
from shared.messages.muster.v1 import text_code_pb2
from shared.messages.text_code import get_text_code, put_text_code


def put_fields(part: Any, struct: msgspec.Struct) -> None:
    """Fill a wire message from a struct; what is None is left out."""
    for name in struct.__struct_fields__:
        value = getattr(struct, name)
        if isinstance(value, tuple):
            _put_each(getattr(part, name), value)
        elif isinstance(value, dict):
            getattr(part, name).update(value)
        elif value is not None:
            setattr(part, name, value)


def _put_each(repeated: Any, values: tuple[Any, ...]) -> None:
    for value in values:
        if isinstance(value, TextCode):
            put_text_code(repeated.add(), value)
        else:
            repeated.append(value)


def get_fields(part: Any, struct: type[msgspec.Struct]) -> dict[str, Any]:
    """A struct's fields from a wire message."""
    fields = part.DESCRIPTOR.fields_by_name
    return {name: _get(part, fields[name]) for name in struct.__struct_fields__}


def _get(part: Any, field: FieldDescriptor) -> Any:
    if field.is_repeated:
        value = getattr(part, field.name)
        if isinstance(value, Mapping):
            return dict(value)
        if field.message_type is text_code_pb2.TextCode.DESCRIPTOR:
            return tuple(map(get_text_code, value))
        return tuple(value)
    if field.has_presence and not part.HasField(field.name):
        return None
    return getattr(part, field.name)
