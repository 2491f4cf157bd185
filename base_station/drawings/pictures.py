"""Pictures of floors: every picture is decoded, reduced in size and encoded again, so that nothing
but the picture is left.
"""

from __future__ import annotations

import io
import warnings

from PIL import Image, ImageOps, UnidentifiedImageError

from base_station.drawings.draft import DrawnPicture
from shared.coded_text import coded
from shared.errors import UserError

MOST_PIXELS = 52_000_000  # of a file: a camera's 50 million are a few more
# A plan is in every snapshot that a console gets, and its pictures with it.
_SIDES_PX = (2048, 1448, 1024, 724)
_MOST_BYTES = 300_000
_FORMATS = ("JPEG", "PNG", "WEBP")
_TOO_LARGE = coded(
    "picture-too-large",
    "the picture has more than {most_million} million pixels; make it smaller",
    most_million=MOST_PIXELS // 1_000_000,
)


def read_picture(content: bytes) -> DrawnPicture:
    """Read a picture.  Raises UserError with the fault of the file."""
    try:
        with (
            warnings.catch_warnings(action="error", category=Image.DecompressionBombWarning),
            Image.open(io.BytesIO(content), formats=_FORMATS) as opened,
        ):
            if opened.width * opened.height > MOST_PIXELS:
                raise UserError(_TOO_LARGE)
            opened.draft("RGB", (_SIDES_PX[0], _SIDES_PX[0]))
            return encoded(_upright(opened))
    except (Image.DecompressionBombWarning, Image.DecompressionBombError):
        raise UserError(_TOO_LARGE) from None
    except (UnidentifiedImageError, OSError, SyntaxError, ValueError) as error:
        raise UserError(
            coded("picture-unreadable", "the picture cannot be read; save it as PNG, JPEG or WebP")
        ) from error


def _upright(opened: Image.Image) -> Image.Image:
    """Picture turned upright, with white where it is transparent, as exported drawings often
    are.
    """
    opened.load()
    try:
        turned = ImageOps.exif_transpose(opened)
    except (OSError, SyntaxError, ValueError, TypeError):  # odd metadata
        turned = opened
    if not turned.has_transparency_data:
        return turned.convert("RGB")
    drawn = turned.convert("RGBA")
    paper = Image.new("RGB", drawn.size, "white")
    paper.paste(drawn, mask=drawn.getchannel("A"))
    return paper


def encoded(picture: Image.Image) -> DrawnPicture:
    """Encode a picture as large as ``_MOST_BYTES`` allow, and never larger than it was."""
    if min(picture.size) < 2:
        raise UserError(coded("picture-is-line", "the picture has no more than a line of pixels"))
    for side_px in _SIDES_PX:
        smaller = picture.copy()
        smaller.thumbnail((side_px, side_px), Image.Resampling.LANCZOS)
        written = io.BytesIO()
        smaller.save(written, "WEBP", quality=60)
        if written.tell() <= _MOST_BYTES:
            return DrawnPicture(written.getvalue(), *smaller.size)
    raise UserError(
        coded(
            "picture-too-detailed",
            "the picture has too much detail for a plan; send one with fewer colours",
        )
    )
