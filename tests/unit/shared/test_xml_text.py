"""Text that XML can carry."""

from __future__ import annotations

import pytest

from shared.xml_text import in_xml


@pytest.mark.parametrize(
    ("text", "carried"),
    [
        ("Ada & <Bo>", "Ada & <Bo>"),
        ("a\tb\nc", "a\tb\nc"),
        ("a\x00b\x1b", "a\ufffdb\ufffd"),
        ("\ud800", "\ufffd"),
        ("\uffff", "\ufffd"),
        ("\U0001f692", "\U0001f692"),
    ],
)
def test_characters_invalid_in_xml_are_marked(text: str, carried: str) -> None:
    assert in_xml(text) == carried
