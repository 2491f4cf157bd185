"""Photographs of a report: scaled down, the oldest first, and a damaged one named."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path

import pytest
from PIL import Image

from base_station.importers.interface import ImportOptions
from base_station.importers.photo import read_photo
from base_station.report import photographs
from base_station.report.photographs import SIDE_PX, photographs_of
from base_station.report.texts import NO_FILE, OTHER_FILE, photograph_caption
from base_station.storage.db.models import ImportRow
from base_station.storage.imports import ImportFolder, import_id_of
from tests.rig.imported_files import exif_time, in_ns, write_photo

TAKEN_S = 1_700_000_000
Bring = Callable[[int], ImportRow]


@pytest.fixture
def folder(tmp_path: Path) -> ImportFolder:
    return ImportFolder(tmp_path / "imports")


@pytest.fixture
def bring(folder: ImportFolder) -> Bring:
    def import_file(seconds: int) -> ImportRow:
        """A photograph of so many seconds after the first."""
        t_s = TAKEN_S + seconds
        with folder.incoming() as path:
            write_photo(path, (52.0, -4.5), exif_time(t_s), "+00:00")
            content = read_photo(path, ImportOptions(f"{seconds}.jpg", "i1"))
            import_id, sha256 = import_id_of(path)
            folder.keep("i1", import_id, path, content)
        return ImportRow(
            incident_id="i1", import_id=import_id, file_name=f"{seconds}.jpg", format="photo",
            sha256=sha256, size_bytes=1, shift_s=0.0, first_ns=in_ns(t_s), last_ns=in_ns(t_s),
            t_ns=in_ns(TAKEN_S + 3600), by="chief",
        )  # fmt: skip

    return import_file


def test_photographs_are_by_time_with_place_and_importing_user(
    folder: ImportFolder, bring: Bring
) -> None:
    rows = [bring(60), bring(0)]
    found = photographs_of(rows, folder)
    assert [one.file_name for one in found.entries] == ["0.jpg", "60.jpg"]
    assert found == photographs_of(rows, folder), "the same bytes"
    assert photograph_caption(found.entries[0]) == (
        "Taken 2023-11-14 22:13:20 at 52.000000° N, 4.500000° W. "
        "Brought in 2023-11-14 23:13:20 by chief."
    )


def test_a_large_one_is_scaled_down(
    folder: ImportFolder, bring: Bring, monkeypatch: pytest.MonkeyPatch
) -> None:
    (entry,) = photographs_of([bring(0)], folder).entries
    assert Image.open(io.BytesIO(entry.jpeg)).size == (640, 480), "and none is enlarged"
    monkeypatch.setattr(photographs, "SIDE_PX", 100)
    (entry,) = photographs_of([bring(0)], folder).entries
    assert Image.open(io.BytesIO(entry.jpeg)).size == (100, 75)
    assert not Image.open(io.BytesIO(entry.jpeg)).getexif(), "it has no place of its own"
    assert SIDE_PX == 1000


def test_a_file_that_is_damaged_or_elsewhere_is_named(folder: ImportFolder, bring: Bring) -> None:
    damaged, gone, whole = bring(0), bring(1), bring(2)
    original = folder.original("i1", damaged.import_id)
    assert original is not None
    original.write_bytes(original.read_bytes()[:-100])
    folder.remove("i1", gone.import_id)
    entries = photographs_of([damaged, gone, whole], folder).entries
    assert [one.fault for one in entries] == [OTHER_FILE, NO_FILE, ""]
    assert [bool(one.jpeg) for one in entries] == [False, False, True]
    assert [one.place is None for one in entries] == [False, True, False]


def test_number_and_size_are_bounded(
    folder: ImportFolder, bring: Bring, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows = [bring(one) for one in range(4)]
    monkeypatch.setattr(photographs, "MOST_PICTURES", 3)
    found = photographs_of(rows, folder)
    assert ([one.file_name for one in found.entries], found.left_out) == (
        ["0.jpg", "1.jpg", "2.jpg"],
        1,
    )
    monkeypatch.setattr(photographs, "MOST_BYTES", 2 * len(found.entries[0].jpeg) + 200)
    found = photographs_of(rows, folder)
    assert (len(found.entries), found.left_out) == (2, 2)
