"""Table of numbers from CSV text, with errors that name the line and the column."""

from __future__ import annotations

import gzip
import io
import re
import zlib
from difflib import get_close_matches
from pathlib import Path

import numpy as np

from edge.samples import Floats
from shared.errors import RecordingError

_EMPTY_CELL = re.compile(r"(?<=,)(?=[,\r\n]|\Z)|(?:(?<=\n)|\A)(?=,)")


def read_table(
    path: Path, required: tuple[str, ...], optional: tuple[str, ...] = ()
) -> dict[str, Floats]:
    """Read the columns of ``path`` (CSV, or CSV.gz by name); empty cells become NaN.

    Raises ``RecordingError`` when the file cannot be read, is empty, lacks a
    required column, has one that is in neither tuple, or holds a cell that is
    not a number.
    """
    header, _, body = _read_text(path).lstrip("\ufeff").partition("\n")
    names = [name.strip() for name in header.split(",")]
    if names == [""]:
        state = "starts with an empty line" if body.strip() else "is empty"
        raise RecordingError(f"{path} {state}; it must start with a line of column names")
    if len(names) == 1 and (";" in header or "\t" in header):
        raise RecordingError(
            f"{path}: its columns lie between {'semicolons' if ';' in header else 'tabs'}; save it "
            "anew with commas between columns and points in numbers"
        )
    _check_columns(path, names, required, optional)
    if not body.strip():
        raise RecordingError(f"{path} has column names but no samples below them")
    rows = _parse_rows(path, names, body)
    return {name: np.ascontiguousarray(rows[:, k]) for k, name in enumerate(names)}


def _read_text(path: Path) -> str:
    try:
        data = path.read_bytes()
        if path.suffix == ".gz":
            data = gzip.decompress(data)
        return data.decode("utf-8")
    except OSError as error:
        # Covers a missing file and a file that is not gzip at all.
        raise RecordingError(
            f"{path} cannot be read ({error}); check the name and that it is a CSV or CSV.gz file"
        ) from error
    except (EOFError, zlib.error) as error:
        raise RecordingError(
            f"{path} is a damaged gzip file ({error}); copy it again from where it was recorded"
        ) from error
    except UnicodeDecodeError as error:
        raise RecordingError(
            f"{path} is not text ({error.reason} at byte {error.start}); "
            "give a CSV file, or name it .gz when it is compressed"
        ) from error


def _check_columns(
    path: Path, names: list[str], required: tuple[str, ...], optional: tuple[str, ...]
) -> None:
    known = required + optional
    for name in names:
        if name not in known:
            near = get_close_matches(name, known, n=1, cutoff=0.3)
            hint = f"; did you mean {near[0]}?" if near else ""
            raise RecordingError(
                f"{path}: unknown column {name!r}{hint or '.'} "
                f"A name ends in its unit, and the known names are {', '.join(known)}"
            )
    repeated = sorted({name for name in names if names.count(name) > 1})
    if repeated:
        raise RecordingError(f"{path}: column {repeated[0]} is there twice; remove one")
    missing = [name for name in required if name not in names]
    if missing:
        raise RecordingError(
            f"{path}: missing column {', '.join(missing)}; needed are {', '.join(required)}"
        )


def _parse_rows(path: Path, names: list[str], body: str) -> Floats:
    filled = _EMPTY_CELL.sub("nan", body)
    try:
        rows: Floats = np.loadtxt(io.StringIO(filled), delimiter=",", ndmin=2, comments=None)
    except ValueError as error:
        raise _locate(path, names, filled) from error
    if rows.shape[1] != len(names):
        raise _locate(path, names, filled)
    return rows


def _locate(path: Path, names: list[str], body: str) -> RecordingError:
    """Find the cell that the fast parser stumbled over."""
    for number, line in enumerate(body.splitlines(), start=2):
        cells = line.split(",")
        if line.strip() and len(cells) != len(names):
            return RecordingError(
                f"{path}, line {number}: {len(cells)} cells where the first line names "
                f"{len(names)} columns; repair or remove the line"
            )
        for name, cell in zip(names, cells, strict=False):
            if line.strip() and not _is_number(cell):
                return RecordingError(
                    f"{path}, line {number}, column {name}: {cell.strip()!r} is not a number; "
                    "leave the cell empty where the sensor gave nothing"
                )
    return RecordingError(f"{path} is not a table of numbers")


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return "_" not in cell
