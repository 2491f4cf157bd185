"""Parts of the body on which a sensor may be worn, named as in settings and on the wire."""

from __future__ import annotations

FOOT = "foot"  # either
LEFT_FOOT, RIGHT_FOOT = "left_foot", "right_foot"
LEG, UPPER_BODY = "leg", "upper_body"  # as recognised by motion: shank or thigh; trunk or hand

# What each is for a tracker that does not tell it from others.
PLACES: dict[str, str] = {
    FOOT: FOOT,
    LEFT_FOOT: FOOT,
    RIGHT_FOOT: FOOT,
    "shank": "shank",
    "thigh": "pocket",
    "pocket": "pocket",
    "hip": "hip",
    "waist": "waist",
    "lower_back": "waist",
    "torso": "chest",
    "chest": "chest",
    "hand": "hand",
    LEG: "pocket",
    UPPER_BODY: "waist",
}


def is_worn_on(place: str, parts: tuple[str, ...]) -> bool:
    """Return True if a sensor at ``place`` is on one of these parts of the body."""
    return place in parts or PLACES.get(place) in parts
