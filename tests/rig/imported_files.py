"""Files from elsewhere that can be brought into an incident, made as others make them."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

import gpxpy.gpx
from PIL import ExifTags, Image

from shared.channels import FUSED
from shared.clock import NS_PER_S
from shared.codec import encode
from shared.messages import STATION_ID
from tests.rig.station_script import Record, Script

Point = tuple[int, float, float]  # UTC in seconds, latitude and longitude in degrees


def line(t_s: int, seconds: int, lat_deg: float = 52.0, lon_deg: float = 4.0) -> list[Point]:
    """A walk to the north-east from a place, a point a second."""
    return [(t_s + one, lat_deg + one * 1e-6, lon_deg + one * 1e-6) for one in range(seconds)]


def write_gpx(path: Path, name: str, points: Sequence[Point], *, is_timed: bool = True) -> Path:
    document = gpxpy.gpx.GPX()
    track = gpxpy.gpx.GPXTrack(name=name)
    document.tracks.append(track)
    segment = gpxpy.gpx.GPXTrackSegment()
    track.segments.append(segment)
    for t_s, lat_deg, lon_deg in points:
        time = datetime.fromtimestamp(t_s, UTC) if is_timed else None
        segment.points.append(gpxpy.gpx.GPXTrackPoint(lat_deg, lon_deg, 12.5, time))
    path.write_text(document.to_xml(), "utf-8")
    return path


def write_kml(path: Path, name: str, points: Sequence[Point]) -> Path:
    """As Google Earth saves a recorded track, with a place of a moment and a drawn line."""
    whens = "".join(f"<when>{_iso(t_s)}</when>" for t_s, _, _ in points)
    coords = "".join(f"<gx:coord>{lon} {lat} 3</gx:coord>" for _, lat, lon in points)
    t_s, lat, lon = points[0]
    path.write_text(
        '<?xml version="1.0" encoding="UTF-8"?><kml xmlns="http://www.opengis.net/kml/2.2" '
        'xmlns:gx="http://www.google.com/kml/ext/2.2"><Document><Folder>'
        f"<Placemark><name>{name}</name><gx:Track>{whens}{coords}</gx:Track></Placemark>"
        f"<Placemark><name>Hydrant</name><TimeStamp><when>{_iso(t_s)}</when></TimeStamp>"
        f"<Point><coordinates>{lon},{lat},0</coordinates></Point></Placemark>"
        f"<Placemark><name>Fence</name><LineString><coordinates>{lon},{lat} {lon},{lat}"
        "</coordinates></LineString></Placemark></Folder></Document></kml>",
        "utf-8",
    )
    return path


def write_photo(
    path: Path,
    place: tuple[float, float] | None,
    taken: str = "",
    zone: str = "",
    fix_s: int | None = None,
) -> Path:
    """A JPEG of 640 by 480; ``taken``: local time as Exif writes it; ``fix_s``: UTC of its fix."""
    picture = Image.new("RGB", (640, 480), (200, 80, 40))
    picture.paste((250, 220, 60), (220, 140, 420, 400))
    exif = Image.Exif()
    gps: dict[int, object] = {}
    if place is not None:
        lat_deg, lon_deg = place
        gps |= {
            ExifTags.GPS.GPSLatitudeRef: "N" if lat_deg >= 0.0 else "S",
            ExifTags.GPS.GPSLatitude: _parts(abs(lat_deg)),
            ExifTags.GPS.GPSLongitudeRef: "E" if lon_deg >= 0.0 else "W",
            ExifTags.GPS.GPSLongitude: _parts(abs(lon_deg)),
        }
    if fix_s is not None:
        fix = datetime.fromtimestamp(fix_s, UTC)
        gps[ExifTags.GPS.GPSDateStamp] = f"{fix:%Y:%m:%d}"
        gps[ExifTags.GPS.GPSTimeStamp] = (float(fix.hour), float(fix.minute), float(fix.second))
    details = {ExifTags.Base.DateTimeOriginal: taken, ExifTags.Base.OffsetTimeOriginal: zone}
    exif.get_ifd(ExifTags.IFD.GPSInfo).update(gps)
    exif.get_ifd(ExifTags.IFD.Exif).update({tag: text for tag, text in details.items() if text})
    picture.save(path, "JPEG", exif=exif)
    return path


def exif_time(t_s: int, offset_h: float = 0.0) -> str:
    """Local time of a clock, as Exif writes it."""
    return f"{datetime.fromtimestamp(t_s + offset_h * 3600.0, UTC):%Y:%m:%d %H:%M:%S}"


def in_ns(t_s: int) -> int:
    return t_s * NS_PER_S


def records_with_fused(script: Script) -> list[Record]:
    """Records of a script with the fused positions, which a station logs, too."""
    key = FUSED.key(STATION_ID)
    fused = [(one.t_meas_ns, key, encode(one)) for one in script.fused]
    return sorted([*script.records, *fused], key=lambda record: record[0])


def _iso(t_s: int) -> str:
    return f"{datetime.fromtimestamp(t_s, UTC):%Y-%m-%dT%H:%M:%SZ}"


def _parts(degrees: float) -> tuple[float, float, float]:
    """Degrees, minutes and seconds."""
    whole, minutes = int(degrees), (degrees % 1.0) * 60.0
    return float(whole), float(int(minutes)), round((minutes % 1.0) * 60.0, 4)
