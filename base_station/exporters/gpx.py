"""GPX 1.1: one ``trk`` a wearer, with a ``trkseg`` for each known stretch of the way; heights are
above the ellipsoid.
"""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree import ElementTree as ET

from base_station.exporters.interface import Exporter, IncidentTracks, WornTrack, time_of
from base_station.storage.db.records import TrackSample
from shared.geo import Anchor
from shared.xml_text import in_xml

_NAMESPACE = "http://www.topografix.com/GPX/1/1"


def export_gpx(incident: IncidentTracks) -> bytes:
    anchor = incident.anchor_or_refuse()
    gpx = ET.Element("gpx", version="1.1", creator="Muster", xmlns=_NAMESPACE)
    ET.SubElement(ET.SubElement(gpx, "metadata"), "name").text = in_xml(incident.name)
    for track in incident.tracks:
        _add_track(gpx, track, anchor)
    document: bytes = ET.tostring(gpx, encoding="utf-8", xml_declaration=True)
    return document


def _add_track(gpx: ET.Element, track: WornTrack, anchor: Anchor) -> None:
    trk = ET.SubElement(gpx, "trk")
    ET.SubElement(trk, "name").text = in_xml(track.title)
    if track.crew:
        ET.SubElement(trk, "type").text = in_xml(track.crew)
    for piece in track.pieces:
        _add_segment(trk, piece, anchor)


def _add_segment(trk: ET.Element, piece: Sequence[TrackSample], anchor: Anchor) -> None:
    segment = ET.SubElement(trk, "trkseg")
    for point in piece:
        lat_deg, lon_deg, height_m = anchor.to_geodetic(point.north_m, point.east_m, point.down_m)
        trkpt = ET.SubElement(segment, "trkpt", lat=f"{lat_deg:.8f}", lon=f"{lon_deg:.8f}")
        # The schema wants this order.
        ET.SubElement(trkpt, "ele").text = f"{height_m:.2f}"
        ET.SubElement(trkpt, "time").text = time_of(point)


GPX = Exporter("gpx", "gpx", "application/gpx+xml", True, export_gpx)
