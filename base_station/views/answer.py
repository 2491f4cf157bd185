"""Base of the structs that consoles are sent and the API answers with."""

from __future__ import annotations

from typing import get_type_hints

import msgspec
from pydantic import Field, GetCoreSchemaHandler, create_model
from pydantic_core import CoreSchema, core_schema

from shared.clock import NS_PER_MS


class Answer(msgspec.Struct, frozen=True):
    """Struct that a route can return: pydantic, and so the OpenAPI document, read its fields from
    here.
    """

    @classmethod
    def __get_pydantic_core_schema__(
        cls, _source: object, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        hints = get_type_hints(cls)
        omits = cls.__struct_config__.omit_defaults
        fields = {
            field.name: (hints[field.name], _default(field) if omits else ...)
            for field in msgspec.structs.fields(cls)
        }
        model = create_model(cls.__name__, __doc__=cls.__doc__, **fields)  # type: ignore[call-overload]
        return core_schema.no_info_before_validator_function(msgspec.to_builtins, handler(model))


def _default(field: msgspec.structs.FieldInfo) -> object:
    if field.default_factory is not msgspec.NODEFAULT:
        return Field(default_factory=field.default_factory)
    return ... if field.required else field.default


def to_ms(t_ns: int) -> int:
    """Return milliseconds since 1970, as in all times of the API."""
    return t_ns // NS_PER_MS


def to_ms_or_none(t_ns: int | None) -> int | None:
    return None if t_ns is None else t_ns // NS_PER_MS
