"""Parquet: one row for each point; GeoParquet 1.1 if the site has an anchor.

By the library ``pyarrow``, an optional part (``muster[parquet]``): most stations never write for
data frames and databases.
"""

from __future__ import annotations

import io
import json
from collections.abc import Iterable, Iterator, Sequence
from importlib import import_module
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from base_station.exporters.interface import Exporter, IncidentTracks, WornTrack
from shared.coded_text import coded
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
_ROWS = 1 << 16  # of a row group, at least but in the last one


def export_parquet(incident: IncidentTracks) -> Iterator[bytes]:
    pyarrow, parquet = _library("pyarrow"), _library("pyarrow.parquet")
    return _written(pyarrow, parquet, incident)


def _written(pyarrow: ModuleType, parquet: ModuleType, incident: IncidentTracks) -> Iterator[bytes]:
    schema = _schema(pyarrow, incident)
    outlet = _Outlet()
    with parquet.ParquetWriter(
        pyarrow.PythonFile(outlet, mode="w"), schema, compression="zstd"
    ) as writer:
        for tracks in _row_groups(incident.tracks):
            columns = _columns(pyarrow, tracks, incident.anchor)
            writer.write_table(pyarrow.table(columns, schema=schema))
            yield outlet.take()
    yield outlet.take()  # the footer of a file


class _Outlet(io.RawIOBase):
    """File whose content is taken out as it is written."""

    def __init__(self) -> None:
        self._parts: list[bytes] = []

    def writable(self) -> bool:
        return True

    def write(self, content: Any, /) -> int:  # any object with a buffer
        part = bytes(content)
        self._parts.append(part)
        return len(part)

    def take(self) -> bytes:
        content = b"".join(self._parts)
        self._parts.clear()
        return content


def _row_groups(tracks: Iterable[WornTrack]) -> Iterator[list[WornTrack]]:
    """Groups of many points: a row group is the smallest part that a reader can take."""
    group: list[WornTrack] = []
    for track in tracks:
        group.append(track)
        if sum(len(one.points) for one in group) >= _ROWS:
            yield group
            group = []
    if group:
        yield group


def _library(name: str) -> ModuleType:
    try:
        return import_module(name)
    except ImportError as error:
        raise UserError(
            coded(
                "parquet-library-missing",
                "the library pyarrow, which writes Parquet, is not installed: "
                "pip install --require-hashes -r deploy/requirements-parquet.lock",
            )
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
    pyarrow: ModuleType, tracks: Sequence[WornTrack], anchor: Anchor | None
) -> dict[str, Any]:
    points = [point for track in tracks for point in track.points]
    counts = [len(track.points) for track in tracks]
    numbers = np.array([[getattr(point, key) for key in _METRES] for point in points])
    numbers = numbers.reshape(len(points), len(_METRES))
    t_ms = np.array([point.t_ns for point in points], np.int64) // 1_000_000
    columns: dict[str, Any] = {
        "unit_id": _repeated(pyarrow, [track.unit_id for track in tracks], counts),
        "person": _repeated(pyarrow, [track.person_name for track in tracks], counts),
        "crew": _repeated(pyarrow, [track.crew for track in tracks], counts),
        "t_utc": t_ms.astype("datetime64[ms]"),
        **dict(zip(_METRES, numbers.T, strict=True)),
        "heading_rad": [point.heading_rad for point in points],
        "floor": [point.floor for point in points],
        "quality": pyarrow.array(
            [point.quality for point in points], pyarrow.string()
        ).dictionary_encode(),
    }
    if anchor is not None:
        places = _places(anchor, numbers)
        fixed = pyarrow.binary(places.itemsize)
        content = [None, pyarrow.py_buffer(places)]
        geometry = pyarrow.FixedSizeBinaryArray.from_buffers(fixed, len(places), content)
        columns |= {"height_m": places["height_m"], "geometry": geometry.cast(pyarrow.binary())}
    return columns


def _repeated(pyarrow: ModuleType, texts: Sequence[str], counts: Sequence[int]) -> Any:
    """Each text repeated by its count, as a dictionary and indices."""
    indices = np.repeat(np.arange(len(texts), dtype=np.int32), counts)
    return pyarrow.DictionaryArray.from_arrays(indices, pyarrow.array(texts, pyarrow.string()))


def _places(anchor: Anchor, metres: NDArray[np.float64]) -> NDArray[Any]:
    """Position of each point as well-known binary, in which the height is the last number."""
    places = np.zeros(
        len(metres),
        [("little_endian", "u1"), ("type", "<u4"), ("lon_deg", "<f8"), ("lat_deg", "<f8"),
         ("height_m", "<f8")],
    )  # fmt: skip
    geodetic = [anchor.to_geodetic(*place_m) for place_m in metres[:, :3].tolist()]
    places["little_endian"], places["type"] = 1, _POINT_Z
    for name, column in zip(
        ("lat_deg", "lon_deg", "height_m"), zip(*geodetic, strict=True), strict=True
    ):
        places[name] = column
    return places


PARQUET = Exporter(
    "parquet",
    "parquet",
    "application/vnd.apache.parquet",
    needs_anchor=False,
    export=export_parquet,
    is_compressed=True,
)
