"""GPX, read by another program's library."""

from __future__ import annotations

from datetime import UTC, datetime

import gpxpy
import pytest

from base_station.exporters.gpx import GPX
from base_station.exporters.interface import IncidentTracks, WornTrack
from base_station.storage.db.records import TrackSample
from shared.clock import NS_PER_S
from shared.geo import Anchor

T0_NS = 1_700_000_000 * NS_PER_S
ANCHOR = Anchor(52.0, 13.0, 40.0, rotation_rad=0.5)


def sample(second: int, north_m: float) -> TrackSample:
    t_ns = T0_NS + second * NS_PER_S
    return TrackSample(t_ns, north_m, 0.5, -1.5, 0.1, 0.1, 0.1, 0.0, 0, "good")


def test_each_person_is_a_track_and_a_gap_ends_a_segment() -> None:
    walked = (sample(0, 0.0), sample(1, 1.0), sample(60, 30.0), sample(61, 31.0))
    tracks = (
        WornTrack("FF-01", "Zoë <&> Ärlig", "A", walked),
        WornTrack("FF-02", "", "", walked[:2]),
    )
    read = gpxpy.parse(b"".join(GPX.export(IncidentTracks("i-1", "Mill", ANCHOR, tracks))).decode())
    assert [track.name for track in read.tracks] == ["Zoë <&> Ärlig (FF-01)", "FF-02"]
    assert [[len(part.points) for part in track.segments] for track in read.tracks] == [[2, 2], [2]]
    first = read.tracks[0].segments[0].points[0]
    lat_deg, lon_deg, height_m = ANCHOR.to_geodetic(0.0, 0.5, -1.5)
    assert (first.latitude, first.longitude) == pytest.approx((lat_deg, lon_deg), abs=1e-7)
    assert first.elevation == pytest.approx(height_m, abs=0.01)
    assert first.time == datetime.fromtimestamp(T0_NS / NS_PER_S, UTC)
