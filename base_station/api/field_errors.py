"""Sentences about errors in one field of a request, for the person who filled it in."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import reduce
from itertools import groupby
from typing import Any

from base_station.api.forms import PATTERN_DESCRIPTIONS
from shared.coded_text import Term, coded

_INTEGER = coded("field-integer", "must be a whole number")
_NUMBER = coded("field-number", "must be a number")
_TRUTH = coded("field-truth", "must be true or false")
_LIST = coded("field-list", "must be a list")
_OBJECT = coded("field-object", "must be a JSON object")
_FAULTS = {  # by pydantic's names of errors
    "missing": coded("field-missing", "is missing; fill it in"),
    "extra_forbidden": coded("field-not-known", "is not known here; leave it out"),
    "string_type": coded("field-text", "must be text"),
    "int_type": _INTEGER,
    "int_parsing": _INTEGER,
    "int_parsing_size": coded(
        "field-integer-too-large", "must be a whole number, and not so large a one"
    ),
    "int_from_float": _INTEGER,
    "float_type": _NUMBER,
    "float_parsing": _NUMBER,
    "finite_number": coded("field-not-finite", "must be a number, and a finite one"),
    "bool_type": _TRUTH,
    "bool_parsing": _TRUTH,
    "list_type": _LIST,
    "tuple_type": _LIST,
    "dict_type": _OBJECT,
    "model_attributes_type": _OBJECT,
    "target": coded("field-target", "must be one of: unit_id, crew, floor, everyone"),
}


def error_sentence(error: Mapping[str, Any]) -> str:
    """Sentence about an error of pydantic: ``error`` has its place, its kind and the limits that
    were exceeded.
    """
    fault, field = _fault(error), _place(error["loc"])
    return coded("field-fault", "{field} {fault}", field=field, fault=fault) if field else fault


def joined_sentences(sentences: Iterable[str]) -> str:
    """Join sentences into one, which has the codes of all."""
    return reduce(_joined, sentences)


def _joined(before: str, last: str) -> str:
    return coded("faults-joined", "{before}; {last}", before=before, last=last)


def _fault(error: Mapping[str, Any]) -> str:
    kind, bounds = error["type"], error.get("ctx", {})
    text: str = error["msg"]
    match kind:
        case "string_pattern_mismatch":
            return PATTERN_DESCRIPTIONS.get(bounds["pattern"], text)
        case "string_too_short" if bounds["min_length"] == 1:
            return coded("field-empty", "is empty; fill it in")
        case "string_too_short" | "string_too_long" | "too_short" | "too_long":
            return _length_fault(kind, bounds)
        case "greater_than" | "greater_than_equal" | "less_than" | "less_than_equal":
            return _limit_fault(kind, bounds)
        case "literal_error" | "enum":
            expected = bounds["expected"]
            allowed = Term(expected.replace(" or ", ", "), expected)
            return coded("field-choice", "must be {allowed}", allowed=allowed)
        case _:
            return _FAULTS.get(kind, text)


def _length_fault(kind: str, bounds: Mapping[str, Any]) -> str:
    if kind == "string_too_short":
        return coded(
            "field-too-short",
            "is too short; give {least} characters or more",
            least=bounds["min_length"],
        )
    if kind == "string_too_long":
        return coded(
            "field-too-long",
            "is too long; give {most} characters or fewer",
            most=bounds["max_length"],
        )
    if kind == "too_short":
        return coded(
            "field-entries-too-few",
            "has too few entries; give {least} or more",
            least=bounds["min_length"],
        )
    return coded(
        "field-entries-too-many",
        "has too many entries; give {most} or fewer",
        most=bounds["max_length"],
    )


def _limit_fault(kind: str, bounds: Mapping[str, Any]) -> str:
    if kind == "greater_than":
        return coded("field-not-above", "must be more than {limit}", limit=bounds["gt"])
    if kind == "greater_than_equal":
        return coded("field-too-low", "must be {least} or more", least=bounds["ge"])
    if kind == "less_than":
        return coded("field-not-below", "must be less than {limit}", limit=bounds["lt"])
    return coded("field-too-high", "must be {most} or less", most=bounds["le"])


def _place(location: Sequence[int | str]) -> str:
    """Name of the field in body, query or path; an alternative is called by the name of one of its
    fields.
    """
    return ".".join(str(part) for part, _ in groupby(location[1:]))
