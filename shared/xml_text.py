"""Text that XML can carry."""

from __future__ import annotations

import re

_NOT_IN_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def in_xml(text: str) -> str:
    """With a mark for each character that XML has no place for: old logs have names with such."""
    return _NOT_IN_XML.sub("\ufffd", text)
