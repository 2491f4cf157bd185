"""Types of fields in the console, and as JSON schema, that the struct alone does not say."""

from __future__ import annotations

from typing import Any

import msgspec


def shown_as(typescript: str, schema: dict[str, Any]) -> msgspec.Meta:
    """Type in the console, and as JSON schema, of a field whose Python type does not determine
    it.
    """
    return msgspec.Meta(extra={"typescript": typescript}, extra_json_schema=schema)


def one_of(*values: str) -> msgspec.Meta:
    """Values that a string can have."""
    return shown_as(" | ".join(f'"{value}"' for value in values), {"enum": values})
