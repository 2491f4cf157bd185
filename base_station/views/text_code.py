"""Code of a text as the API and the live messages carry it."""

from __future__ import annotations

from collections.abc import Iterable

from base_station.views.wire import TextCodeView
from shared.coded_text import TextCode, code_of_text


def text_code_view_or_none(code: TextCode) -> TextCodeView | None:
    """Return the view of a code; None if the text has no code."""
    return text_code_view(code) if code.code else None


def text_code_views(code: TextCode) -> tuple[TextCodeView, ...]:
    """Return the view of a code in a tuple; an empty one if the text has no code."""
    return (text_code_view(code),) if code.code else ()


def coded_views(texts: Iterable[str]) -> tuple[TextCodeView, ...]:
    """Return the views of the codes of texts, in their order."""
    return tuple(text_code_view(code_of_text(text)) for text in texts)


def text_code_view(code: TextCode) -> TextCodeView:
    return TextCodeView(code.code, code.texts, code.numbers)
