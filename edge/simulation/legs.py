"""Legs of a walk: what a simulated person does, one after the other.

Points are (north, east) in metres in the site frame.  The same names are the
``type`` of a leg in a scenario file.
"""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec
from msgspec import Meta

MOST_M = 1e5  # of a leg; a longer one takes minutes to plan, stride by stride
Metres = Annotated[float, Meta(ge=-MOST_M, le=MOST_M)]
Degrees = Annotated[float, Meta(ge=-36_000.0, le=36_000.0)]
Point = tuple[Metres, Metres]
Points = Annotated[tuple[Point, ...], Meta(min_length=1)]
Seconds = Annotated[float, Meta(ge=1e-3, le=1e6)]
Pace = Literal[
    "search", "walk", "hurry", "run", "sprint", "laden", "limp", "backwards", "sideways", "hose",
    "rubble", "jog", "race", "careful", "drag",
]  # fmt: skip
Risers = Annotated[int, Meta(ge=1, le=200)]
AtOnce = Annotated[int, Meta(ge=1, le=3)]  # risers that one step takes
StairsPace = Literal["walk", "run", "careful"]
Segment = Literal["foot", "shank", "pocket", "hip", "waist", "chest"]


class Walk(msgspec.Struct, frozen=True, tag="walk", forbid_unknown_fields=True):
    """Go along straight lines through points, on a floor or an even ramp."""

    to: Points
    pace: Pace = "walk"
    rise_m: Metres = 0.0  # of the ramp, over the whole way


class StairsLeg(msgspec.Struct, frozen=True, tag="stairs", forbid_unknown_fields=True):
    """Climb (``rise_m`` positive) or descend one straight flight that starts here."""

    to: Point
    rise_m: Metres
    risers: Risers
    at_once: AtOnce = 1
    pace: StairsPace = "walk"


class Spiral(msgspec.Struct, frozen=True, tag="spiral", forbid_unknown_fields=True):
    """Climb or descend winding stairs that start here and turn about ``middle``."""

    middle: Point
    turn_deg: Degrees  # clockwise seen from above
    rise_m: Metres
    risers: Risers
    at_once: AtOnce = 1
    pace: StairsPace = "walk"


class Stand(msgspec.Struct, frozen=True, tag="stand", forbid_unknown_fields=True):
    """Stand still."""

    duration_s: Seconds


class Wait(msgspec.Struct, frozen=True, tag="wait", forbid_unknown_fields=True):
    """Stand about: the weight goes from leg to leg, the foot is put anew now and then."""

    duration_s: Seconds


class Kneel(msgspec.Struct, frozen=True, tag="kneel", forbid_unknown_fields=True):
    """Kneel down, work there, get up again."""

    duration_s: Seconds


class Sit(msgspec.Struct, frozen=True, tag="sit", forbid_unknown_fields=True):
    """Sit down, cross the legs now and then, get up again."""

    duration_s: Seconds


class RaiseFoot(msgspec.Struct, frozen=True, tag="raise_foot", forbid_unknown_fields=True):
    """Raise the foot where one stands and put it down slowly, again and again."""

    times: Annotated[int, Meta(ge=1, le=1000)]
    height_m: Annotated[float, Meta(gt=0.0, le=1.0)] = 0.5  # now more, now less


class Ride(msgspec.Struct, frozen=True, tag="ride", forbid_unknown_fields=True):
    """Stand in a lift that goes up (``rise_m`` positive) or down without a stop."""

    rise_m: Metres
    speed_mps: Annotated[float, Meta(gt=0.0, le=10.0)] = 1.6  # at most


class Turn(msgspec.Struct, frozen=True, tag="turn", forbid_unknown_fields=True):
    """Turn on the spot to a heading, clockwise from north."""

    heading_deg: Degrees


class Lie(msgspec.Struct, frozen=True, tag="lie", forbid_unknown_fields=True):
    """Lie down (or fall), stay without any motion, get up again."""

    duration_s: Seconds
    fall: bool = False


class Crawl(msgspec.Struct, frozen=True, tag="crawl", forbid_unknown_fields=True):
    """Go on hands and knees, the toes dragging, along straight lines."""

    to: Points


Leg = Walk | StairsLeg | Spiral | Stand | Wait | Kneel | Sit | RaiseFoot | Ride | Turn | Lie | Crawl
