"""Reader of drawings: the format of a file is recognised by its first bytes, not by its name."""

from __future__ import annotations

from base_station.drawings import dxf, geojson, ifc, pdf, pictures
from base_station.drawings.draft import Draft, Options
from shared.coded_text import coded
from shared.errors import UserError

_PICTURES = (b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff", b"RIFF")  # PNG, JPEG, WebP
_BOM = b"\xef\xbb\xbf"
_BINARY_DXF = b"AutoCAD Binary DXF"
_KINDS = "PNG, JPEG, WebP, PDF, GeoJSON, IMDF, DXF or IFC"
_DWG = b"AC10"
_IFC_XML = b"<?xml"
_OTHERS = {
    _DWG: "this is a DWG, whose format is not public; save it as DXF",
    _IFC_XML: "XML is not read; save an ifcXML as IFC",
}


def read_drawing(content: bytes, options: Options) -> Draft:
    """Read a drawing of any format.  Raises UserError with the fault of the file, and advice."""
    if content.startswith(_PICTURES):
        return Draft(picture=pictures.read_picture(content))
    text = content.removeprefix(_BOM).lstrip()
    if text.startswith(pdf.BEGINS):
        page, pages = pdf.page_of(content, options.page)
        return Draft(picture=pictures.encoded(page), pages=pages)
    if text.startswith(b"{"):
        return geojson.read_geojson(text, options.name)
    if text.startswith(ifc.BEGINS):
        return ifc.read_ifc(text, options)
    if content.startswith(b"PK"):
        return _read_zipped(content, options)
    if _is_dxf(content, text):
        return dxf.read_dxf(content, options)
    for beginning, advice in _OTHERS.items():
        if text.startswith(beginning):
            raise UserError(advice)
    raise UserError(
        coded(
            "drawing-unknown",
            "this file is no drawing that can be read; send {kinds}",
            kinds=_KINDS,
        )
    )


def _read_zipped(content: bytes, options: Options) -> Draft:
    if ifc.is_zipped_ifc(content):
        return ifc.read_zipped_ifc(content, options)
    return geojson.read_imdf(content, options.name)


def _is_dxf(content: bytes, text: bytes) -> bool:
    """True if the first group has the code 0 or 999, a section or a comment."""
    first = text[:200].split(b"\n", 1)[0].strip()
    return content.startswith(_BINARY_DXF) or first in {b"0", b"999"}
