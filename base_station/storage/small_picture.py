"""A photograph scaled down to a small JPEG, without the place and the camera of its Exif data."""

from __future__ import annotations

import io

from PIL import Image, ImageOps

_QUALITY = 80


def small_jpeg(image: Image.Image, side_px: int) -> bytes:
    """``side_px``: of its longer side, at most.  The same picture gives the same bytes.

    Raises OSError, ValueError or SyntaxError where it cannot be decoded.
    """
    image.draft("RGB", (2 * side_px, 2 * side_px))
    upright = ImageOps.exif_transpose(image).convert("RGB")
    upright.thumbnail((side_px, side_px), Image.Resampling.LANCZOS)
    bare = Image.new("RGB", upright.size)
    bare.paste(upright)
    written = io.BytesIO()
    bare.save(written, "JPEG", quality=_QUALITY)
    return written.getvalue()
