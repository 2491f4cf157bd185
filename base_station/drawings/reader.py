"""Reader of drawings: the kind of a file is told by how it begins, not by its name."""

from __future__ import annotations

from base_station.drawings import pdf, pictures
from base_station.drawings.draft import Draft, Options
from shared.errors import UserError

_PICTURES = (b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff", b"RIFF")  # PNG, JPEG, WebP
_KINDS = "PNG, JPEG, WebP or PDF"


def read_drawing(content: bytes, options: Options) -> Draft:
    """Raises UserError with what is wrong with the file, and what to do."""
    if content.startswith(_PICTURES):
        return Draft(picture=pictures.read_picture(content))
    if content.lstrip()[: len(pdf.BEGINS)] == pdf.BEGINS:
        page, pages = pdf.page_of(content, options.page)
        return Draft(picture=pictures.encoded(page), pages=pages)
    raise UserError(f"this file is no drawing that can be read; send {_KINDS}")
