"""Photos are turned upright, whatever else their metadata state."""

from __future__ import annotations

import io
import struct

import pytest
from PIL import Image, ImageOps

from base_station.api.images import SIDE_PX, normalize_photo

_SHORT, _RATIONAL, _DOUBLE = 3, 5, 12  # types of EXIF
_ORIENTATION, _MAKER, _WIDTH = 0x0112, 0x010F, 0x0100


def exif(*entries: tuple[int, int]) -> bytes:
    """Tags of one value each, with their type, valid or not; the orientation is 6."""
    table = b"".join(struct.pack("<HHII", tag, kind, 1, 6) for tag, kind in entries)
    return b"Exif\0\0II*\0" + struct.pack("<IH", 8, len(entries)) + table + bytes(4)


def photo(metadata: bytes) -> bytes:
    """Red above and to the left, blue above and to the right, black below."""
    picture = Image.new("RGB", (64, 48))
    picture.paste("red", (0, 0, 32, 24))
    picture.paste("blue", (32, 0, 64, 24))
    written = io.BytesIO()
    picture.save(written, "JPEG", quality=95, exif=metadata)
    return written.getvalue()


def corners(picture: Image.Image) -> list[str]:
    """Strongest colour of each corner, clockwise from the upper left."""
    near, far = 20, SIDE_PX - 20
    found = []
    for place in ((near, near), (far, near), (far, far), (near, far)):
        red, _, blue = picture.getpixel(place)  # type: ignore[misc]  # it is RGB
        found.append("red" if red > 128 else "blue" if blue > 128 else "black")
    return found


@pytest.mark.parametrize("orientation", range(10))
def test_photo_is_turned_upright(orientation: int) -> None:
    metadata = Image.Exif()
    metadata[_ORIENTATION] = orientation
    upload = photo(metadata.tobytes())
    jpeg, _ = normalize_photo(upload)
    upright = ImageOps.exif_transpose(Image.open(io.BytesIO(upload)))
    expected = ImageOps.fit(upright, (SIDE_PX, SIDE_PX))
    assert corners(Image.open(io.BytesIO(jpeg))) == corners(expected)


@pytest.mark.parametrize("odd", [(_MAKER, _RATIONAL), (_WIDTH, _RATIONAL), (_WIDTH, _DOUBLE)])
def test_photo_with_odd_metadata_is_accepted(odd: tuple[int, int]) -> None:
    jpeg, _ = normalize_photo(photo(exif((_ORIENTATION, _SHORT), odd)))
    assert corners(Image.open(io.BytesIO(jpeg))) == ["black", "red", "blue", "black"]
