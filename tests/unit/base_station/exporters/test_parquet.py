"""Parquet, read by other programs: data frames, a database, geographic tools."""

from __future__ import annotations

import io
import json
import struct
import sys
from dataclasses import replace
from pathlib import Path

import duckdb
import pytest
from pyarrow import parquet

from base_station.exporters.interface import IncidentTracks, WornTrack
from base_station.exporters.parquet import export_parquet
from base_station.storage.db.records import TrackSample
from shared.clock import NS_PER_S
from shared.errors import UserError
from shared.geo import Anchor

T0_NS = 1_700_000_000 * NS_PER_S
ANCHOR = Anchor(52.0, 13.0, 40.0, rotation_rad=0.5)


def incident(anchor: Anchor | None = ANCHOR) -> IncidentTracks:
    points = tuple(
        TrackSample(T0_NS + n * NS_PER_S, n, 0.5, -1.5, 0.1, 0.1, 0.2, 0.3, n % 2 or None, "good")
        for n in range(4)
    )
    tracks = (WornTrack("FF-01", "Zoë", "A", points), WornTrack("FF-02", "", "", points[:1]))
    return IncidentTracks("i-1", "Mill", anchor, tracks)


def written(of: IncidentTracks) -> io.BytesIO:
    return io.BytesIO(b"".join(export_parquet(of)))


def test_database_answers_queries_about_it(tmp_path: Path) -> None:
    file = tmp_path / "tracks.parquet"
    file.write_bytes(written(incident()).getvalue())
    found = duckdb.execute(
        "select unit_id, any_value(person), count(*), max(north_m), count(floor), "
        f"epoch_ms(min(t_utc)) from '{file}' group by unit_id order by unit_id"
    ).fetchall()
    t0_ms = T0_NS // 1_000_000
    assert found == [("FF-01", "Zoë", 4, 3.0, 2, t0_ms), ("FF-02", "", 1, 0.0, 0, t0_ms)]


def test_places_are_geoparquet_with_longitude_first() -> None:
    table = parquet.read_table(written(incident()))
    geo = json.loads(table.schema.metadata[b"geo"])
    assert geo["columns"][geo["primary_column"]]["encoding"] == "WKB"
    points = (point for track in incident().tracks for point in track.points)
    for point, content in zip(points, table["geometry"].to_pylist(), strict=True):
        order, kind, lon_deg, lat_deg, height_m = struct.unpack("<BIddd", content)
        assert (order, kind) == (1, 1001)
        assert (lat_deg, lon_deg, height_m) == ANCHOR.to_geodetic(
            point.north_m, point.east_m, point.down_m
        )


def test_without_an_anchor_it_has_metres_alone() -> None:
    table = parquet.read_table(written(incident(None)))
    assert "geometry" not in table.column_names
    assert b"geo" not in table.schema.metadata
    assert table["down_m"].to_pylist() == [-1.5] * 5
    assert table.schema.metadata[b"muster.incident"] == b"i-1"


def test_incident_without_tracks_is_an_empty_table() -> None:
    empty = replace(incident(), tracks=())
    assert parquet.read_table(written(empty)).num_rows == 0


def test_missing_library_is_named_with_its_remedy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(UserError, match="requirements-parquet"):
        export_parquet(incident())
