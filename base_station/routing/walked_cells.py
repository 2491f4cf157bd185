"""Trails divided into steps as short as a cell, without the lines between points that are far
apart.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from base_station.routing.interface import Flags, Floats, Indices, WalkedTrail


class Samples(NamedTuple):
    """Points of all trails, one trail after another."""

    places_m: Floats  # (n, 2)
    floors: Indices  # (n,)
    std_m: Floats  # (n,)
    joined: Flags  # (n,), walked from the sample before
    last: dict[str, int]  # by unit: its sample of now


def sample_trails(trails: Sequence[WalkedTrail], step_m: float) -> Samples:
    """Points of the trails, at most ``step_m`` apart on one floor where the way is known."""
    lengths = [len(trail.floors) for trail in trails]
    places_m = np.concatenate([trail.places_m for trail in trails])
    floors = np.concatenate([trail.floors for trail in trails])
    std_m = np.repeat([trail.std_m for trail in trails], lengths)
    joined = ~np.concatenate([trail.after_gap for trail in trails])
    ends = np.cumsum(lengths)
    joined[ends - np.array(lengths)] = False
    before = np.maximum(np.arange(len(floors)) - 1, 0)
    is_level = joined & (floors == floors[before])
    way_m = places_m - places_m[before]
    pieces = np.where(is_level, np.ceil(np.hypot(*way_m.T) / step_m), 1.0).astype(np.int64)
    pieces = np.maximum(pieces, 1)
    which = np.repeat(np.arange(len(floors)), pieces)
    first = np.repeat(np.cumsum(pieces) - pieces, pieces)
    back = 1.0 - (np.arange(len(which)) - first + 1) / pieces[which]  # 0: the point itself
    last = np.cumsum(pieces)[ends - 1] - 1
    return Samples(
        places_m[which] - back[:, None] * way_m[which],
        floors[which],
        std_m[which],
        joined[which],
        {trail.unit_id: int(at) for trail, at in zip(trails, last, strict=True)},
    )
