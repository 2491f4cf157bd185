"""Corrected anchors: a wrong anchor of a person or a receiver leaves no effect once corrected."""

from __future__ import annotations

import math

import pytest

from base_station.core.positioning.frame import moved_to
from shared.geo import Anchor
from shared.messages.station import OpenIncident, SetAnchor
from tests.rig.round_walk import truth
from tests.rig.station_script import Script

U = "FF-01"
SITE = Anchor(52.0, 4.0, 10.0, 0.3)


def walk(script: Script, seconds: range, by: Anchor | None = SITE, std_m: float = 1.5) -> None:
    """A fix a second, where the anchor puts the plan; None: inside."""
    for second in seconds:
        script.now_s = float(second)
        north_m, east_m = truth(second)
        script.position(U, north_m, east_m, distance_m=float(second))
        if by is not None:
            lat_deg, lon_deg, height_m = by.to_geodetic(north_m, east_m, 0.0)
            script.gps(U, lat_deg, lon_deg, height_m=height_m, horizontal_std_m=std_m)
        script.tick()


def shown_m(script: Script) -> tuple[float, float, float]:
    fused = script.pipeline.state.units[U].place.fused
    assert fused is not None
    return fused.north_m, fused.east_m, fused.down_m


def anchored() -> Script:
    script = Script()
    script.register(U)
    script.act(OpenIncident("i1", "Mill Lane"))
    return script


def set_anchor(script: Script, anchor: Anchor) -> None:
    script.act(SetAnchor(anchor.lat_deg, anchor.lon_deg, anchor.height_m, anchor.rotation_rad))


@pytest.mark.slow
@pytest.mark.parametrize(
    "wrong",
    [
        Anchor(-52.0, 4.0, 10.0, 0.3),
        Anchor(52.0, -4.0, 10.0, 0.3),
        Anchor(4.0, 52.0, 10.0, 0.3),
        Anchor(52.3, 4.4, 10.0, 0.3),
        Anchor(52.001, 4.001, 400.0, 2.0),
    ],
    ids=["south", "west", "exchanged", "another town", "near, turned and high"],
)
def test_corrected_anchor_of_a_person_leaves_nothing_of_the_wrong_one(wrong: Anchor) -> None:
    script, right = anchored(), anchored()
    for one in (script, right):
        set_anchor(one, SITE)
        walk(one, range(100))
    set_anchor(script, wrong)
    walk(script, range(100, 120), by=None)
    walk(right, range(100, 120), by=None)
    set_anchor(script, SITE)
    for one in (script, right):
        walk(one, range(120, 130), by=None)
    assert math.dist(shown_m(script), shown_m(right)) < 0.5
    assert math.dist(shown_m(script)[:2], truth(129)) < 3.0
    trail = script.pipeline.state.units[U].trails.shown
    assert max(math.dist((0.0, 0.0), (step.north_m, step.east_m)) for step in trail) < 60.0


@pytest.mark.slow
@pytest.mark.parametrize("inside_s", [0, 10])
def test_several_wrong_anchors_in_turn_leave_nothing(inside_s: int) -> None:
    """Around a triangle on the Earth north comes back rotated: nobody on the plan is rotated
    by it.
    """
    script, right = anchored(), anchored()
    for one in (script, right):
        set_anchor(one, SITE)
        walk(one, range(100))
    for wrong in (Anchor(0.0, 0.0, 0.0), Anchor(-52.0, 4.0, 0.0), Anchor(4.0, 52.0, 0.0)):
        set_anchor(script, wrong)
        if inside_s:
            walk(script, range(round(script.now_s) + 1, round(script.now_s) + inside_s), by=None)
    walk(right, range(100, round(script.now_s) + 1), by=None)
    set_anchor(script, SITE)
    begin = round(script.now_s) + 1
    for one in (script, right):
        walk(one, range(begin, begin + 10), by=None)
    assert math.dist(shown_m(script), shown_m(right)) < 0.5


def test_units_anchored_on_the_other_hemisphere_are_placed_by_the_next_fixes() -> None:
    """The former frame is far away: no unit is shown at its place of that frame."""
    south = Anchor(-52.0, 4.0, 10.0, 0.0)
    script = anchored()
    walk(script, range(60), by=south)
    set_anchor(script, SITE)
    assert math.dist(shown_m(script)[:2], (0.0, 0.0)) < 100.0
    assert abs(shown_m(script)[2]) < 5.0
    walk(script, range(60, 75))
    assert math.dist(shown_m(script)[:2], truth(74)) < 5.0
    walk(script, range(75, 120))
    assert math.dist(shown_m(script), (*truth(119), 0.0)) < 3.0


@pytest.mark.parametrize("other", [Anchor(52.002, 4.003, 30.0, 1.0), Anchor(-40.0, 170.0, 0.0)])
def test_frame_moved_there_and_back_is_where_it_was(other: Anchor) -> None:
    there, back = moved_to(SITE, other), moved_to(other, SITE)
    north_m, east_m = there.apply(30.0, -70.0)
    assert back.apply(north_m, east_m) == pytest.approx((30.0, -70.0), abs=1e-3)
    assert there.down_m + back.down_m == pytest.approx(0.0, abs=1e-6)


def test_places_of_the_frame_stay_on_the_earth() -> None:
    other = Anchor(52.003, 3.998, 30.0, 1.0)
    move = moved_to(other, SITE)
    for north_m, east_m in ((0.0, 0.0), (80.0, -50.0)):
        place = SITE.to_geodetic(north_m, east_m, 0.0)
        expected = other.to_incident_m(*place)
        assert (*move.apply(north_m, east_m), move.down_m) == pytest.approx(expected, abs=0.03)


def test_anchor_on_the_other_hemisphere_moves_no_member() -> None:
    script = anchored()
    set_anchor(script, SITE)
    walk(script, range(100))
    set_anchor(script, Anchor(-SITE.lat_deg, SITE.lon_deg, SITE.height_m, SITE.rotation_rad))
    walk(script, range(100, 110), by=None)
    assert math.dist(shown_m(script)[:2], truth(109)) < 10.0
