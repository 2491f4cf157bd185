"""Code of a text as the API and the live wire have it."""

from __future__ import annotations

from base_station.views.wire import TextCodeView
from shared.coded_text import TextCode


def text_code_view(code: TextCode) -> TextCodeView:
    return TextCodeView(code.code, code.texts, code.numbers)
