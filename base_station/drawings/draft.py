"""Draft of a plan: content of a file, for review before it becomes the plan."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Literal

import msgspec

from shared.coded_text import NO_CODE, TextCode, code_of_text


class DrawnPicture(msgspec.Struct, frozen=True):
    """Picture without a scale: a scan, a photograph or a page of a PDF."""

    webp: bytes  # base64 in JSON
    width_px: int
    height_px: int


class Draft(msgspec.Struct, frozen=True, tag="draft"):
    """Either a picture, or a plan whose scale is known."""

    picture: DrawnPicture | None = None
    plan: dict[str, Any] | None = None  # GeoJSON in site metres, as ``site/plan`` takes it
    lat_deg: float | None = None  # of the plan's origin; None: the file does not have it
    lon_deg: float | None = None
    plan_rotation_rad: float = 0.0  # true heading of the plan's north axis
    is_place_surveyed: bool = True  # else a suggestion, which a person has to look at
    pages: int = 1  # of the file
    notes: tuple[str, ...] = ()  # for a person: parts of the file that are not in the draft
    note_codes: tuple[TextCode, ...] = ()  # of ``notes``, in their order


def noted(draft: Draft, notes: Iterable[str]) -> Draft:
    """The draft with further notes and their codes."""
    given = tuple(notes)
    return msgspec.structs.replace(
        draft, notes=tuple(map(str, given)), note_codes=tuple(map(code_of_text, given))
    )


class DrawingRefusal(msgspec.Struct, frozen=True, tag="refused"):
    """Reason for a person, and its code."""

    reason: str
    code: TextCode = NO_CODE

    @staticmethod
    def of(text: str) -> DrawingRefusal:
        return DrawingRefusal(str(text), code_of_text(text))


LengthUnit = Literal["mm", "cm", "m", "in", "ft"]
METRES_PER_UNIT: dict[LengthUnit, float] = {
    "mm": 0.001,
    "cm": 0.01,
    "m": 1.0,
    "in": 0.0254,
    "ft": 0.3048,
}


class Options(msgspec.Struct, frozen=True):
    """Options for a file that a person sets."""

    name: str = ""
    page: int = 1
    unit: LengthUnit | None = None  # of a DXF; None: as in the file
