"""Impossible fixes are rejected with a reason, and move nobody."""

from __future__ import annotations

import math
from itertools import pairwise

import msgspec
import pytest

from base_station.fusion.building_model.building import LearntBuilding
from base_station.fusion.building_model.stairs import LearntStairs
from base_station.fusion.building_model.straight_segments import Axis
from base_station.fusion.gnss.screening import in_incident_frame, may_anchor, screen_fix
from base_station.fusion.interface import FixVerdict, PlaceFix
from shared.channels import GPS, backfilled_key
from shared.clock import NS_PER_S
from shared.codec import encode
from shared.geo import Anchor
from shared.messages import FixType, GpsFix, Header
from shared.messages.pins import PlaceBeacon, SetPin
from shared.messages.station import OpenIncident, SetAnchor, SetPlan, SetStart
from tests.rig import message_factory
from tests.rig.station_script import Script

U = "FF-01"
ANCHOR = Anchor(52.0, 4.0, 10.0)
NORTH_M_PER_DEG = 111_267.0  # at 52 degrees
PLAN = b'{"type":"FeatureCollection","muster":{"frame":"site-m"},"features":[]}'


def fix(**changes: object) -> GpsFix:
    usual = message_factory.gps_fix(Header(U, 1, 1, 0), 52.0001, 4.0001, height_m=10.0)
    return msgspec.structs.replace(usual, **changes)


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"fix_type": FixType.NONE}, "no fix"),
        ({"fix_type": FixType.UNKNOWN}, "no fix"),
        ({"lat_deg": 0.0, "lon_deg": 0.0}, "latitude and longitude 0"),
        ({"lat_deg": 91.0}, "not on the Earth"),
        ({"lon_deg": -181.0}, "not on the Earth"),
        ({"lat_deg": math.nan}, "no numbers"),
        ({"height_m": math.inf}, "no numbers"),
        ({"height_m": -1_001.0}, "nobody stands"),
        ({"height_m": 10_001.0}, "nobody stands"),
        ({"horizontal_std_m": 0.0}, "accuracy"),
        ({"horizontal_std_m": 100.1}, "accuracy"),
        ({"horizontal_std_m": math.nan}, "accuracy"),
    ],
)
def test_fix_that_contradicts_itself_is_faulty(changes: dict[str, object], reason: str) -> None:
    verdict = screen_fix(fix(**changes))
    assert not verdict.accepted
    assert reason in verdict.reason


@pytest.mark.parametrize(
    "changes",
    [
        {"lat_deg": 51.48, "lon_deg": 0.0},
        {"lat_deg": 0.0, "lon_deg": 9.45},
        {"lat_deg": 90.0, "lon_deg": -180.0},
        {"fix_type": FixType.TWO_D},
        {"fix_type": FixType.TWO_D, "height_m": -9_999.0},
        {"height_m": -430.0},
        {"height_m": 8_850.0},
        {"horizontal_std_m": None},
        {"horizontal_std_m": 0.02},
        {"horizontal_std_m": 100.0},
    ],
)
def test_unusual_values_are_no_reason(changes: dict[str, object]) -> None:
    assert screen_fix(fix(**changes)) == FixVerdict(True)


def test_fix_fifty_kilometres_away_is_not_at_the_site() -> None:
    for away_km, is_there in ((49.5, True), (50.5, False)):
        seen = fix(lat_deg=ANCHOR.lat_deg + 1e3 * away_km / NORTH_M_PER_DEG)
        assert isinstance(in_incident_frame(seen, ANCHOR), PlaceFix) is is_there


@pytest.mark.parametrize(
    ("changes", "may"),
    [
        ({"horizontal_std_m": 8.0}, True),
        ({"horizontal_std_m": 8.1}, False),
        ({"horizontal_std_m": None}, False),
        ({"fix_type": FixType.TWO_D}, False),
    ],
)
def test_only_a_good_fix_with_a_height_may_place_the_site(
    changes: dict[str, object], may: bool
) -> None:
    assert may_anchor(fix(**changes)) is may


def test_good_fix_passes_with_its_place() -> None:
    assert screen_fix(fix()).accepted
    place = in_incident_frame(fix(), ANCHOR)
    assert isinstance(place, PlaceFix)
    assert place.north_m == pytest.approx(11.13, abs=0.01)
    assert place.east_m == pytest.approx(6.86, abs=0.01)
    assert place.down_m == pytest.approx(0.0, abs=0.01)


def test_wrong_hemisphere_is_too_far() -> None:
    verdict = in_incident_frame(fix(lat_deg=-52.0), ANCHOR)
    assert isinstance(verdict, FixVerdict)
    assert not verdict.accepted
    assert "too far" in verdict.reason


def test_accuracy_of_centimetres_is_not_accepted() -> None:
    place = in_incident_frame(fix(horizontal_std_m=0.01), ANCHOR)
    assert isinstance(place, PlaceFix)
    assert place.horizontal_std_m >= 1.0


@pytest.mark.parametrize(("vertical_std_m", "taken_m"), [(4.0, 4.0), (None, 5.0)])
def test_fix_counts_with_its_stated_accuracy(vertical_std_m: float | None, taken_m: float) -> None:
    place = in_incident_frame(fix(horizontal_std_m=2.5, vertical_std_m=vertical_std_m), ANCHOR)
    assert isinstance(place, PlaceFix)
    assert (place.horizontal_std_m, place.vertical_std_m) == (2.5, taken_m)


def test_missing_accuracy_counts_as_poor() -> None:
    place = in_incident_frame(fix(horizontal_std_m=None, vertical_std_m=None), ANCHOR)
    assert isinstance(place, PlaceFix)
    assert place.horizontal_std_m >= 10.0
    assert not may_anchor(fix(horizontal_std_m=None))


def test_fix_without_height_leaves_the_height_as_it_is() -> None:
    place = in_incident_frame(fix(fix_type=FixType.TWO_D), ANCHOR)
    assert isinstance(place, PlaceFix)
    assert place.vertical_std_m is None


@pytest.fixture
def script() -> Script:
    script = Script()
    script.register(U)
    return script


def not_used(script: Script) -> dict[str, int]:
    return script.pipeline.state.units[U].rejected_counts


def test_fix_from_the_future_is_refused(script: Script) -> None:
    script.act(SetAnchor(52.0, 4.0, 10.0, 0.0))
    script.wait(5, lambda: script.position(U, 0.0, 0.0))
    script.gps(U, 52.0, 4.0, header=script.header(U, captured_s=script.now_s + 3600.0))
    assert not_used(script) == {"from the future": 1}
    assert script.fused[-1].since_gps_s is None


@pytest.mark.parametrize(
    ("wrong", "reason"),
    [
        ({"lat_deg": 0.0, "lon_deg": 0.0}, "latitude and longitude 0"),
        ({"lat_deg": 48.0}, "too far from the site"),
        ({"horizontal_std_m": 5000.0}, "an accuracy that cannot be used"),
    ],
)
def test_wrong_receiver_is_reported_until_it_is_right(
    script: Script, wrong: dict[str, float], reason: str
) -> None:
    def send_fix(fix: dict[str, float]) -> None:
        script.position(U, 0.0, 0.0)
        script.gps(U, **{"lat_deg": 52.0, "lon_deg": 4.0} | fix)

    def gps_alarms() -> list[tuple[str, str]]:
        return [(one.state.name, one.text) for one in script.alarms if one.rule == "gps-unused"]

    script.act(SetAnchor(52.0, 4.0, 10.0, 0.0))
    script.wait(5, lambda: send_fix({}))
    for _ in range(3):  # receivers have such errors now and then
        script.wait(20, lambda: send_fix(wrong))
        script.wait(5, lambda: send_fix({}))
    assert gps_alarms() == []
    script.wait(31, lambda: send_fix(wrong))
    script.wait(60, lambda: script.position(U, 0.0, 0.0))
    reported = f"unit {U}: GPS is not used ({reason})"
    assert gps_alarms() == [("RAISED", reported)]
    script.wait(5, lambda: send_fix({}))
    assert gps_alarms()[1:] == [("RESOLVED", reported)]


def test_rejected_fixes_are_counted_again_in_another_incident(script: Script) -> None:
    script.act(SetAnchor(52.0, 4.0, 10.0, 0.0))
    script.wait(2, lambda: script.position(U, 0.0, 0.0))
    script.gps(U, 0.0, 0.0)
    assert not_used(script) == {"latitude and longitude 0": 1}
    script.act(OpenIncident("i1", "Mill Lane"))
    assert not_used(script) == {}


@pytest.mark.parametrize("wrong", [{"fix_type": FixType.NONE}, {"lat_deg": 52.002}])
def test_missing_fix_indoors_and_one_off_a_wall_are_no_alarm(
    script: Script, wrong: dict[str, float]
) -> None:
    script.act(SetAnchor(52.0, 4.0, 10.0, 0.0))
    for second in range(60):
        script.now_s += 1.0
        script.position(U, 0.0, 0.0)
        script.gps(U, **{"lat_deg": 52.0, "lon_deg": 4.0} | (wrong if second > 5 else {}))
        script.tick()
    gps = script.pipeline.state.units[U].gps
    assert gps is not None
    assert gps.reason
    assert [one for one in script.alarms if one.rule == "gps-unused"] == []


def test_fix_before_any_message_of_its_unit_may_be_of_the_future(script: Script) -> None:
    """Its clock is unknown yet: a used fix would make all later ones old for an hour."""
    script.act(SetAnchor(52.0, 4.0, 10.0, 0.0))
    script.gps(U, 52.0, 4.0, header=script.header(U, captured_s=script.now_s + 3600.0))
    script.wait(5, lambda: script.position(U, 0.0, 0.0))
    script.gps(U, 52.0, 4.0)
    script.wait(20, lambda: script.position(U, 0.0, 0.0))
    assert not_used(script) == {"of a time that no other message has placed yet": 1}
    assert script.fused[-1].since_gps_s == 20.0


def test_bad_fixes_are_counted_by_reason_and_cause_no_jump(script: Script) -> None:
    script.act(SetAnchor(52.0, 4.0, 10.0, 0.0))
    for _ in range(30):
        script.wait(1, lambda: script.position(U, 0.0, 0.0))
        script.gps(U, 52.0, 4.0)
    before = script.fused[-1]
    for bad in ({"lat_deg": 0.0, "lon_deg": 0.0}, {"lat_deg": -52.0}, {"horizontal_std_m": 900.0}):
        script.gps(U, **{"lat_deg": 52.0, "lon_deg": 4.0, **bad})
    script.gps(U, 52.002, 4.0)
    script.wait(1, lambda: script.position(U, 0.0, 0.0))
    after = script.fused[-1]
    assert math.dist((before.north_m, before.east_m), (after.north_m, after.east_m)) < 0.1
    assert sorted(not_used(script).values()) == [1, 1, 1, 1]


def test_fix_of_an_earlier_run_belongs_to_no_path(script: Script) -> None:
    script.act(SetAnchor(52.0, 4.0, 10.0, 0.0))
    script.position(U, 0.0, 0.0)
    late = message_factory.gps_fix(script.header(U), 52.0, 4.0)
    script.boot_ids[U] = 8
    script.wait(3, lambda: script.position(U, 0.0, 0.0))
    script.record(backfilled_key(U, GPS.suffix), encode(late))
    assert not_used(script) == {"from an earlier run of the unit": 1}
    assert script.fused[-1].since_gps_s is None


@pytest.mark.parametrize(
    "stated_by_hand", [SetPlan(PLAN), SetStart(U, 5.0, 7.0, 0.0, 0.0, 0.1, 0.0)]
)
def test_fix_does_not_move_a_frame_placed_by_a_person(
    script: Script, stated_by_hand: SetPlan | SetStart
) -> None:
    script.act(stated_by_hand)
    script.position(U, 0.0, 0.0)
    script.gps(U, 52.0, 4.0)
    assert script.pipeline.state.site.anchor is None
    assert not_used(script) == {"the site has no anchor": 1}


def test_positions_work_in_metres_without_an_anchor(script: Script) -> None:
    script.act(SetPlan(PLAN))
    script.act(SetStart(U, 5.0, 7.0, 0.0, 0.0, 0.1, 0.0))
    script.wait(3, lambda: script.position(U, 2.0, 0.0))
    script.gps(U, 52.0, 4.0)
    assert (script.fused[-1].north_m, script.fused[-1].east_m) == pytest.approx((7.0, 7.0))
    assert script.pipeline.state.site.anchor is None
    assert not_used(script) == {"the site has no anchor": 1}


def test_first_good_fix_anchors_an_unplaced_site_and_moves_no_member(
    script: Script,
) -> None:
    script.wait(3, lambda: script.position(U, 2.0, 1.0))
    before = script.fused[-1]
    script.gps(U, 52.0, 4.0, horizontal_std_m=40.0)
    assert not_used(script) == {"the site has no anchor": 1}, "a poor fix places no site"
    script.gps(U, 52.0, 4.0)
    anchor = script.pipeline.state.site.anchor
    assert anchor is not None
    assert anchor.to_incident_m(52.0, 4.0, 50.0)[:2] == pytest.approx((2.0, 1.0), abs=1e-6)
    after = script.fused[-1]
    assert (after.north_m, after.east_m) == pytest.approx((before.north_m, before.east_m), abs=0.01)


def test_first_fix_from_elsewhere_does_not_exclude_all_others(script: Script) -> None:
    """A receiver that starts with a place on the other side of the Earth has placed the site
    there.
    """
    script.position(U, 0.0, 0.0)
    script.gps(U, -52.0, 4.0)
    shown_m = []
    for second in range(60):
        script.now_s += 1.0
        north_m = 1.2 * second
        script.position(U, north_m, 0.0, distance_m=north_m)
        script.gps(U, 52.0 + north_m / NORTH_M_PER_DEG, 4.0)
        shown_m.append((script.fused[-1].north_m, script.fused[-1].east_m))
    assert max(math.dist(*pair) for pair in pairwise(shown_m)) < 5.0
    anchor = script.pipeline.state.site.anchor
    assert anchor is not None
    off_m = anchor.to_incident_m(52.0 + north_m / NORTH_M_PER_DEG, 4.0, 50.0)[:2]
    assert off_m == pytest.approx(shown_m[-1], abs=3.0)
    assert not_used(script)["too far from the site"] == 10


def test_wrong_receiver_does_not_move_the_site_of_right_ones(
    script: Script,
) -> None:
    script.register("FF-02")
    for second in range(30):
        script.now_s += 1.0
        for unit_id, lat_deg in ((U, 52.0), ("FF-02", 55.0)):
            script.position(unit_id, 0.0, 0.0)
            script.gps(unit_id, lat_deg + second * 1e-7, 4.0)
    anchor = script.pipeline.state.site.anchor
    assert anchor is not None
    assert anchor.lat_deg == pytest.approx(52.0, abs=1e-3)


def test_fixes_too_poor_to_place_the_site_do_not_move_it(script: Script) -> None:
    for second in range(30):
        script.now_s += 1.0
        script.position(U, 0.0, 0.0)
        std_m = 3.0 if second == 0 else 50.0
        lat_deg = 52.0 if second == 0 else 55.0
        script.gps(U, lat_deg + second * 1e-7, 4.0, horizontal_std_m=std_m)
    anchor = script.pipeline.state.site.anchor
    assert anchor is not None
    assert anchor.lat_deg == pytest.approx(52.0, abs=1e-3)


def test_site_placed_by_a_person_stays(script: Script) -> None:
    script.act(SetAnchor(52.0, 4.0, 10.0, 0.0))
    for _ in range(30):
        script.wait(1, lambda: script.position(U, 0.0, 0.0))
        script.gps(U, -52.0, 4.0)
    assert script.pipeline.state.site.anchor == Anchor(52.0, 4.0, 10.0, 0.0)
    assert not_used(script) == {"too far from the site": 30}


def walk_a_minute(script: Script) -> None:
    """North at 1.2 m/s, with a fix a second."""
    for second in range(60):
        script.now_s += 1.0
        script.position(U, 1.2 * second, 0.0, distance_m=1.2 * second)
        script.gps(U, 52.0 + 1.2 * second / NORTH_M_PER_DEG, 4.0)


def test_late_anchor_keeps_everyone_on_the_earth(script: Script) -> None:
    """The frame moves under people, not people over the Earth; trails move with them."""
    script.act(OpenIncident("i1", "Mill Lane"))
    walk_a_minute(script)
    old = script.pipeline.state.site.anchor
    before, trail = script.fused[-1], list(script.pipeline.state.units[U].trails.shown)
    assert old is not None
    script.act(SetAnchor(52.0003, 4.0004, 20.0, 0.8))
    script.position(U, 1.2 * 59, 0.0, distance_m=1.2 * 59)
    new, after = script.pipeline.state.site.anchor, script.fused[-1]
    assert new is not None
    was = old.to_geodetic(before.north_m, before.east_m, before.down_m)
    now = new.to_geodetic(after.north_m, after.east_m, after.down_m)
    assert now[:2] == pytest.approx(was[:2], abs=2e-8)
    step, moved = trail[20], script.pipeline.state.units[U].trails.shown[20]
    assert new.to_geodetic(moved.north_m, moved.east_m, 0.0)[:2] == pytest.approx(
        old.to_geodetic(step.north_m, step.east_m, 0.0)[:2], abs=2e-8
    )


def test_learnt_building_stays_on_the_earth(script: Script) -> None:
    """Its stairs, the direction of its walls, its storeys; and a beacon in it."""
    walk_a_minute(script)
    state = script.pipeline.state
    stairs = LearntStairs(30.0, 4.0, (1.0, 0.0, 1.0), 0.0, -3.0, turns=True)
    state.site.learnt_building = (
        LearntBuilding().with_stairs(-1, U, stairs).with_axis(U, Axis(0.1, 1e-3))
    )
    script.act(PlaceBeacon("b", "door", 30.0, 4.0, None, 0.5, 3.0))
    old, storeys = state.site.anchor, state.site.storeys_at(30.0, 4.0)
    assert old is not None
    assert storeys
    script.act(SetAnchor(52.0003, 4.0004, 20.0, 0.3))
    new = state.site.anchor
    assert new is not None
    north_m, east_m, lower_m = new.to_incident_m(*old.to_geodetic(30.0, 4.0, 0.0))
    assert abs(lower_m) > 10.0
    found, beacon = state.site.learnt_building.stairs[0].mean, state.site.beacons["b"]
    assert (found.north_m, found.east_m) == pytest.approx((north_m, east_m), abs=0.05)
    assert (beacon.north_m, beacon.east_m) == pytest.approx((north_m, east_m), abs=0.05)
    assert state.site.learnt_building.axis is not None
    assert state.site.learnt_building.axis.direction_rad == pytest.approx(0.1 - 0.3, abs=1e-3)
    moved = state.site.storeys_at(north_m, east_m)
    assert [one.floor for one in moved] == [one.floor for one in storeys]
    expected_m = [one.down_m + lower_m for one in storeys]
    assert [one.down_m for one in moved] == pytest.approx(expected_m, abs=0.05)


def test_pin_after_the_frame_was_moved_refers_to_the_present_plan(script: Script) -> None:
    """The path that is solved again was walked before: all of it stays in place on the Earth."""
    script.act(OpenIncident("i1", "Mill Lane"))
    walk_a_minute(script)
    new = Anchor(52.0003, 4.0004, 20.0, 0.8)
    script.act(SetAnchor(new.lat_deg, new.lon_deg, new.height_m, new.rotation_rad))
    begin_ns = script.t_ns - 59 * NS_PER_S

    def truth_m(second: float) -> tuple[float, float]:
        return new.to_incident_m(52.0 + 1.2 * second / NORTH_M_PER_DEG, 4.0, 50.0)[:2]

    script.act(SetPin("p", U, begin_ns + 30 * NS_PER_S, *truth_m(30.0), 0.5, None, None, 0.0, ""))
    state = script.pipeline.state
    assert state.site.pin_verdicts["p"].state == "used"
    for step in state.units[U].trails.shown:
        true_m = truth_m((step.t_ns - begin_ns) / NS_PER_S)
        assert math.dist((step.north_m, step.east_m), true_m) < 3.0
