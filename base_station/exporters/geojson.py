"""GeoJSON (RFC 7946): one line for each wearer and known part of the way, ``[lon, lat, height]``,
with the times beside it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import msgspec

from base_station.exporters.interface import Exporter, IncidentTracks, WornTrack
from base_station.storage.db.records import TrackSample
from base_station.views.answer import to_ms
from shared.geo import Anchor


def export_geojson(incident: IncidentTracks) -> Iterator[bytes]:
    return _collection(incident, incident.anchor_or_refuse())


def _collection(incident: IncidentTracks, anchor: Anchor) -> Iterator[bytes]:
    head: dict[str, Any] = {"type": "FeatureCollection"}
    if incident.description:
        head["description"] = incident.description
    before = msgspec.json.encode(head)[:-1] + b',"features":['
    for track in incident.tracks:
        for piece in track.pieces:
            yield before + msgspec.json.encode(_feature(track, piece, anchor))
            before = b",\n"
    yield b"]}\n" if before == b",\n" else before + b"]}\n"


def _feature(track: WornTrack, piece: Sequence[TrackSample], anchor: Anchor) -> dict[str, Any]:
    places = [_place(anchor, point.north_m, point.east_m, point.down_m) for point in piece]
    # A line needs two places.
    geometry = (
        {"type": "LineString", "coordinates": places}
        if len(places) > 1
        else {"type": "Point", "coordinates": places[0]}
    )
    return {
        "type": "Feature",
        "geometry": geometry,
        "properties": {
            "unit_id": track.unit_id,
            "name": track.title,
            "crew": track.crew,
            "times_ms": [to_ms(point.t_ns) for point in piece],
            "floors": [point.floor for point in piece],
        },
    }


def _place(anchor: Anchor, north_m: float, east_m: float, down_m: float) -> list[float]:
    lat_deg, lon_deg, height_m = anchor.to_geodetic(north_m, east_m, down_m)
    return [round(lon_deg, 8), round(lat_deg, 8), round(height_m, 2)]


GEOJSON = Exporter("geojson", "geojson", "application/geo+json", True, export_geojson)
