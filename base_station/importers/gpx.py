"""Tracks, routes and waypoints in GPX 1.0 and 1.1."""

from __future__ import annotations

from pathlib import Path

from base_station.importers.interface import Importer, ImportOptions, TrackPoints, nothing_usable
from base_station.importers.xml_elements import elements_of, is_xml_of, point_of
from base_station.storage.imports import ImportedContent, ImportedTrack
from shared.coded_text import coded

_POINTS, _TRACKS = frozenset({"trkpt", "rtept", "wpt"}), frozenset({"trk", "rte", "wpt"})


def read_gpx(path: Path, _: ImportOptions) -> ImportedContent:
    """Read a GPX file.  Raises UserError if it is none, or no point has a time."""
    tracks: list[ImportedTrack] = []
    points = TrackPoints()
    damage: list[str] = []
    left_out = 0
    name, of_point = "", dict[str, str]()
    for element in elements_of(path, damage):
        if element.name == "name" and element.parent in _TRACKS:
            name = element.text
        elif element.parent in _POINTS:
            of_point[element.name] = element.text
        if element.name in _POINTS:
            lat, lon = element.attributes.get("lat", ""), element.attributes.get("lon", "")
            point = point_of(of_point.get("time", ""), lat, lon, of_point.get("ele", ""))
            of_point.clear()
            if point is None:
                left_out += 1
            else:
                points.add(point)
        if element.name in _TRACKS:
            if found := points.take():
                tracks.append(ImportedTrack(name or f"{element.name} {len(tracks) + 1}", found))
            name = ""
    if found := points.take():  # of a track that the file breaks off in
        tracks.append(ImportedTrack(name or f"track {len(tracks) + 1}", found))
    if left_out:
        damage.append(
            coded(
                "import-points-left-out",
                "{count} points without a place or a time are left out",
                count=left_out,
            )
        )
    if not tracks:
        raise nothing_usable(
            damage,
            coded(
                "import-no-point",
                "no point of it has a place and a time: save it again as a recorded track, with "
                "times",
            ),
        )
    return ImportedContent(GPX.name, tuple(tracks)).with_warnings(damage)


GPX = Importer("gpx", lambda head: is_xml_of(head, "gpx"), read_gpx)
