"""Text that XML can carry."""

from __future__ import annotations

import re
from html import escape

_NOT_IN_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")

XML_DECLARATION = '<?xml version="1.0" encoding="UTF-8"?>\n'


def in_xml(text: str) -> str:
    """With a mark for each character that XML has no place for: old logs have names with such."""
    return _NOT_IN_XML.sub("\ufffd", text)


def escaped(text: str) -> str:
    """The same as the content of an element."""
    return escape(in_xml(text), quote=False)
