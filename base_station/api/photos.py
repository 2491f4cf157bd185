"""People's photos and the site's base map: whatever came is decoded, cut to size and written anew,
so that nothing but the picture is left (no place, no camera, no trailing bytes).
"""

from __future__ import annotations

import hashlib
import io
import warnings

from PIL import ExifTags, Image, ImageOps, UnidentifiedImageError

from shared.errors import ConfigError

MOST_BYTES = 10_000_000
MOST_PIXELS = 50_000_000
SIDE_PX = 320
MOST_MAP_BYTES = 10_000_000
MAP_SIDE_PX = 4096
_FORMATS = ("JPEG", "PNG", "WEBP")
_UPRIGHT: dict[object, Image.Transpose] = {  # by EXIF's orientation, of which 1 is upright already
    2: Image.Transpose.FLIP_LEFT_RIGHT,
    3: Image.Transpose.ROTATE_180,
    4: Image.Transpose.FLIP_TOP_BOTTOM,
    5: Image.Transpose.TRANSPOSE,
    6: Image.Transpose.ROTATE_270,
    7: Image.Transpose.TRANSVERSE,
    8: Image.Transpose.ROTATE_90,
}


def clean_photo(upload: bytes) -> tuple[bytes, str]:
    """A square JPEG and its hash.  Raises ConfigError, which says what is wrong with the upload."""
    if len(upload) > MOST_BYTES:
        raise ConfigError(f"the photo is larger than {MOST_BYTES // 1_000_000} MB")
    try:
        with warnings.catch_warnings(action="error", category=Image.DecompressionBombWarning):
            picture = _square(upload)
    except (Image.DecompressionBombWarning, Image.DecompressionBombError):
        raise ConfigError(_too_many_pixels()) from None
    except (UnidentifiedImageError, OSError, SyntaxError, ValueError) as error:
        raise ConfigError("the photo cannot be read; send a JPEG, PNG or WebP file") from error
    written = io.BytesIO()
    picture.save(written, "JPEG", quality=85)
    jpeg = written.getvalue()
    return jpeg, hashlib.sha256(jpeg).hexdigest()[:16]


def clean_map(upload: bytes) -> tuple[bytes, str, tuple[int, int], float]:
    """A WebP no larger than ``MAP_SIDE_PX``, its hash, its width and height, and by how much it is
    smaller than the upload.  Raises ConfigError, which says what is wrong with that.
    """
    if len(upload) > MOST_MAP_BYTES:
        raise ConfigError(f"the map is larger than {MOST_MAP_BYTES // 1_000_000} MB")
    try:
        with (
            warnings.catch_warnings(action="error", category=Image.DecompressionBombWarning),
            Image.open(io.BytesIO(upload), formats=_FORMATS) as opened,
        ):
            if opened.width * opened.height > MOST_PIXELS:
                raise ConfigError(_too_many_pixels("map"))
            picture, width_px = opened.convert("RGB"), opened.width
    except (Image.DecompressionBombWarning, Image.DecompressionBombError):
        raise ConfigError(_too_many_pixels("map")) from None
    except (UnidentifiedImageError, OSError, SyntaxError, ValueError) as error:
        raise ConfigError("the map cannot be read; send a JPEG, PNG or WebP file") from error
    picture.thumbnail((MAP_SIDE_PX, MAP_SIDE_PX), Image.Resampling.LANCZOS)
    written = io.BytesIO()
    picture.save(written, "WEBP", quality=85)
    webp = written.getvalue()
    return webp, hashlib.sha256(webp).hexdigest()[:16], picture.size, width_px / picture.width


def _square(upload: bytes) -> Image.Image:
    with Image.open(io.BytesIO(upload), formats=_FORMATS) as opened:
        if opened.width * opened.height > MOST_PIXELS:
            raise ConfigError(_too_many_pixels())
        opened.draft("RGB", (2 * SIDE_PX, 2 * SIDE_PX))
        # Not ``ImageOps.exif_transpose``: it writes all metadata anew, and fails where that is odd.
        turning = _UPRIGHT.get(opened.getexif().get(ExifTags.Base.Orientation))
        picture = ImageOps.fit(opened.convert("RGB"), (SIDE_PX, SIDE_PX), Image.Resampling.LANCZOS)
        return picture if turning is None else picture.transpose(turning)


def _too_many_pixels(what: str = "photo") -> str:
    return f"the {what} has more than {MOST_PIXELS // 1_000_000} million pixels"
