"""Reader of drawings: the kind of a file is read from its first bytes, not from its name."""

from __future__ import annotations

from base_station.drawings import dxf, geojson, pdf, pictures
from base_station.drawings.draft import Draft, Options
from shared.errors import UserError

_PICTURES = (b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff", b"RIFF")  # PNG, JPEG, WebP
_BOM = b"\xef\xbb\xbf"
_BINARY_DXF = b"AutoCAD Binary DXF"
_KINDS = "PNG, JPEG, WebP, PDF, GeoJSON, IMDF or DXF"
_OTHERS = {
    b"AC10": "this is a DWG, whose format is not public; save it as DXF",
    b"ISO-10303-21": "IFC is not read; export the floor as DXF, IMDF or PDF",
}


def read_drawing(content: bytes, options: Options) -> Draft:
    """Raises UserError with the fault of the file, and advice."""
    if content.startswith(_PICTURES):
        return Draft(picture=pictures.read_picture(content))
    text = content.removeprefix(_BOM).lstrip()
    if text.startswith(pdf.BEGINS):
        page, pages = pdf.page_of(content, options.page)
        return Draft(picture=pictures.encoded(page), pages=pages)
    if text.startswith(b"{"):
        return geojson.read_geojson(text, options.name)
    if content.startswith(b"PK"):
        return geojson.read_imdf(content, options.name)
    if _is_dxf(content, text):
        return dxf.read_dxf(content, options)
    for beginning, advice in _OTHERS.items():
        if text.startswith(beginning):
            raise UserError(advice)
    raise UserError(f"this file is no drawing that can be read; send {_KINDS}")


def _is_dxf(content: bytes, text: bytes) -> bool:
    """Its first group has the code 0 or 999, a section or a remark."""
    first = text[:200].split(b"\n", 1)[0].strip()
    return content.startswith(_BINARY_DXF) or first in {b"0", b"999"}
