"""Pictures of floors in a plan: consoles draw them under the walls, the station checks them."""

from __future__ import annotations

import binascii
from base64 import b64decode
from collections import Counter
from typing import Annotated, Any

import msgspec

from base_station.site.plan_features import Floor, Metres
from shared.coded_text import Measure, coded
from shared.errors import UserError

MOST_BASE64 = 2_000_000  # of all pictures: a plan is in every snapshot that a console gets
_Corner = tuple[Metres, Metres]  # east_m, north_m


class FloorPicture(msgspec.Struct, forbid_unknown_fields=True):
    floor: Floor
    webp: Annotated[str, msgspec.Meta(max_length=MOST_BASE64)]  # base64
    upper_left_m: _Corner
    upper_right_m: _Corner
    lower_left_m: _Corner


def require_pictures(member: Any) -> None:
    """Raise UserError if ``pictures`` of the plan's member ``muster`` cannot be drawn."""
    try:
        pictures = msgspec.convert(member, list[FloorPicture])
    except msgspec.ValidationError as error:
        raise UserError(
            coded(
                "plan-pictures-unreadable",
                "the plan has pictures that cannot be read: {error}",
                error=str(error),
            )
        ) from error
    twice = [floor for floor, n in Counter(one.floor for one in pictures).items() if n > 1]
    if twice:
        raise UserError(
            coded(
                "plan-pictures-of-one-floor",
                "the plan has more than one picture of floor {floor}",
                floor=twice[0],
            )
        )
    if sum(len(one.webp) for one in pictures) > MOST_BASE64:
        raise UserError(
            coded(
                "plan-pictures-too-large",
                "the plan's pictures have more than {most_mb} together; send smaller ones, or "
                "fewer floors",
                most_mb=Measure(MOST_BASE64 / 1e6, f"{MOST_BASE64 // 1_000_000} MB"),
            )
        )
    for one in pictures:
        if not _is_webp(one.webp):
            raise UserError(
                coded(
                    "plan-picture-no-webp",
                    "the plan's picture of floor {floor} is no WebP in base64",
                    floor=one.floor,
                )
            )


def _is_webp(text: str) -> bool:
    try:
        content = b64decode(text, validate=True)
    except (binascii.Error, ValueError):
        return False
    return content[:4] == b"RIFF" and content[8:12] == b"WEBP"
