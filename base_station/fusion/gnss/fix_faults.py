"""Faults by which a satellite fix cannot be true: codes, and words for a person."""

from __future__ import annotations

from collections.abc import Mapping

FIX_FAULTS: Mapping[str, str] = {
    "not-a-number": "coordinates that are no numbers",
    "not-on-earth": "coordinates that are not on the Earth",
    "zero": "latitude and longitude 0",
    "height": "a height at which nobody stands",
    "accuracy": "an accuracy that cannot be used",
    "far-away": "too far from the site",
    "stuck": "the receiver is stuck",
}
_CODES = {words: code for code, words in FIX_FAULTS.items()}


def fault_code(words: str) -> str:
    """The code of a fault in words; the words themselves where they are of no known fault."""
    return _CODES.get(words, words)
