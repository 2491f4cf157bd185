"""Plans of the floors on which telephones were recorded, as plans of the station.

``plan.geojson`` has the floor's shape first and then its shops, in longitude and latitude; the
waypoints are in metres from the lower left corner of that shape (``floor.json``).  A shop's border
is a wall, and so is the floor's.  Rest areas and parking spaces are drawn as shops are, and nothing
stands about them.  Doors are not drawn.  Floors are numbered from 1 at the ground, and -1 below.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from base_station.site.plan import Plan, read_plan

_OPEN_CATEGORIES = {
    "5d357bc00d3c1514c7107b6a",  # parking spaces
    "5d357a28ccd5d652c76d8793",  # rest areas
}

_Ring = list[list[float]]  # (east_m, north_m) of the floor's frame


class _Size(msgspec.Struct):
    """The fields of ``floor.json`` that are read."""

    width_m: float
    height_m: float


def floor_plan(folder: Path) -> Plan:
    """Return the plan of a floor: x of its frame is east, y is north."""
    drawn = msgspec.json.decode((folder / "plan.geojson").read_bytes())
    size = msgspec.json.decode((folder / "floor.json").read_bytes(), type=_Size)
    shape, *shops = drawn["features"]
    corners = np.vstack([np.array(ring)[:, :2] for ring in _rings(shape)])
    low = corners.min(axis=0)
    scale = np.array([size.width_m, size.height_m]) / (corners.max(axis=0) - low)
    number = shape["properties"]["floor_num"]
    floor = number - 1 if number > 0 else number
    features = [_feature(kind, shape, floor, low, scale) for kind in ("outline", "wall")]
    features += [_feature("wall", shop, floor, low, scale) for shop in shops if not _is_open(shop)]
    declared = {"frame": "site-m", "floors": [{"floor": floor, "down_m": 0.0}]}
    document = {"type": "FeatureCollection", "muster": declared, "features": features}
    return read_plan(msgspec.json.encode(document))


def _is_open(shop: dict[str, Any]) -> bool:
    return not _OPEN_CATEGORIES.isdisjoint(shop["properties"]["category"])


def _feature(
    kind: str,
    drawn: dict[str, Any],
    floor: int,
    low: NDArray[np.float64],
    scale: NDArray[np.float64],
) -> dict[str, Any]:
    lines: list[_Ring] = [
        ((np.array(ring)[:, :2] - low) * scale).tolist() for ring in _rings(drawn)
    ]
    return {
        "type": "Feature",
        "properties": {"kind": kind, "floor": floor},
        "geometry": {"type": "MultiLineString", "coordinates": lines},
    }


def _rings(drawn: dict[str, Any]) -> list[_Ring]:
    """Return every ring of a polygon or of several."""
    geometry = drawn["geometry"]
    polygons = geometry["coordinates"]
    if geometry["type"] == "Polygon":
        polygons = [polygons]
    return [ring for polygon in polygons for ring in polygon]
