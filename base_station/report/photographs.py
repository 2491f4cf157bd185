"""Imported photographs of an incident, scaled down for its report."""

from __future__ import annotations

import hashlib
import warnings
from collections.abc import Iterable, Sequence
from pathlib import Path

from PIL import Image

from base_station.report import texts
from base_station.report.contents import PhotoEntry, Photographs
from base_station.storage.db.models import ImportRow
from base_station.storage.imports import ImportFolder
from base_station.storage.small_picture import small_jpeg
from shared.errors import MusterError

PHOTO = "photo"  # format of such an import
SIDE_PX = 1000
MOST_PICTURES = 40
MOST_BYTES = 12_000_000  # of all in one report
_FORMATS = ("JPEG", "PNG", "TIFF", "WEBP")
_READ_BYTES = 4 << 20


def photographs_of(imports: Iterable[ImportRow], folder: ImportFolder) -> Photographs:
    """Oldest photographs, as many as a report contains; a damaged one has the reason in place of
    the picture.
    """
    rows = sorted(
        (one for one in imports if one.format == PHOTO),
        key=lambda one: (one.first_ns, one.import_id),
    )
    entries, size_bytes = list[PhotoEntry](), 0
    for row in rows[:MOST_PICTURES]:
        entry = _entry(row, folder)
        size_bytes += len(entry.jpeg)
        if size_bytes > MOST_BYTES:
            break
        entries.append(entry)
    return Photographs(tuple(entries), left_out=len(rows) - len(entries))


def _entry(row: ImportRow, folder: ImportFolder) -> PhotoEntry:
    jpeg, fault = b"", ""
    try:
        jpeg = _picture(row, folder)
    except _DamagedError as error:
        fault = str(error)
    return PhotoEntry(
        file_name=row.file_name,
        taken_ns=row.first_ns,
        place=_place(row, folder),
        t_ns=row.t_ns,
        by=row.by,
        jpeg=jpeg,
        fault=fault,
    )


class _DamagedError(Exception):
    """Damage of a photograph, with the sentence for the report."""


def _picture(row: ImportRow, folder: ImportFolder) -> bytes:
    path = folder.original(row.incident_id, row.import_id)
    if path is None:
        raise _DamagedError(texts.NO_FILE)
    try:
        if _sha256(path) != row.sha256:
            raise _DamagedError(texts.OTHER_FILE)
        with (
            warnings.catch_warnings(action="error", category=Image.DecompressionBombWarning),
            Image.open(path, formats=_FORMATS) as image,
        ):
            return small_jpeg(image, SIDE_PX)
    except (Image.DecompressionBombWarning, Image.DecompressionBombError) as error:
        raise _DamagedError(texts.TOO_MANY_PIXELS) from error
    except (OSError, ValueError, SyntaxError) as error:
        raise _DamagedError(texts.unreadable_picture(str(error))) from error


def _place(row: ImportRow, folder: ImportFolder) -> tuple[float, float] | None:
    """Latitude and longitude in degrees; None if the content that was read of the file is gone."""
    try:
        content = folder.content(row.incident_id, row.import_id)
    except MusterError:
        return None
    points: Sequence[tuple[float, float]] = [
        (point.lat_deg, point.lon_deg)
        for track in (() if content is None else content.tracks)
        for point in track.points
    ]
    return points[0] if points else None


def _sha256(path: Path) -> str:
    digest = hashlib.sha256()
    with path.open("rb") as file:
        while part := file.read(_READ_BYTES):
            digest.update(part)
    return digest.hexdigest()
