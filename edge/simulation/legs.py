"""What a person does, one leg after the other.

Points are (north, east) in metres in the site frame.  The same names are the
``type`` of a leg in a scenario file.
"""

from __future__ import annotations

from typing import Literal

import msgspec

Point = tuple[float, float]
Pace = Literal["search", "walk", "hurry", "run", "sprint"]


class Walk(msgspec.Struct, frozen=True, tag="walk", forbid_unknown_fields=True):
    """Go along straight lines through points on the same floor."""

    to: tuple[Point, ...]
    pace: Pace = "walk"


class Stairs(msgspec.Struct, frozen=True, tag="stairs", forbid_unknown_fields=True):
    """Climb (``rise_m`` positive) or descend one straight flight that starts here."""

    to: Point
    rise_m: float
    risers: int


class Stand(msgspec.Struct, frozen=True, tag="stand", forbid_unknown_fields=True):
    """Stand still."""

    duration_s: float


class Turn(msgspec.Struct, frozen=True, tag="turn", forbid_unknown_fields=True):
    """Turn on the spot to a heading, clockwise from north."""

    heading_deg: float


class Lie(msgspec.Struct, frozen=True, tag="lie", forbid_unknown_fields=True):
    """Lie down (or fall), stay without any motion, get up again."""

    duration_s: float
    fall: bool = False


class Crawl(msgspec.Struct, frozen=True, tag="crawl", forbid_unknown_fields=True):
    """Go on hands and knees, the toes dragging, along straight lines."""

    to: tuple[Point, ...]


Leg = Walk | Stairs | Stand | Turn | Lie | Crawl
