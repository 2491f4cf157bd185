"""Plans of one floor: an outline, and walls that somebody drew."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from base_station.site.floor_grid import FloorGrid
from base_station.site.plan import read_plan

Line = Sequence[Sequence[float]]  # east and north, m


def walled_grid(outline: Line, walls: Sequence[Line], floor: int = 0) -> FloorGrid:
    """``outline``: a ring, or a line that is closed by itself. Floors are 3 m high."""
    shapes = [("outline", outline), *(("wall", wall) for wall in walls)]
    features = [
        {
            "type": "Feature",
            "properties": {"kind": kind, "floor": floor},
            "geometry": {"type": "LineString", "coordinates": line},
        }
        for kind, line in shapes
    ]
    site = {"frame": "site-m", "floors": [{"floor": floor, "down_m": -3.0 * floor}]}
    plan = {"type": "FeatureCollection", "muster": site, "features": features}
    grid = FloorGrid.of(read_plan(msgspec.json.encode(plan)))
    assert grid is not None
    return grid
