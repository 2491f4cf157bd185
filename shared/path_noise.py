"""Process noise of a tracked path: how its errors grow with the way."""

from __future__ import annotations

import msgspec


class PathNoise(msgspec.Struct, frozen=True):
    """Standard deviations; ``None``: not known.

    The model is that of the base station: the tracked path is longer or shorter by one factor all
    along, and its place and heading do random walks by distance.
    """

    scale_std: float | None = None  # of that factor
    place_std_m_per_sqrt_m: float | None = None  # each axis
    turn_std_rad_per_sqrt_m: float | None = None
