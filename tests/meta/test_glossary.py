"""The glossary has one line for each term, in the order of the alphabet below each subject."""

from __future__ import annotations

import re

from tests.conftest import PROJECT_ROOT

GLOSSARY = PROJECT_ROOT / "docs" / "glossary.md"


def terms() -> list[list[str]]:
    """The terms of each subject, as they stand."""
    subjects = re.split(r"^## .+$", GLOSSARY.read_text(), flags=re.MULTILINE)[1:]
    return [re.findall(r"^\| (?!term )([^|]+?) \|", text, flags=re.MULTILINE) for text in subjects]


def test_each_subject_is_sorted() -> None:
    for names in terms():
        assert names
        assert names == sorted(names, key=sorting)


def test_no_term_stands_twice() -> None:
    names = [name for subject in terms() for name in subject]
    assert len(names) == len(set(names))


def sorting(name: str) -> str:
    """The letters of a term: *95 % region* stands with r."""
    return name.lower().lstrip("0123456789 %")
