"""Figures that the documents state, as numbers: tables of Markdown, row by row."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

_NUMBER = re.compile(r"-?\d+(?:,\d{3})*(?:\.\d+)?")


@dataclass(frozen=True, slots=True)
class Figure:
    """A documented number and half a unit of its last place."""

    value: float
    rounding: float

    def holds(self, measured: float) -> bool:
        """True if ``measured`` rounds to it; a tenth of a unit is left to other processors."""
        return abs(measured - self.value) <= 1.2 * self.rounding


Row = dict[str, str]


def read_table(page: Path, *titles: str) -> list[Row]:
    """Return the rows of the one table whose header begins with ``titles``, by its titles."""
    found = [table for table in _tables(page.read_text()) if table[0][: len(titles)] == [*titles]]
    if len(found) != 1:
        raise ValueError(f"{page.name} has {len(found)} tables that begin with {titles}")
    header, _, *rows = found[0]
    return [dict(zip(header, row, strict=True)) for row in rows]


def figures(cell: str) -> list[Figure]:
    """Return the numbers of a cell, in order."""
    found = _NUMBER.findall(cell)
    return [Figure(float(text.replace(",", "")), _rounding(text)) for text in found]


def _rounding(text: str) -> float:
    return 0.5 * float(10.0 ** -len(text.partition(".")[2]))


def _tables(text: str) -> list[list[list[str]]]:
    """Return every table of a page as rows of cells."""
    tables: list[list[list[str]]] = [[]]
    for line in text.splitlines():
        if line.startswith("|"):
            tables[-1].append([cell.strip() for cell in line.strip("|").split("|")])
        elif tables[-1]:
            tables.append([])
    return [table for table in tables if table]
