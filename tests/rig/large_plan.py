"""A legal plan, as large as wanted."""

from __future__ import annotations

import math

import msgspec

_FLOORS = 10


def large_plan(size_bytes: int) -> bytes:
    """Walls and round rooms of 20 points each on ten floors; larger than this by a feature."""
    outline = [[0, 0], [120, 0], [120, 90], [0, 90], [0, 0]]
    features = [_feature("outline", 0, {"type": "Polygon", "coordinates": [outline]})]
    size = 0
    while size < size_bytes:
        number = len(features)
        east_m, north_m = 5.0 + number % 110, 5.0 + number // 110 % 80
        if number % 2:
            line = [[round(east_m + 0.1 * i, 3), north_m] for i in range(20)]
            geometry: dict[str, object] = {"type": "LineString", "coordinates": line}
        else:
            turns = [math.tau * i / 20.0 for i in range(20)]
            ring = [
                [round(east_m + math.cos(turn), 3), round(north_m + math.sin(turn), 3)]
                for turn in turns
            ]
            geometry = {"type": "Polygon", "coordinates": [[*ring, ring[0]]]}
        features.append(_feature("wall" if number % 2 else "room", number % _FLOORS, geometry))
        size += len(msgspec.json.encode(features[-1])) + 1
    floors = [{"floor": floor, "down_m": -3.2 * floor} for floor in range(_FLOORS)]
    muster = {"frame": "site-m", "floors": floors}
    plan = {"type": "FeatureCollection", "muster": muster, "features": features}
    return msgspec.json.encode(plan)


def _feature(kind: str, floor: int, geometry: dict[str, object]) -> dict[str, object]:
    properties = {"kind": kind, "floor": floor, "name": "store"}
    return {"type": "Feature", "properties": properties, "geometry": geometry}
