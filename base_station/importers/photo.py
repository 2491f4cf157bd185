"""Photograph with a position and a time in its Exif data (CIPA DC-008)."""

from __future__ import annotations

import math
import warnings
from datetime import UTC, datetime, timedelta, timezone
from pathlib import Path
from typing import Any

from PIL import ExifTags, Image

from base_station.importers.interface import Importer, ImportOptions
from base_station.storage.imports import ImportedContent, ImportedPoint, ImportedTrack
from base_station.storage.small_picture import small_jpeg
from shared.clock import NS_PER_S
from shared.coded_text import coded, text_of_error
from shared.errors import UserError

PICTURE_SIDE_PX = 320
_FORMATS = ("JPEG", "PNG", "TIFF", "WEBP")
_BEGINNINGS = (b"\xff\xd8\xff", b"\x89PNG\r\n\x1a\n", b"II*\0", b"MM\0*", b"RIFF")
_BELOW_SEA = 1
_OF_FIX = coded(
    "import-time-of-fix",
    "its time is that of the camera's satellite fix; it may have been taken later",
)
_Tags = dict[int, Any]


def read_photo(path: Path, options: ImportOptions) -> ImportedContent:
    """Read a photograph.  Raises UserError if it is none, or has no position or no time."""
    try:
        with (
            warnings.catch_warnings(action="error", category=Image.DecompressionBombWarning),
            Image.open(path, formats=_FORMATS) as image,
        ):
            exif = image.getexif()
            gps = dict(exif.get_ifd(ExifTags.IFD.GPSInfo))
            details = dict(exif.get_ifd(ExifTags.IFD.Exif))
            lat_deg, lon_deg = _place(gps)
            t_ns, warning = _time_ns(details, gps, options.utc_offset_h)
            picture = small_jpeg(image, PICTURE_SIDE_PX)
    except (Image.DecompressionBombWarning, Image.DecompressionBombError) as error:
        raise UserError(
            coded(
                "photo-import-too-large",
                "it has too many pixels; save it smaller, with its Exif data",
            )
        ) from error
    except (OSError, ValueError, SyntaxError) as error:
        raise UserError(
            coded(
                "photo-import-unreadable",
                "it is no picture that can be read: {error}",
                error=text_of_error(error),
            )
        ) from error
    point = ImportedPoint(t_ns, lat_deg, lon_deg, _height_m(gps))
    track = ImportedTrack(options.file_name, (point,))
    content = ImportedContent(PHOTO.name, (track,), picture=picture)
    return content.with_warnings((warning,) if warning else ())


def _place(gps: _Tags) -> tuple[float, float]:
    try:
        lat_deg = _degrees(gps[ExifTags.GPS.GPSLatitude])
        lon_deg = _degrees(gps[ExifTags.GPS.GPSLongitude])
        south = str(gps.get(ExifTags.GPS.GPSLatitudeRef, "N")).upper().startswith("S")
        west = str(gps.get(ExifTags.GPS.GPSLongitudeRef, "E")).upper().startswith("W")
    except (KeyError, TypeError, ValueError, ZeroDivisionError) as error:
        raise UserError(
            coded(
                "photo-import-no-place",
                "it has no place in its Exif data: the camera had no fix, or the place was "
                "taken out on the way; take the original file",
            )
        ) from error
    lat_deg, lon_deg = -lat_deg if south else lat_deg, -lon_deg if west else lon_deg
    if not (abs(lat_deg) <= 90.0 and abs(lon_deg) <= 180.0):  # no number is neither
        raise UserError(
            coded(
                "photo-import-place-unfit",
                "the place in its Exif data is none: {lat_deg}, {lon_deg}",
                lat_deg=str(lat_deg),
                lon_deg=str(lon_deg),
            )
        )
    return lat_deg, lon_deg


def _degrees(parts: Any) -> float:
    degrees, minutes, seconds = (float(one) for one in parts)
    return degrees + minutes / 60.0 + seconds / 3600.0


def _height_m(gps: _Tags) -> float | None:
    try:
        height_m = float(gps[ExifTags.GPS.GPSAltitude])
    except (KeyError, TypeError, ValueError, ZeroDivisionError):
        return None
    if not math.isfinite(height_m):
        return None
    reference = gps.get(ExifTags.GPS.GPSAltitudeRef, 0)
    below = reference[0] if isinstance(reference, bytes) and reference else reference
    return -height_m if below == _BELOW_SEA else height_m


def _time_ns(details: _Tags, gps: _Tags, utc_offset_h: float | None) -> tuple[int, str]:
    """UTC of the picture, and a warning if another time is used for it."""
    taken = _text(details, ExifTags.Base.DateTimeOriginal)
    zone = _text(details, ExifTags.Base.OffsetTimeOriginal)
    fix_ns = _fix_ns(gps)
    try:
        local = datetime.strptime(taken, "%Y:%m:%d %H:%M:%S")  # noqa: DTZ007  # its zone follows
    except ValueError as error:
        if fix_ns is None:
            raise UserError(
                coded("photo-import-no-time", "its Exif data do not say when it was taken")
            ) from error
        return fix_ns, _OF_FIX
    if zone:
        try:
            return _to_ns(datetime.fromisoformat(f"{local.isoformat()}{zone}")), ""
        except ValueError:
            pass  # an invalid time zone is ignored
    if utc_offset_h is not None:
        return _to_ns(local.replace(tzinfo=timezone(timedelta(hours=utc_offset_h)))), ""
    if fix_ns is None:
        raise UserError(
            coded(
                "photo-import-no-zone",
                "it was taken at {taken} by a clock whose time zone it does not state: give the "
                "hours of that before UTC (--utc-offset-h), for example 2 for Central European "
                "Summer Time",
                taken=taken,
            )
        )
    return fix_ns, _OF_FIX


def _fix_ns(gps: _Tags) -> int | None:
    """UTC of the satellite fix; None if the picture has none."""
    try:
        date = datetime.strptime(_text(gps, ExifTags.GPS.GPSDateStamp), "%Y:%m:%d")  # noqa: DTZ007  # UTC, set two lines below
        hours, minutes, seconds = (float(one) for one in gps[ExifTags.GPS.GPSTimeStamp])
        time = timedelta(hours=hours, minutes=minutes, seconds=seconds)
        return _to_ns(date.replace(tzinfo=UTC) + time)
    except (KeyError, TypeError, ValueError, ZeroDivisionError, OverflowError):
        return None


def _text(tags: _Tags, tag: int) -> str:
    return str(tags.get(tag, "")).strip(" \0")


def _to_ns(at: datetime) -> int:
    return round(at.timestamp() * 1000) * (NS_PER_S // 1000)


PHOTO = Importer("photo", lambda head: head.startswith(_BEGINNINGS), read_photo)
