"""CSV: one row for each point, with positions on the Earth if the site has an anchor."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator

from base_station.exporters.interface import Exporter, IncidentTracks, WornTrack, in_blocks
from base_station.views.answer import to_ms
from shared.geo import Anchor

COLUMNS = (
    "unit_id", "person", "crew", "t_utc_s", "north_m", "east_m", "down_m",
    "std_north_m", "std_east_m", "std_down_m", "floor", "quality",
    "lat_deg", "lon_deg", "height_m",
)  # fmt: skip
_FORMULA_STARTS = ("=", "+", "-", "@", "\t", "\r")


def export_csv(incident: IncidentTracks) -> Iterator[bytes]:
    return in_blocks(_table(incident))


def _table(incident: IncidentTracks) -> Iterator[str]:
    yield f"{','.join(COLUMNS)}\r\n"
    for track in incident.tracks:
        yield _rows(track, incident.anchor)


def _rows(track: WornTrack, anchor: Anchor | None) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\r\n")
    who = (track.unit_id, _plain(track.person_name), _plain(track.crew))
    for point in track.points:
        metres = (
            point.north_m, point.east_m, point.down_m,
            point.std_north_m, point.std_east_m, point.std_down_m,
        )  # fmt: skip
        place: tuple[str, ...] = ("", "", "")
        if anchor is not None:
            lat_deg, lon_deg, height_m = anchor.to_geodetic(*metres[:3])
            place = (f"{lat_deg:.8f}", f"{lon_deg:.8f}", f"{height_m:.2f}")
        writer.writerow(
            (
                *who,
                f"{to_ms(point.t_ns) / 1000:.3f}",
                *(f"{value:.3f}" for value in metres),
                "" if point.floor is None else point.floor,
                point.quality,
                *place,
            )
        )
    return text.getvalue()


def _plain(text: str) -> str:
    """Text that a spreadsheet does not take for a formula."""
    return f"'{text}" if text.startswith(_FORMULA_STARTS) else text


CSV = Exporter("csv", "csv", "text/csv; charset=utf-8", False, export_csv)
