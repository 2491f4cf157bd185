"""People's photos and the site's base map: whatever came is decoded, cut to size and written anew,
so that nothing but the picture is left (no place, no camera, no trailing bytes).
"""

from __future__ import annotations

import hashlib
import io
import warnings

from PIL import ExifTags, Image, ImageOps, UnidentifiedImageError

from shared.coded_text import Term, coded
from shared.errors import ConfigError

MAX_BYTES = 10_000_000
# A camera's 50 million are a few more.  Each takes 200 MB at most, of which a JPEG is less: it is
# decoded at a part of its size.
_MAX_PIXELS = {"JPEG": 52_000_000, "PNG": 24_000_000, "WEBP": 12_000_000}
_MAX_PIXELS_PROGRESSIVE = 24_000_000  # held whole while it is decoded, however small
SIDE_PX = 320
MAX_MAP_BYTES = 10_000_000
MAP_SIDE_PX = 4096
_FORMATS = ("JPEG", "PNG", "WEBP")
_EXIF_TRANSPOSITIONS: dict[
    object, Image.Transpose
] = {  # by EXIF's orientation, of which 1 is upright already
    2: Image.Transpose.FLIP_LEFT_RIGHT,
    3: Image.Transpose.ROTATE_180,
    4: Image.Transpose.FLIP_TOP_BOTTOM,
    5: Image.Transpose.TRANSPOSE,
    6: Image.Transpose.ROTATE_270,
    7: Image.Transpose.TRANSVERSE,
    8: Image.Transpose.ROTATE_90,
}


def normalize_photo(upload: bytes) -> tuple[bytes, str]:
    """Return a square JPEG and its hash.  Raises ConfigError with the fault of the upload."""
    if len(upload) > MAX_BYTES:
        raise ConfigError(
            coded(
                "photo-too-many-bytes",
                "the photo is larger than {most_mb} MB",
                most_mb=MAX_BYTES // 1000000,
            )
        )
    try:
        with warnings.catch_warnings(action="error", category=Image.DecompressionBombWarning):
            picture = _square(upload)
    except (Image.DecompressionBombWarning, Image.DecompressionBombError):
        raise ConfigError(_too_many_pixels()) from None
    except (UnidentifiedImageError, OSError, SyntaxError, ValueError) as error:
        raise ConfigError(
            coded("photo-unreadable", "the photo cannot be read; send a JPEG, PNG or WebP file")
        ) from error
    written = io.BytesIO()
    picture.save(written, "JPEG", quality=85)
    jpeg = written.getvalue()
    return jpeg, hashlib.sha256(jpeg).hexdigest()[:16]


def normalize_map(upload: bytes) -> tuple[bytes, str, tuple[int, int], float]:
    """Return a WebP no larger than ``MAP_SIDE_PX``, its hash, its width and height in pixels, and
    the factor by which it is smaller than the upload.  Raises ConfigError with the fault of the
    upload.
    """
    if len(upload) > MAX_MAP_BYTES:
        raise ConfigError(
            coded(
                "map-too-many-bytes",
                "the map is larger than {most_mb} MB",
                most_mb=MAX_MAP_BYTES // 1000000,
            )
        )
    try:
        with (
            warnings.catch_warnings(action="error", category=Image.DecompressionBombWarning),
            Image.open(io.BytesIO(upload), formats=_FORMATS) as opened,
        ):
            _require_pixel_limit(opened, "map")
            width_px = opened.width
            smaller = min(1.0, MAP_SIDE_PX / max(opened.size))
            opened.draft("RGB", (int(opened.width * smaller), int(opened.height * smaller)))
            picture = _in_colours(opened)
            picture.thumbnail((MAP_SIDE_PX, MAP_SIDE_PX), Image.Resampling.LANCZOS)
    except (Image.DecompressionBombWarning, Image.DecompressionBombError):
        raise ConfigError(_too_many_pixels("map")) from None
    except (UnidentifiedImageError, OSError, SyntaxError, ValueError) as error:
        raise ConfigError(
            coded("map-unreadable", "the map cannot be read; send a JPEG, PNG or WebP file")
        ) from error
    written = io.BytesIO()
    picture.save(written, "WEBP", quality=85)
    webp = written.getvalue()
    return webp, hashlib.sha256(webp).hexdigest()[:16], picture.size, width_px / picture.width


def _square(upload: bytes) -> Image.Image:
    with Image.open(io.BytesIO(upload), formats=_FORMATS) as opened:
        _require_pixel_limit(opened, "photo")
        opened.draft("RGB", (2 * SIDE_PX, 2 * SIDE_PX))
        # Not ``ImageOps.exif_transpose``: it writes all metadata anew, and fails where that is odd.
        transposition = _EXIF_TRANSPOSITIONS.get(opened.getexif().get(ExifTags.Base.Orientation))
        picture = ImageOps.fit(_in_colours(opened), (SIDE_PX, SIDE_PX), Image.Resampling.LANCZOS)
        return picture if transposition is None else picture.transpose(transposition)


def _in_colours(opened: Image.Image) -> Image.Image:
    """Decode a picture to RGB. One that is RGB already is not converted, as ``convert`` would copy
    it, which may be 96 MB.
    """
    if opened.mode != "RGB":
        return opened.convert("RGB")
    opened.load()  # while the upload is open
    return opened


def _require_pixel_limit(opened: Image.Image, kind: str) -> None:
    most_pixels = _MAX_PIXELS[opened.format or "WEBP"]
    if opened.info.get("progressive"):
        most_pixels = _MAX_PIXELS_PROGRESSIVE
    if opened.width * opened.height > most_pixels:
        raise ConfigError(_too_many_pixels(kind, most_pixels))


def _too_many_pixels(kind: str = "photo", most_pixels: int = _MAX_PIXELS["JPEG"]) -> str:
    return coded(
        "picture-too-many-pixels",
        "the {kind} has more than {most} million pixels; make it smaller and send it again",
        kind=Term(kind, kind),
        most=most_pixels // 1_000_000,
    )
