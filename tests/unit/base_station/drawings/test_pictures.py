"""Pictures of floors, from good ones and bad."""

from __future__ import annotations

import io
import struct
import zlib

import pytest
from PIL import Image, ImageDraw, ImageStat

from base_station.drawings.pictures import read_picture
from shared.errors import UserError


def saved(picture: Image.Image, kind: str = "PNG", **more: object) -> bytes:
    written = io.BytesIO()
    picture.save(written, kind, **more)
    return written.getvalue()


def test_a_large_picture_becomes_smaller_and_loses_its_metadata() -> None:
    exif = Image.Exif()
    exif[0x0112] = 6  # turned by a quarter
    exif[0x010E] = "taken at home"
    found = read_picture(saved(Image.new("RGB", (4096, 1024), "white"), "JPEG", exif=exif))
    assert (found.width_px, found.height_px) == (512, 2048)
    assert b"taken at home" not in found.webp


def test_transparent_pixels_are_paper() -> None:
    drawn = Image.new("RGBA", (100, 100), (0, 0, 0, 0))
    ImageDraw.Draw(drawn).rectangle((0, 0, 40, 40), fill="black")
    found = read_picture(saved(drawn))
    picture = Image.open(io.BytesIO(found.webp)).convert("L")
    assert ImageStat.Stat(picture.crop((10, 10, 30, 30))).mean[0] < 40
    assert ImageStat.Stat(picture.crop((60, 60, 90, 90))).mean[0] > 215


def test_noise_is_made_so_small_that_consoles_can_be_sent_it() -> None:
    found = read_picture(saved(Image.effect_noise((2048, 2048), 255), "JPEG"))
    assert len(found.webp) <= 300_000
    assert found.width_px < 2048


def giant_png() -> bytes:
    """100,000 by 100,000 pixels in some hundred bytes."""

    def chunk(kind: bytes, content: bytes) -> bytes:
        check = zlib.crc32(kind + content)
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", check)

    head = struct.pack(">IIBBBBB", 100_000, 100_000, 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", b"") + chunk(b"IEND", b"")


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (giant_png(), "million pixels"),
        (saved(Image.new("L", (8000, 8000)), "PNG"), "million pixels"),
        (saved(Image.new("RGB", (300, 300)))[:200], "cannot be read"),
        (saved(Image.new("RGB", (300, 1))), "a line of pixels"),
        (b"\x89PNG\r\n\x1a\n", "cannot be read"),
    ],
)
def test_file_that_is_no_picture_is_refused(content: bytes, reason: str) -> None:
    with pytest.raises(UserError, match=reason):
        read_picture(content)
