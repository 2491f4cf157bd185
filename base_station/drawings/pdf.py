"""Pages of a PDF as pictures, by ``pypdfium2``, of the optional part ``muster[plans]``."""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec
from typing import Any

from PIL import Image

from shared.coded_text import coded
from shared.errors import UserError

BEGINS = b"%PDF-"
_SIDE_PX = 2048
_MISSING = coded(
    "pdf-library-missing",
    "the library pypdfium2, which reads PDF, is not installed at the station: "
    "pip install --require-hashes -r deploy/requirements-plans.lock; or save "
    "the page as a PNG",
)


def page_of(content: bytes, number: int) -> tuple[Image.Image, int]:
    """Page of a PDF (counted from 1) as a picture, and the number of pages.  Raises UserError with
    the fault of the file.
    """
    if find_spec("pypdfium2") is None:
        raise UserError(_MISSING)
    library: Any = import_module("pypdfium2")
    try:
        document = library.PdfDocument(content)
        pages = len(document)
        if not 1 <= number <= pages:
            raise UserError(
                coded(
                    "pdf-no-page",
                    "the PDF has no page {page}: it has {pages}",
                    page=number,
                    pages=pages,
                )
            )
        page = document[number - 1]
        scale = _SIDE_PX / max(*page.get_size(), 1.0)
        picture: Image.Image = page.render(scale=scale).to_pil()
    except library.PdfiumError as error:
        if "password" in str(error).lower():
            raise UserError(
                coded(
                    "pdf-encrypted",
                    "the PDF is encrypted; save it without a password, and send that",
                )
            ) from error
        raise UserError(
            coded("pdf-unreadable", "the PDF cannot be read; save the page as a PNG, and send that")
        ) from error
    return picture.convert("RGB"), pages
