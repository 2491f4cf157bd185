"""Parts of the body on which a sensor may be worn, named as in settings and on the wire."""

from __future__ import annotations

FOOT = "foot"  # either

# What each is for a tracker that does not tell it from others.
PLACES: dict[str, str] = {
    FOOT: FOOT,
    "left_foot": FOOT,
    "right_foot": FOOT,
    "shank": "shank",
    "thigh": "pocket",
    "pocket": "pocket",
    "hip": "hip",
    "waist": "waist",
    "lower_back": "waist",
    "torso": "chest",
    "chest": "chest",
    "hand": "hand",
}


def is_worn_on(place: str, parts: tuple[str, ...]) -> bool:
    """Return True if a sensor at ``place`` is on one of these parts of the body."""
    return place in parts or PLACES.get(place) in parts
