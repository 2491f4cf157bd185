"""People and crews from a CSV file as spreadsheets write it.  Every fault is reported with its
line.

Encodings: UTF-8 (with a byte order mark or without), UTF-16 with a byte order mark, and
Windows-1252 (of which Latin-1 is a part) for all else.  Separators: comma, semicolon or tabulator.
The first line names the columns, in English, German or French.  Pure.
"""

from __future__ import annotations

import codecs
import csv
import io
from collections.abc import Iterator, Mapping
from contextlib import suppress
from typing import NamedTuple

import pydantic

from base_station.api.forms import MAX_TEXT_LETTERS, Name, ShortText
from base_station.storage.db.people_import import same_name
from shared.coded_text import coded
from shared.errors import UserError

MOST_PEOPLE = 2000  # of one file: a console lists all of them
MOST_CSV_BYTES = 1_000_000
_SEPARATORS = (",", ";", "\t")
_HINT = "sep="  # first line of some spreadsheets' files
_WORKBOOK = b"PK\x03\x04"  # of Excel and of LibreOffice: a ZIP file

_TITLES: Mapping[str, str] = {  # in small letters, between commas
    "name": "name, full name, display name, nom, nom complet, vollständiger name",
    "first": "first name, firstname, given name, vorname, prénom, prenom",
    "last": "last name, lastname, surname, family name, nachname, familienname, nom de famille",
    "crew": "crew, team, company, trupp, gruppe, mannschaft, einheit, équipe, equipe, équipage",
    "role": "role, rank, function, rolle, funktion, dienstgrad, rang, rôle, grade, fonction",
}
_BY_TITLE = {title: column for column, titles in _TITLES.items() for title in titles.split(", ")}


class CsvPerson(NamedTuple):
    line: int  # of the file, from 1
    name: str
    crew: str | None  # None: the file has no such column
    role: str | None


class CsvFault(NamedTuple):
    line: int
    text: str


class PeopleFile(NamedTuple):
    people: list[CsvPerson]
    faults: list[CsvFault]


def read_people(content: bytes) -> PeopleFile:
    """Return the people of the file, and its faulty lines; no line is in both.

    Raises UserError if the file as a whole is no such list.
    """
    lines = list(io.StringIO(_text_of(content), newline=""))
    skipped = 1 if lines and lines[0].casefold().startswith(_HINT) else 0
    separator = _separator(lines, skipped)
    rows = csv.reader(lines[skipped:], delimiter=separator, strict=True)
    try:
        return _read_rows(_numbered(rows, skipped))
    except csv.Error as error:
        line = rows.line_num + skipped
        raise UserError(
            coded(
                "csv-line-unreadable",
                "line {line} of the file cannot be read: {error}; look for a quotation "
                "mark that is not closed",
                line=line,
                error=str(error),
            )
        ) from error


def _text_of(content: bytes) -> str:
    if content.startswith(_WORKBOOK):
        raise UserError(
            coded(
                "csv-is-workbook",
                "this file is a workbook; save it as CSV in the spreadsheet, and send that",
            )
        )
    if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        with suppress(UnicodeDecodeError):
            return content.decode("utf-16")
    for encoding in ("utf-8-sig", "cp1252"):
        with suppress(UnicodeDecodeError):
            return content.decode(encoding)
    return content.decode("latin-1")


def _separator(lines: list[str], skipped: int) -> str:
    if skipped:
        named = lines[0][len(_HINT) :].strip("\r\n")
        if named in _SEPARATORS:
            return named
    title = next((line for line in lines[skipped:] if line.strip()), "")
    return max(_SEPARATORS, key=title.count)


def _numbered(rows: Iterator[list[str]], skipped: int) -> Iterator[tuple[int, list[str]]]:
    """Rows that are not blank, each with the number of its first line."""
    begins = 1 + skipped
    for row in rows:
        cells = [cell.strip() for cell in row]
        if any(cells):
            yield begins, cells
        begins = rows.line_num + skipped + 1  # type: ignore[attr-defined]  # of ``csv.reader``


def _read_rows(rows: Iterator[tuple[int, list[str]]]) -> PeopleFile:
    titled = next(rows, None)
    if titled is None:
        raise UserError(coded("csv-empty", "the file is empty"))
    columns = _columns(*titled)
    people: list[CsvPerson] = []
    faults: list[CsvFault] = []
    first_line: dict[str, int] = {}
    for number, (line, cells) in enumerate(rows):
        if number >= MOST_PEOPLE:
            raise UserError(
                coded(
                    "csv-too-many",
                    "the file has more than {most} people; send those who may come to one "
                    "incident, or several files",
                    most=MOST_PEOPLE,
                )
            )
        person = _person(line, cells, columns)
        if isinstance(person, CsvFault):
            faults.append(person)
            continue
        before = first_line.setdefault(same_name(person.name), line)
        if before != line:
            twice = coded(
                "csv-person-twice",
                "{name} is in line {line} already; tell the two apart by their names",
                name=person.name,
                line=before,
            )
            faults.append(CsvFault(line, twice))
        else:
            people.append(person)
    if not people and not faults:
        raise UserError(
            coded("csv-nobody", "the file has a line of column names and no person below it")
        )
    return PeopleFile(people, faults)


def _columns(line: int, titles: list[str]) -> dict[str, int]:
    """Index of each known column, by its meaning."""
    found: dict[str, int] = {}
    for number, title in enumerate(titles):
        column = _BY_TITLE.get(same_name(title))
        if column is None:
            continue
        if column in found:
            raise UserError(
                coded(
                    "csv-columns-alike",
                    "line {line} of the file has two columns of one meaning: {first} and "
                    "{second}; remove one",
                    line=line,
                    first=titles[found[column]],
                    second=title,
                )
            )
        found[column] = number
    if "first" in found and "name" in found and "last" not in found:
        found["last"] = found.pop("name")  # "Name, Vorname" and "Nom, Prénom"
    if "name" not in found and "last" not in found:
        raise UserError(
            coded(
                "csv-no-names",
                "line {line} of the file names no column of names; its first line must "
                "have one that is called Name (or First name and Last name), and may have "
                "Crew and Role",
                line=line,
            )
        )
    return found


def _person(line: int, cells: list[str], columns: dict[str, int]) -> CsvPerson | CsvFault:
    def cell(column: str) -> str | None:
        number = columns.get(column)
        return None if number is None or number >= len(cells) else cells[number]

    parts = (cell("name"),) if "name" in columns else (cell("first"), cell("last"))
    name = " ".join(" ".join(filter(None, parts)).split())
    if not name:
        return CsvFault(line, coded("csv-name-missing", "the name is missing"))
    crew, role = cell("crew"), cell("role")
    for field, text, form in (("name", name, _NAME), ("crew", crew, _TEXT), ("role", role, _TEXT)):
        try:
            form.validate_python(text or "x")
        except pydantic.ValidationError:
            fault = coded(
                "csv-text-faulty",
                "the {field} is longer than {most} letters, or not of plain letters",
                field=field,
                most=MAX_TEXT_LETTERS,
            )
            return CsvFault(line, fault)
    return CsvPerson(line, name, crew or None, role or None)


_NAME = pydantic.TypeAdapter[str](Name)
_TEXT = pydantic.TypeAdapter[str](ShortText)
