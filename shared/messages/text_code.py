"""Code of a text for a person, on the wire."""

from __future__ import annotations

from shared.coded_text import NO_CODE, TextCode
from shared.messages.muster.v1 import text_code_pb2


def put_text_code(wire: text_code_pb2.TextCode, code: TextCode) -> None:
    """Fill the wire message; a text without a code leaves it empty, as if it were not there."""
    if code.code:
        wire.code = code.code
        wire.texts.update(code.texts)
        wire.numbers.update(code.numbers)


def get_text_code(wire: text_code_pb2.TextCode) -> TextCode:
    """``NO_CODE`` of a message without one, as of an earlier version."""
    if not wire.code:
        return NO_CODE
    return TextCode(wire.code, dict(wire.texts), dict(wire.numbers))
