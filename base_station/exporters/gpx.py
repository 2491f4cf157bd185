"""GPX 1.1: one ``trk`` for each wearer, with a ``trkseg`` for each known part of the way; heights
are above the ellipsoid.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from base_station.exporters.interface import (
    Exporter,
    IncidentTracks,
    WornTrack,
    in_blocks,
    time_of,
)
from base_station.storage.db.records import TrackSample
from shared.geo import Anchor
from shared.xml_text import XML_DECLARATION, escaped

_BEGIN = '<gpx version="1.1" creator="Muster" xmlns="http://www.topografix.com/GPX/1/1">'


def export_gpx(incident: IncidentTracks) -> Iterator[bytes]:
    return in_blocks(_document(incident, incident.anchor_or_refuse()))


def _document(incident: IncidentTracks, anchor: Anchor) -> Iterator[str]:
    about = f"<desc>{escaped(incident.description)}</desc>" if incident.description else ""
    name = f"<name>{escaped(incident.name)}</name>"
    yield f"{XML_DECLARATION}{_BEGIN}<metadata>{name}{about}</metadata>"
    for track in incident.tracks:
        yield from _track(track, anchor)
    yield "</gpx>\n"


def _track(track: WornTrack, anchor: Anchor) -> Iterator[str]:
    crew = f"<type>{escaped(track.crew)}</type>" if track.crew else ""
    yield f"\n<trk><name>{escaped(track.title)}</name>{crew}"
    for piece in track.pieces:
        yield f"<trkseg>{_points(piece, anchor)}</trkseg>"
    yield "</trk>"


def _points(piece: Sequence[TrackSample], anchor: Anchor) -> str:
    lines = []
    for point in piece:
        lat_deg, lon_deg, height_m = anchor.to_geodetic(point.north_m, point.east_m, point.down_m)
        lines.append(  # the schema wants this order
            f'\n<trkpt lat="{lat_deg:.8f}" lon="{lon_deg:.8f}">'
            f"<ele>{height_m:.2f}</ele><time>{time_of(point)}</time></trkpt>"
        )
    return "".join(lines)


GPX = Exporter("gpx", "gpx", "application/gpx+xml", True, export_gpx)
