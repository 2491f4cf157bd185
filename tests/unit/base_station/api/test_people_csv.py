"""CSV files of people as spreadsheets write them, and their faults by line."""

from __future__ import annotations

import pytest

from base_station.api.people_csv import MOST_PEOPLE, CsvPerson, read_people
from shared.errors import UserError

_PEOPLE = [
    CsvPerson(2, "Ana Kovač", "Ladder 1", "Officer"),
    CsvPerson(3, "Jürgen Groß", "Ladder 1", None),
]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
@pytest.mark.parametrize("separator", [",", ";", "\t"])
@pytest.mark.parametrize(
    "titles", ["Name,Crew,Role", "full name,TEAM,rank", "Nom,Équipe,Grade", "Name,Trupp,Dienstgrad"]
)
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_spellings_of_spreadsheets(encoding: str, separator: str, titles: str, end: str) -> None:
    lines = [titles, "Ana Kovač,Ladder 1,Officer", "Jürgen Groß,Ladder 1,", ",,", ""]
    text = end.join(lines).replace(",", separator)
    assert read_people(text.encode(encoding)) == (_PEOPLE, [])


def test_latin_1_and_windows_1252_are_read_where_a_file_is_no_utf_8() -> None:
    content = "Vorname;Name;Gruppe\nJürgen;Groß;Zug “2”\n".encode("cp1252")
    assert read_people(content).people == [CsvPerson(2, "Jürgen Groß", "Zug “2”", None)]
    (person,) = read_people("Name\nJürgen Groß\n".encode("latin-1")).people
    assert person.name == "Jürgen Groß"


def test_first_and_last_name_quotation_marks_and_a_line_that_names_the_separator() -> None:
    content = b'sep=;\r\nFirst name;Last name;Crew\r\n"Bo";"Li; jr";"Engine\xc2\xa02"\r\n'
    assert read_people(content).people == [CsvPerson(3, "Bo Li; jr", "Engine\xa02", None)]


def test_faults_are_named_by_line_and_the_other_people_are_read() -> None:
    content = f'Name,Crew\nAda,E 1\n,E 1\n"Bo\nLi",E 1\n{"x" * 81},E 1\nADA ,E 2\nBea,E\x07\nCy,\n'
    found = read_people(content.encode())
    assert found.people == [CsvPerson(2, "Ada", "E 1", None), CsvPerson(4, "Bo Li", "E 1", None),
                            CsvPerson(9, "Cy", None, None)]  # fmt: skip
    faults = dict(found.faults)
    assert list(faults) == [3, 6, 7, 8]
    assert faults[3] == "the name is missing"
    assert "longer than 80" in faults[6]
    assert "in line 2 already" in faults[7]
    assert faults[8].startswith("the crew")


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "is empty"),
        (b"Name,Crew\n", "no person below it"),
        (b"Ada,Engine 1\nBea,Engine 1\n", "names no column of names"),
        (b"Name,Full name\nAda,Ada\n", "two columns of one meaning"),
        (b"Name\nName of the crew\n".replace(b"N", b"\x00"), "names no column"),
        (b'Name,Crew\n"Ada,Engine 1\n', "quotation mark"),
        (b"PK\x03\x04" + bytes(100), "is a workbook"),
        (b"\xff\xd8\xff\xe0 picture", "names no column"),
        (b"Name\n" + b"".join(b"Person %d\n" % number for number in range(10_000)), "more than"),
    ],
)
def test_file_without_people_is_refused(content: bytes, reason: str) -> None:
    with pytest.raises(UserError, match=reason):
        read_people(content)


def test_largest_file_is_accepted() -> None:
    content = b"Name\n" + b"".join(b"Person %d\n" % number for number in range(MOST_PEOPLE))
    assert len(read_people(content).people) == MOST_PEOPLE
