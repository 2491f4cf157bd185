"""KML 2.2 with ``gx:Track``: a track that Google Earth and its like play by time, one for each
known stretch of the way.
"""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree import ElementTree as ET

from base_station.exporters.interface import Exporter, IncidentTracks, WornTrack, time_of
from base_station.storage.db.records import TrackSample
from shared.geo import Anchor
from shared.xml_text import in_xml

_GX = "http://www.google.com/kml/ext/2.2"


def export_kml(incident: IncidentTracks) -> bytes:
    anchor = incident.anchor_or_refuse()
    kml = ET.Element("kml", {"xmlns": "http://www.opengis.net/kml/2.2", "xmlns:gx": _GX})
    document = ET.SubElement(kml, "Document")
    ET.SubElement(document, "name").text = in_xml(incident.name)
    for track in incident.tracks:
        _add_track(document, track, anchor)
    written: bytes = ET.tostring(kml, encoding="utf-8", xml_declaration=True)
    return written


def _add_track(document: ET.Element, worn: WornTrack, anchor: Anchor) -> None:
    placemark = ET.SubElement(document, "Placemark")
    ET.SubElement(placemark, "name").text = in_xml(worn.title)
    if worn.crew:
        ET.SubElement(placemark, "description").text = in_xml(worn.crew)
    # Heights are those of the floors, not of the ground below them.
    absolute = "absolute"
    within = placemark
    if len(worn.pieces) > 1:
        within = ET.SubElement(placemark, "gx:MultiTrack")
        ET.SubElement(within, "altitudeMode").text = absolute
        ET.SubElement(within, "gx:interpolate").text = "0"
    for piece in worn.pieces:
        track = ET.SubElement(within, "gx:Track")
        ET.SubElement(track, "altitudeMode").text = absolute
        _add_points(track, piece, anchor)


def _add_points(track: ET.Element, piece: Sequence[TrackSample], anchor: Anchor) -> None:
    for point in piece:
        ET.SubElement(track, "when").text = time_of(point)
    for point in piece:
        lat_deg, lon_deg, height_m = anchor.to_geodetic(point.north_m, point.east_m, point.down_m)
        coord = f"{lon_deg:.8f} {lat_deg:.8f} {height_m:.2f}"
        ET.SubElement(track, "gx:coord").text = coord


KML = Exporter("kml", "kml", "application/vnd.google-earth.kml+xml", True, export_kml)
