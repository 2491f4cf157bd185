"""KML 2.2 with ``gx:Track``: a track that Google Earth and its like play by time, one for each
known stretch of the way.

Where the plan lists the ground floor, heights are above the ground, which is drawn as the viewer's
terrain has it; else above the ellipsoid, which viewers take for the sea.
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

_BEGIN = '<kml xmlns="http://www.opengis.net/kml/2.2" xmlns:gx="http://www.google.com/kml/ext/2.2">'


def export_kml(incident: IncidentTracks) -> Iterator[bytes]:
    return in_blocks(_document(incident, incident.anchor_or_refuse()))


def _document(incident: IncidentTracks, anchor: Anchor) -> Iterator[str]:
    text = escaped(incident.description)
    about = f"<description>{text}</description>" if text else ""
    yield f"{XML_DECLARATION}{_BEGIN}<Document><name>{escaped(incident.name)}</name>{about}"
    for track in incident.tracks:
        yield from _placemark(track, anchor, incident.ground_down_m)
    yield "</Document></kml>\n"


def _placemark(worn: WornTrack, anchor: Anchor, ground_down_m: float | None) -> Iterator[str]:
    crew = f"<description>{escaped(worn.crew)}</description>" if worn.crew else ""
    yield f"\n<Placemark><name>{escaped(worn.title)}</name>{crew}"
    above = "absolute" if ground_down_m is None else "relativeToGround"
    mode = f"<altitudeMode>{above}</altitudeMode>"
    pieces = worn.pieces
    is_parted = len(pieces) > 1
    if is_parted:
        yield f"<gx:MultiTrack>{mode}<gx:interpolate>0</gx:interpolate>"
    for piece in pieces:
        times = "".join(f"<when>{time_of(point)}</when>" for point in piece)
        yield f"<gx:Track>{mode}{times}{_places(piece, anchor, ground_down_m)}</gx:Track>"
    yield "</gx:MultiTrack></Placemark>" if is_parted else "</Placemark>"


def _places(piece: Sequence[TrackSample], anchor: Anchor, ground_down_m: float | None) -> str:
    lines = []
    for point in piece:
        lat_deg, lon_deg, height_m = anchor.to_geodetic(point.north_m, point.east_m, point.down_m)
        if ground_down_m is not None:
            height_m = ground_down_m - point.down_m
        lines.append(f"\n<gx:coord>{lon_deg:.8f} {lat_deg:.8f} {height_m:.2f}</gx:coord>")
    return "".join(lines)


KML = Exporter("kml", "kml", "application/vnd.google-earth.kml+xml", True, export_kml)
