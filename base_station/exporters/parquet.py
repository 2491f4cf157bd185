"""Parquet: one row a point; GeoParquet 1.1 where the site has an anchor.

Through the library ``pyarrow``, an optional part (``muster[parquet]``): most stations never write
for data frames and databases.
"""

from __future__ import annotations

import json
from importlib import import_module
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from base_station.exporters.interface import Exporter, IncidentTracks
from base_station.storage.db.records import TrackSample
from shared.errors import UserError
from shared.geo import Anchor

_METRES = ("north_m", "east_m", "down_m", "std_north_m", "std_east_m", "std_down_m")
# https://geoparquet.org/releases/v1.1.0/; without ``crs`` coordinates are longitude and latitude.
_GEO = {
    "version": "1.1.0",
    "primary_column": "geometry",
    "columns": {"geometry": {"encoding": "WKB", "geometry_types": ["Point Z"]}},
}
_POINT_Z = 1001  # of ISO well-known binary


def export_parquet(incident: IncidentTracks) -> bytes:
    pyarrow, parquet = _library("pyarrow"), _library("pyarrow.parquet")
    points = [point for track in incident.tracks for point in track.points]
    table = pyarrow.table(_columns(pyarrow, incident, points), schema=_schema(pyarrow, incident))
    written = pyarrow.BufferOutputStream()
    parquet.write_table(table, written, compression="zstd")
    content: bytes = written.getvalue().to_pybytes()
    return content


def _library(name: str) -> ModuleType:
    try:
        return import_module(name)
    except ImportError as error:
        raise UserError(
            "the library pyarrow, which writes Parquet, is not installed: "
            "pip install --require-hashes -r deploy/requirements-parquet.lock"
        ) from error


def _schema(pyarrow: ModuleType, incident: IncidentTracks) -> Any:
    name = pyarrow.dictionary(pyarrow.int32(), pyarrow.string())  # few of them, in many rows
    fields = {
        "unit_id": name,
        "person": name,
        "crew": name,
        "t_utc": pyarrow.timestamp("ms", tz="UTC"),
        **dict.fromkeys(_METRES, pyarrow.float64()),
        "heading_rad": pyarrow.float64(),
        "floor": pyarrow.int16(),
        "quality": name,
    }
    metadata = {"muster.incident": incident.incident_id}
    if incident.anchor is not None:
        fields |= {"height_m": pyarrow.float64(), "geometry": pyarrow.binary()}
        metadata["geo"] = json.dumps(_GEO)
    return pyarrow.schema(list(fields.items()), metadata=metadata)


def _columns(
    pyarrow: ModuleType, incident: IncidentTracks, points: list[TrackSample]
) -> dict[str, Any]:
    wearers = [
        (track.unit_id, track.person_name, track.crew)
        for track in incident.tracks
        for _ in track.points
    ]
    unit_ids, people, crews = zip(*wearers, strict=True) if wearers else ((), (), ())
    numbers = np.array([[getattr(point, key) for key in _METRES] for point in points])
    numbers = numbers.reshape(len(points), len(_METRES))
    t_ms = np.array([point.t_ns for point in points], np.int64) // 1_000_000
    columns: dict[str, Any] = {
        "unit_id": pyarrow.array(unit_ids, pyarrow.string()).dictionary_encode(),
        "person": pyarrow.array(people, pyarrow.string()).dictionary_encode(),
        "crew": pyarrow.array(crews, pyarrow.string()).dictionary_encode(),
        "t_utc": t_ms.astype("datetime64[ms]"),
        **dict(zip(_METRES, numbers.T, strict=True)),
        "heading_rad": [point.heading_rad for point in points],
        "floor": [point.floor for point in points],
        "quality": pyarrow.array(
            [point.quality for point in points], pyarrow.string()
        ).dictionary_encode(),
    }
    if incident.anchor is not None:
        places = _places(incident.anchor, numbers)
        columns |= {"height_m": places["height_m"], "geometry": list(map(bytes, places))}
    return columns


def _places(anchor: Anchor, metres: NDArray[np.float64]) -> NDArray[Any]:
    """Well-known binary of each point, of which the height is the last number."""
    places = np.zeros(
        len(metres),
        [("little_endian", "u1"), ("type", "<u4"), ("lon_deg", "<f8"), ("lat_deg", "<f8"),
         ("height_m", "<f8")],
    )  # fmt: skip
    places["little_endian"], places["type"] = 1, _POINT_Z
    for place, (north_m, east_m, down_m) in zip(places, metres[:, :3].tolist(), strict=True):
        lat_deg, lon_deg, height_m = anchor.to_geodetic(north_m, east_m, down_m)
        place["lon_deg"], place["lat_deg"], place["height_m"] = lon_deg, lat_deg, height_m
    return places


PARQUET = Exporter("parquet", "parquet", "application/vnd.apache.parquet", False, export_parquet)
