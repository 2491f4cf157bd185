"""Positions of imported tracks in the incident frame."""

from __future__ import annotations

from base_station.storage.imports import ImportedTrack
from base_station.views.answer import to_ms
from shared.clock import NS_PER_S
from shared.geo import Anchor

PlacedPoint = tuple[int, float, float, int | None]  # t_ms, north_m, east_m, floor


def placed(track: ImportedTrack, anchor: Anchor, every_s: int = 1) -> tuple[PlacedPoint, ...]:
    """Points of a track, the first of every ``every_s`` seconds.  Heights are left out: those of
    receivers are too inaccurate, and above another sea level, to tell a floor.
    """
    by_time = {point.t_ns // (every_s * NS_PER_S): point for point in reversed(track.points)}
    points = [by_time[bucket] for bucket in sorted(by_time)]
    north_m, east_m = anchor.plane_m(
        [point.lat_deg for point in points], [point.lon_deg for point in points]
    )
    return tuple(
        (to_ms(point.t_ns), round(north, 2), round(east, 2), point.floor)
        for point, north, east in zip(points, north_m, east_m, strict=True)
    )
