"""Selections of people and of a window of time from an incident's tracks."""

from __future__ import annotations

import pytest

from base_station.exporters.interface import IncidentTracks, WornTrack
from base_station.exporters.selection import TrackSelection
from base_station.storage.db.records import TrackSample
from shared.clock import NS_PER_S
from shared.errors import UserError

T0_NS = 1_700_000_000 * NS_PER_S


def points(count: int) -> tuple[TrackSample, ...]:
    return tuple(
        TrackSample(T0_NS + n * NS_PER_S, n, 0.0, 0.0, 0.1, 0.1, 0.1, 0.0, 0, "good")
        for n in range(count)
    )


INCIDENT = IncidentTracks(
    "i-1",
    "Mill",
    None,
    (
        WornTrack("FF-01", "Zoë Ärlig", "Engine 1", points(4)),
        WornTrack("FF-02", "Ada", "Engine 1", points(2)),
        WornTrack("FF-03", "", "", points(3)),
    ),
)


def units(selection: TrackSelection) -> list[str]:
    return [track.unit_id for track in selection.of(INCIDENT).tracks]


@pytest.mark.parametrize(
    ("names", "chosen"),
    [
        ((), ["FF-01", "FF-02", "FF-03"]),
        (("ff-03",), ["FF-03"]),
        (("zoë ärlig",), ["FF-01"]),
        (("Engine 1",), ["FF-01", "FF-02"]),
        (("Ada", "FF-03"), ["FF-02", "FF-03"]),
    ],
)
def test_units_people_and_crews_are_chosen_by_name(
    names: tuple[str, ...], chosen: list[str]
) -> None:
    assert units(TrackSelection(names)) == chosen


def test_points_outside_the_window_are_left_out() -> None:
    window = TrackSelection((), T0_NS + NS_PER_S, T0_NS + 3 * NS_PER_S)
    tracks = window.of(INCIDENT).tracks
    assert [[point.north_m for point in track.points] for track in tracks] == [[1, 2], [1], [1, 2]]


def test_unknown_name_is_refused_with_the_known_ones() -> None:
    with pytest.raises(UserError, match=r"'Bo' is no unit.*Ada \(FF-02\)"):
        TrackSelection(("Bo",)).of(INCIDENT)


def test_window_without_a_point_is_refused() -> None:
    with pytest.raises(UserError, match="has a track in that time"):
        TrackSelection((), 0, T0_NS).of(INCIDENT)


def test_incident_without_tracks_is_empty() -> None:
    empty = IncidentTracks("i-1", "Mill", None, ())
    assert list(TrackSelection().of(empty).tracks) == []
