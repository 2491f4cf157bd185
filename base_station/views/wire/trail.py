"""Trail of a unit as consoles get it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated, Final

import msgspec

from base_station.views.wire.schema import shown_as

POINTS: Final = shown_as("TrailPoint[]", {"type": "array", "items": {"$ref": "#/$defs/TrailPoint"}})


class TrailPoint(msgspec.Struct, frozen=True, array_like=True):
    """Point of a trail, at most one a second: ``[t_ms, north_m, east_m, floor]``, and after a gap a
    fifth element, 1. Older points on one straight line are left out.
    """

    t_ms: int
    north_m: float
    east_m: float
    floor: int | None
    after_gap: Annotated[int, shown_as("0 | 1", {"enum": [0, 1]})] = (
        0  # 1: the way from the point before is unknown
    )


def encoded_trail(points: Iterable[TrailPoint]) -> bytes:
    """Encode a trail, without the fifth element where there is no gap: trails are most of what is
    sent.
    """
    rows = [
        (one.t_ms, one.north_m, one.east_m, one.floor, *([1] if one.after_gap else []))
        for one in points
    ]
    return msgspec.json.encode(rows)


class Trail(msgspec.Struct, frozen=True, tag="trail"):
    """Trail of a unit before the last snapshot; deltas since then continue it."""

    unit_id: str
    points: Annotated[msgspec.Raw, POINTS]
