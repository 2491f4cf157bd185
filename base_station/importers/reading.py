"""Reads a file of any format that is imported."""

from __future__ import annotations

from pathlib import Path

import msgspec

from base_station.importers import IMPORTERS
from base_station.importers.interface import MOST_BYTES, Importer, ImportOptions
from base_station.storage.imports import ImportedContent
from shared.clock import NS_PER_S
from shared.coded_text import coded
from shared.errors import UserError

_HEAD_BYTES = 4096
_OTHERS = {
    b"PK\x03\x04": "it is packed, as a KMZ file is: unpack it, and bring in what is in it",
    b"\x1f\x8b": "it is compressed: unpack it, and bring in what is in it",
}
_HEIF = b"ftyp"  # behind the length of the first box


def read_import(path: Path, options: ImportOptions) -> ImportedContent:
    """Content of the file, with the shift of time added.  The importer is chosen by the file's
    first bytes.

    Raises UserError with the fault of the file, and OSError if it cannot be read.
    """
    size_bytes = path.stat().st_size
    if size_bytes > MOST_BYTES:
        raise UserError(
            coded(
                "import-too-large",
                "it has {size_mb} MB, and at most {most_mb} are taken",
                size_mb=size_bytes >> 20,
                most_mb=MOST_BYTES >> 20,
            )
        )
    with path.open("rb") as file:
        head = file.read(_HEAD_BYTES)
    return _shifted(_importer_of(head).read(path, options), options.shift_s)


def _importer_of(head: bytes) -> Importer:
    for importer in IMPORTERS:
        if importer.matches(head):
            return importer
    for beginning, advice in _OTHERS.items():
        if head.startswith(beginning):
            raise UserError(advice)
    if head[4:8] == _HEIF:
        raise UserError(
            coded(
                "import-heic", "pictures as HEIC are not read: save it as JPEG, with its Exif data"
            )
        )
    raise UserError(
        coded(
            "import-unknown",
            "it is nothing that can be brought in: take a GPX or KML track, a JPEG, "
            "PNG, TIFF or WebP photograph, or an incident of another station (MCAP)",
        )
    )


def _shifted(content: ImportedContent, shift_s: float) -> ImportedContent:
    shift_ns = round(shift_s * 1000) * (NS_PER_S // 1000)
    if shift_ns == 0:
        return content
    tracks = tuple(
        msgspec.structs.replace(
            track,
            points=tuple(
                msgspec.structs.replace(point, t_ns=point.t_ns + shift_ns) for point in track.points
            ),
        )
        for track in content.tracks
    )
    return msgspec.structs.replace(content, tracks=tracks)
