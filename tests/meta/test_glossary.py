"""The glossary has one line for each term, sorted below each subject."""

from __future__ import annotations

import re

from tests.conftest import PROJECT_ROOT

GLOSSARY = PROJECT_ROOT / "docs" / "glossary.md"


def terms() -> list[list[str]]:
    """Terms of each subject, in the order of the page."""
    subjects = re.split(r"^## .+$", GLOSSARY.read_text(), flags=re.MULTILINE)[1:]
    return [re.findall(r"^\| (?!term )([^|]+?) \|", text, flags=re.MULTILINE) for text in subjects]


def test_each_subject_is_sorted() -> None:
    for names in terms():
        assert names
        assert names == sorted(names, key=sorting)


def test_terms_are_unique() -> None:
    names = [name for subject in terms() for name in subject]
    assert len(names) == len(set(names))


def sorting(name: str) -> str:
    """Sorting key of a term: *95 % region* is sorted under r."""
    return name.lower().lstrip("0123456789 %")
