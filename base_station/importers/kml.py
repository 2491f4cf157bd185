"""Tracks and timed positions in KML 2.2 and 2.3 (``Track``, and ``Point`` with a ``TimeStamp``)."""

from __future__ import annotations

from itertools import zip_longest
from pathlib import Path

from base_station.importers.interface import Importer, ImportOptions, TrackPoints, nothing_usable
from base_station.importers.xml_elements import XmlElement, elements_of, is_xml_of, point_of
from base_station.storage.imports import ImportedContent, ImportedTrack
from shared.coded_text import coded


def read_kml(path: Path, _: ImportOptions) -> ImportedContent:
    """Read a KML file.  Raises UserError if it is none, or no position has a time."""
    tracks: list[ImportedTrack] = []
    points = TrackPoints()
    placemark = _Placemark()
    damage: list[str] = []
    left_out = 0
    for element in elements_of(path, damage):
        placemark.note(element)
        if element.name == "Track":
            left_out += placemark.end_track(points)
        elif element.name == "Placemark":
            left_out += placemark.end(points)
            if found := points.take():
                name = placemark.name or f"placemark {len(tracks) + 1}"
                tracks.append(ImportedTrack(name, found))
            placemark = _Placemark()
    left_out += placemark.end_track(points)  # the last one of a torn file
    if found := points.take():
        tracks.append(ImportedTrack(placemark.name or f"placemark {len(tracks) + 1}", found))
    if left_out:
        damage.append(
            coded(
                "import-places-left-out",
                "{count} places without a time are left out",
                count=left_out,
            )
        )
    if not tracks:
        raise nothing_usable(
            damage,
            coded(
                "import-no-timed-place",
                "no place of it has a time: save it again as a track with times",
            ),
        )
    return ImportedContent(KML.name, tuple(tracks)).with_warnings(damage)


class _Placemark:
    """Placemark, as far as it is read."""

    def __init__(self) -> None:
        self.name = ""
        self._times: list[str] = []  # of a track
        self._places: list[str] = []
        self._stamp = ""
        self._point = ""
        self._corners = 0  # of lines, which have no times

    def note(self, element: XmlElement) -> None:
        match element.parent, element.name:
            case "Placemark", "name":
                self.name = element.text
            case "Track", "when":
                self._times.append(element.text)
            case "Track", "coord":
                self._places.append(element.text)
            case "TimeStamp", "when":
                self._stamp = element.text
            case "Point", "coordinates":
                self._point = element.text
            case "LineString", "coordinates":
                self._corners += len(element.text.split())

    def end_track(self, points: TrackPoints) -> int:
        """End a track, and return how many positions were left out."""
        left_out = 0
        for time, place in zip_longest(self._times, self._places, fillvalue=""):
            left_out += _add(points, time, place.split())
        self._times.clear()
        self._places.clear()
        return left_out

    def end(self, points: TrackPoints) -> int:
        """End the placemark, and return how many positions were left out."""
        left_out = self._corners
        if self._point:
            left_out += _add(points, self._stamp, self._point.split(","))
        return left_out


def _add(points: TrackPoints, time: str, place: list[str]) -> int:
    """Add a position, and return 1 if it was left out, otherwise 0."""
    lon, lat, height = [*place, "", "", ""][:3]
    point = point_of(time, lat, lon, height)
    if point is None:
        return 1
    points.add(point)
    return 0


KML = Importer("kml", lambda head: is_xml_of(head, "kml"), read_kml)
