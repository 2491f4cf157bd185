"""An enrolment out of a picture: the QR code as it was saved, or photographed off a screen.

Read through the library ``zxing-cpp``, which is an optional part (``muster[pictures]``): most units
are given the file.
"""

from __future__ import annotations

import io
import warnings
from importlib import import_module
from types import ModuleType

from PIL import Image, UnidentifiedImageError

from shared.errors import ConfigError

_FORMATS = ("JPEG", "PNG", "WEBP")
_MOST_PIXELS = 60_000_000  # of a telephone's camera; decoded they take as many bytes
_SIDE_PX = 4000  # a larger JPEG is decoded smaller, where a module has pixels enough all the same
_NOT_INSTALLED = (
    "the library zxing-cpp, which reads QR codes, is not installed: "
    "pip install --require-hashes -r deploy/requirements-pictures.lock; or make a file of the "
    "picture with `muster edge enrol` on a machine that has it"
)


def text_in_picture(content: bytes, prefix: str) -> str:
    """The text of the one QR code in it that begins with ``prefix``.

    Raises ConfigError, one sentence about what is wrong and what to do.
    """
    texts = _codes(_decoded(content))
    found = {text for text in texts if text.upper().startswith(prefix)}
    if len(found) > 1:
        raise ConfigError(
            f"there are {len(found)} enrolments in this picture; take one of a single code"
        )
    if found:
        return found.pop()
    if texts:
        raise ConfigError(
            "the QR code in this picture is no enrolment; take the one that the station shows"
        )
    raise ConfigError(
        "no QR code can be read in this picture; photograph it from the front, sharp and large, "
        "with all of its corners and the white margin"
    )


def _codes(picture: Image.Image) -> list[str]:
    library = _library()
    return [
        code.text for code in library.read_barcodes(picture, formats=library.BarcodeFormat.QRCode)
    ]


def _decoded(content: bytes) -> Image.Image:
    """In shades of grey.  Nothing is read of a picture before its size is known."""
    try:
        with (
            warnings.catch_warnings(action="ignore", category=Image.DecompressionBombWarning),
            Image.open(io.BytesIO(content), formats=_FORMATS) as opened,
        ):
            if opened.width * opened.height > _MOST_PIXELS:
                raise ConfigError(
                    f"the picture has more than {_MOST_PIXELS // 1_000_000} million pixels; make "
                    "it smaller"
                )
            opened.draft("L", (_SIDE_PX, _SIDE_PX))
            return opened.convert("L")
    except Image.DecompressionBombError as error:
        raise ConfigError(f"the picture is too large: {error}") from None
    except (UnidentifiedImageError, OSError, SyntaxError, ValueError) as error:
        raise ConfigError(
            "the picture is damaged, or neither JPEG, PNG nor WebP; save it as one of these"
        ) from error


def _library() -> ModuleType:
    try:
        return import_module("zxingcpp")
    except ImportError as error:
        raise ConfigError(f"{_NOT_INSTALLED} ({error})") from error
