"""Report as PDF, made from its HTML by the library ``weasyprint``, an optional part
(``muster[report]``): the HTML is complete, and a browser can print it.
"""

from __future__ import annotations

import hashlib
import logging
from importlib import import_module
from importlib.util import find_spec
from types import ModuleType
from typing import Any

from PIL import ImageFile

from shared.coded_text import coded
from shared.errors import UserError

# Its remarks are about printing styles that it does not know; there is nothing to do about them.
logging.getLogger("weasyprint").setLevel(logging.ERROR)
_MISSING = coded(
    "report-library-missing",
    "the library weasyprint, which writes PDF, is not installed: pip install "
    "--require-hashes -r deploy/requirements-report.lock; or print the HTML "
    "report in a browser",
)
_NO_PANGO = (
    "the library weasyprint, which writes PDF, lacks a library of the system ({}): apt-get install "
    "libpango-1.0-0 libpangoft2-1.0-0; or print the HTML report in a browser"
)


def require_library() -> None:
    """Raise UserError if no PDF can be written."""
    if find_spec("weasyprint") is None:
        raise UserError(_MISSING)


def pdf_document(html: bytes) -> bytes:
    """Convert HTML to PDF; the same HTML gives the same bytes.  Raises UserError if a library is
    missing.
    """
    library: Any = _library()
    own_pictures = library.URLFetcher(allowed_protocols=("data",))  # nothing outside of itself
    page = library.HTML(string=html.decode(), url_fetcher=own_pictures, media_type="print")
    written: bytes = page.write_pdf(pdf_identifier=hashlib.sha256(html).digest()[:16])
    return written


def _library() -> ModuleType:
    require_library()
    truncated_images = ImageFile.LOAD_TRUNCATED_IMAGES
    try:
        return import_module("weasyprint")
    except OSError as error:
        raise UserError(_NO_PANGO.format(error)) from error
    finally:
        # Its import lets Pillow take pictures that are cut short, everywhere in the process.
        ImageFile.LOAD_TRUNCATED_IMAGES = truncated_images
