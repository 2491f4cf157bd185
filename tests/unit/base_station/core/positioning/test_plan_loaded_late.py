"""A plan loaded after satellites have placed people: their places on it are unknown yet."""

from __future__ import annotations

import math

import msgspec
import pytest

from base_station.core.events import Refused
from base_station.core.state import UnitState
from base_station.core.trust.trust import trust_of
from edge.simulation.building import plan_path
from shared.geo import Anchor, rotate
from shared.messages.pins import PlaceBeacon, SetMeeting, SetPin, StartTogether
from shared.messages.station import Action, OpenIncident, SetAnchor, SetPlan, SetStart
from tests.rig.round_walk import PLAN
from tests.rig.station_script import Script

A, B = "FF-01", "FF-02"
LIES = Anchor(52.0, 4.0, 20.0, math.radians(60.0))  # the plan, in no known place yet
ENGINE_M = -25.0, 15.0  # on the plan
TURNED_RAD = {A: 1.0, B: -2.0}  # of each own frame


class Outside(Script):
    """Two wearers walk outside with a receiver each."""

    def __init__(self) -> None:
        super().__init__()
        self.register(A, B)
        self.act(OpenIncident("i", "Mill Lane"))
        self.walked_m = 0.0

    def walk(self, metres: int) -> None:
        for _ in range(metres):
            self.now_s += 1.0
            self.walked_m += 1.0
            there_m = _walked(self.walked_m)
            for unit_id, turned_rad in TURNED_RAD.items():
                own_m = rotate(*there_m, turned_rad)
                self.position(unit_id, *own_m, distance_m=self.walked_m, heading_std_rad=0.02)
                lat_deg, lon_deg, height_m = LIES.to_geodetic(*_on_plan(there_m), 0.0)
                self.gps(unit_id, lat_deg, lon_deg, height_m=height_m, horizontal_std_m=2.0)
            self.tick()

    def unit(self, unit_id: str) -> UnitState:
        return self.pipeline.state.units[unit_id]

    def place_m(self, unit_id: str) -> tuple[float, float]:
        fused = self.unit(unit_id).place.fused
        assert fused is not None
        return fused.north_m, fused.east_m

    def why(self, unit_id: str) -> str:
        return trust_of(self.unit(unit_id), 0).reason

    def off_m(self, unit_id: str) -> float:
        return math.dist(self.place_m(unit_id), _on_plan(_walked(self.walked_m)))


def _walked(way_m: float) -> tuple[float, float]:
    """Steps north and east of the engine."""
    return (way_m, 0.0) if way_m < 20.0 else (20.0, way_m - 20.0)


def _on_plan(there_m: tuple[float, float]) -> tuple[float, float]:
    return ENGINE_M[0] + there_m[0], ENGINE_M[1] + there_m[1]


START = StartTogether("s", (A, B), 0, *ENGINE_M, 0.5, 0, None, 0.3, "")
ADRIFT = "the plan is not placed"


@pytest.fixture
def script() -> Outside:
    script = Outside()
    script.walk(30)
    script.act(SetPlan(PLAN))
    return script


def test_plan_without_a_known_place_is_not_used(script: Outside) -> None:
    assert script.why(A) == script.why(B) == ADRIFT
    anchor = script.pipeline.state.site.anchor
    assert anchor is not None
    earth = {one: anchor.to_geodetic(*script.place_m(one), 0.0)[:2] for one in (A, B)}
    script.act(SetAnchor(LIES.lat_deg, LIES.lon_deg, LIES.height_m, LIES.rotation_rad))
    assert script.why(A) == script.why(B) == ""
    for one in (A, B):
        assert LIES.to_geodetic(*script.place_m(one), 0.0)[:2] == pytest.approx(earth[one])
        assert script.off_m(one) < 3.0


def test_plan_without_a_place_locates_no_member_inside(script: Outside) -> None:
    elsewhere = b"[900,0],[940,0],[940,30],[900,30],[900,0]"
    script.act(SetPlan(PLAN.replace(b"[0,0],[40,0],[40,30],[0,30],[0,0]", elsewhere)))
    script.walk(1)
    assert script.unit(A).place.inside_since_ns is not None, "as without a plan: work has begun"
    script.act(SetAnchor(LIES.lat_deg, LIES.lon_deg, LIES.height_m, LIES.rotation_rad))
    script.walk(1)
    assert script.unit(A).place.inside_since_ns is None


def test_walls_of_a_plan_without_a_place_confine_no_member(script: Outside) -> None:
    script.act(SetPlan(plan_path().read_bytes()))
    begun = Outside()
    begun.act(SetPlan(plan_path().read_bytes()))
    for one in (script, begun):
        one.walk(1)
        fused = one.unit(A).place.fused
        assert fused is not None
        in_corridor = msgspec.structs.replace(fused, north_m=7.0, east_m=12.0, floor=0)
        one.unit(A).place.fused = in_corridor
        one.wait(15)
        assert (one.unit(A).place.reach == ()) is (one is script)


@pytest.mark.parametrize(
    "stated",
    [
        START,
        SetPin("p", A, 0, *ENGINE_M, 0.5, 0, None, 0.0, ""),
        SetStart(A, *ENGINE_M, 0.0, 0.0, 0.5, math.pi),
        PlaceBeacon("door", "", 0.0, 0.0, 0, 0.3, 3.0),
    ],
    ids=lambda stated: type(stated).__name__,
)
def test_first_place_on_a_plan_counts_from_the_beginning(stated: Action, script: Outside) -> None:
    earlier = Outside()
    earlier.act(SetPlan(PLAN))
    earlier.walk(30)
    for one in (script, earlier):
        assert not any(isinstance(output, Refused) for output in one.act(stated))
    for number in range(2):
        for unit_id in (A, B):
            mine, theirs = script.unit(unit_id).place.fused, earlier.unit(unit_id).place.fused
            assert mine is not None
            assert theirs is not None
            assert (mine.north_m, mine.east_m) == pytest.approx(
                (theirs.north_m, theirs.east_m), abs=0.01
            )
            assert mine.quality_reason == theirs.quality_reason
            assert script.unit(unit_id).gps is not None
        states = script.pipeline.state.site.pin_verdicts, earlier.pipeline.state.site.pin_verdicts
        assert states[0] == states[1]
        if not number:
            script.walk(5)
            earlier.walk(5)
    assert script.unit(A).rejected_counts.keys() == {"the site has no anchor"}


def test_trail_begins_at_the_start_position(script: Outside) -> None:
    script.act(START)
    trail = script.unit(A).trails.shown
    assert math.dist((trail[0].north_m, trail[0].east_m), ENGINE_M) < 1.5
    assert len(trail) > 10
    plain = script.unit(A).trails.unpinned
    assert plain is not None
    assert math.hypot(plain[0].north_m, plain[0].east_m) < 1.5, "about its own start, without"


def test_fixes_count_again_once_the_plan_has_an_anchor(script: Outside) -> None:
    script.act(START)
    script.act(SetAnchor(LIES.lat_deg, LIES.lon_deg, LIES.height_m, LIES.rotation_rad))
    script.walk(30)
    assert {verdict.state for verdict in script.pipeline.state.site.pin_verdicts.values()} == {
        "used"
    }
    assert script.off_m(A) < 3.0
    assert script.off_m(B) < 3.0


@pytest.mark.parametrize("met", [True, False], ids=["a meeting", "a pin that is refused"])
def test_action_without_a_place_leaves_people_at_their_fixes(met: bool, script: Outside) -> None:
    script.act(
        SetMeeting("m", A, B, script.t_ns, 1.0, "")
        if met
        else SetPin("p", A, script.t_ns, math.nan, 0.0, 0.5, None, None, 0.0, "")
    )
    assert script.pipeline.state.site.anchor_by_gps
    assert script.why(A) == ADRIFT


def test_place_set_before_the_plan_stays_on_the_earth() -> None:
    script = Outside()
    script.walk(30)
    script.act(SetPin("p", A, script.t_ns, *script.place_m(A), 0.5, None, None, 0.0, ""))
    script.act(SetPlan(PLAN))
    script.act(SetPin("q", B, script.t_ns, *script.place_m(B), 0.5, None, None, 0.0, ""))
    assert script.pipeline.state.site.anchor_by_gps
    assert script.why(A) == ADRIFT


def test_unit_with_satellites_only_has_no_place_on_it(script: Outside) -> None:
    script.register("FF-03")
    script.now_s += 1.0
    script.status("FF-03")
    script.gps("FF-03", *LIES.to_geodetic(*ENGINE_M, 0.0)[:2])
    assert script.unit("FF-03").place.fused is not None
    script.act(START)
    assert script.unit("FF-03").place.fused is None
