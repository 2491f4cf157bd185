"""Sentences about errors in one field of a request, for the person who filled it in."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import groupby
from typing import Any

from base_station.api.forms import PATTERN_DESCRIPTIONS

_NUMBER = "must be a number"
_INTEGER = "must be a whole number"
_SENTENCES = {  # by pydantic's names of errors, with the bounds that come along
    "missing": "is missing; fill it in",
    "extra_forbidden": "is not known here; leave it out",
    "string_type": "must be text",
    "string_too_short": "is too short; give {min_length} characters or more",
    "string_too_long": "is too long; give {max_length} characters or fewer",
    "int_type": _INTEGER,
    "int_parsing": _INTEGER,
    "int_parsing_size": _INTEGER + ", and not so large a one",
    "int_from_float": _INTEGER,
    "float_type": _NUMBER,
    "float_parsing": _NUMBER,
    "finite_number": _NUMBER + ", and a finite one",
    "greater_than": "must be more than {gt}",
    "greater_than_equal": "must be {ge} or more",
    "less_than": "must be less than {lt}",
    "less_than_equal": "must be {le} or less",
    "bool_type": "must be true or false",
    "bool_parsing": "must be true or false",
    "literal_error": "must be {expected}",
    "enum": "must be {expected}",
    "list_type": "must be a list",
    "tuple_type": "must be a list",
    "too_short": "has too few entries; give {min_length} or more",
    "too_long": "has too many entries; give {max_length} or fewer",
    "dict_type": "must be a JSON object",
    "model_attributes_type": "must be a JSON object",
}


def error_sentence(error: Mapping[str, Any]) -> str:
    """``error``: one of pydantic's, with its place, its kind and the bounds that were not kept."""
    kind, bounds = error["type"], error.get("ctx", {})
    text: str = error["msg"]
    if kind == "string_pattern_mismatch":
        text = PATTERN_DESCRIPTIONS.get(bounds["pattern"], text)
    elif kind == "string_too_short" and bounds["min_length"] == 1:
        text = "is empty; fill it in"
    elif kind in _SENTENCES:
        text = _SENTENCES[kind].format(**bounds)
    return f"{_place(error['loc'])} {text}".strip()


def _place(location: Sequence[int | str]) -> str:
    """Names the place in body, query or path; an alternative bears the name of a field of its."""
    return ".".join(str(part) for part, _ in groupby(location[1:]))
