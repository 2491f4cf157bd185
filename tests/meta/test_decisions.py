"""Decision records have the form that their index states."""

from __future__ import annotations

import re

import pytest

from tests.conftest import PROJECT_ROOT

FOLDER = PROJECT_ROOT / "docs" / "decisions"
RECORDS = sorted(FOLDER.glob("[0-9]*.md"))
LINK = re.compile(r"\[(\d+)\]\([^)]*\)")
HEAD = re.compile(r"# (\d+)\. .+\n\nStatus: (Accepted|Superseded).*\n\nDate: \d{4}-\d\d-\d\d\n\n")


@pytest.mark.parametrize("record", RECORDS, ids=lambda record: record.stem[:3])
def test_a_record_has_number_title_status_date_and_sections(record):
    text = record.read_text()
    head = HEAD.match(text)
    assert head, "number and title, Status: Accepted or Superseded by ..., Date: YYYY-MM-DD"
    assert int(head[1]) == int(record.stem[:3])
    sections = re.findall(r"^## (.+)$", text, flags=re.MULTILINE)
    assert sections[:2] == ["Context", "Decision"]
    assert "Consequences" in sections


def test_the_index_lists_every_record_with_its_title_and_status():
    index = (FOLDER / "README.md").read_text()
    for record in RECORDS:
        head, _, status, *_ = record.read_text().splitlines()
        number, _, title = head.removeprefix("# ").partition(". ")
        status = LINK.sub(r"\1", status.removeprefix("Status: "))
        assert f"| {number} | [{title}]({record.name}) | {status} |" in index


@pytest.mark.parametrize("record", RECORDS, ids=lambda record: record.stem[:3])
def test_superseded_record_names_its_successor(record):
    _, _, status, *_ = record.read_text().splitlines()
    if status.startswith("Status: Superseded"):
        assert re.match(r"Status: Superseded by \[\d+\]\(\d{3}-[a-z0-9-]+\.md\)", status)


def test_numbers_of_records_are_unique():
    numbers = [record.stem[:3] for record in RECORDS]
    assert len(set(numbers)) == len(numbers)
