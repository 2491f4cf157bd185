"""Corrections of the past: markers, trails and every console follow, while the unit is received,
silent or backfilled; a replay and a restart give the same.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Callable
from copy import copy

import msgspec
import pytest

from base_station.core.events import Refused
from base_station.views.wire import TrailPoint
from shared.geo import Anchor
from shared.messages import Sighting, SightingKind
from shared.messages.pins import PlaceBeacon, RemoveBeacon, RemovePin, SetMeeting, SetPin
from shared.messages.station import (
    Action,
    Assign,
    CloseIncident,
    ForgetWearers,
    OpenIncident,
    RegisterUnit,
    SetAnchor,
    SetPlan,
    SetReference,
    SetStart,
)
from tests.rig.round_walk import Walk, truth
from tests.rig.station_script import START_NS, Script
from tests.rig.watched_pipeline import WatchedScript, apart_m

A, B = "FF-01", "FF-02"
WALKED_S = 70
PLAN = b"""{"type":"FeatureCollection","muster":{"frame":"site-m","floors":[
{"floor":2,"down_m":0},{"floor":3,"down_m":-3.2}]},
"features":[{"type":"Feature","properties":{"kind":"outline","floor":2},"geometry":
{"type":"Polygon","coordinates":[[[-9,-60],[90,-60],[90,60],[-9,60],[-9,-60]]]}}]}"""


class PinnedIncident(Walk):
    """Two units walk a round; they were pinned, met each other, and one passed a beacon."""

    script: WatchedScript

    def __init__(self) -> None:
        super().__init__(A, B, turn_rad=0.3, script=WatchedScript())
        for unit_id in (A, B):
            self.start(unit_id)
        self.script.act(SetAnchor(52.0, 4.0, 0.0, 0.0))
        self.script.act(PlaceBeacon("door", "", *truth(20.0), None, 0.3, 3.0))
        self.go(20)
        self.script.say(Sighting(self.script.header(A), SightingKind.BEACON, "door", 2.0))
        self.go(20)
        self.script.act(SetMeeting("met", A, B, self.script.t_ns, 1.0, ""))
        self.go(WALKED_S - 40)
        self.pin("of A", A, 60.0)
        self.pin("of B", B, 50.0)

    def go(self, seconds: int, silent: tuple[str, ...] = ()) -> None:
        for _ in range(seconds):
            super().go(1, silent)
            self.script.tick()

    def place_pin(self, pin_id: str, unit_id: str, second: float, floor: int | None) -> SetPin:
        t_ns = START_NS + round(second * 1e9)
        return SetPin(pin_id, unit_id, t_ns, *truth(second - 4.0), 0.5, floor, None, 0.0, "")


Change = Callable[[PinnedIncident], list[Action]]
CHANGES: dict[str, Change] = {
    "a pin is set": lambda s: [s.place_pin("new", A, 30.0, None)],
    "a pin with a floor is set": lambda s: [s.place_pin("new", A, 30.0, 3)],
    "the other is pinned to a floor": lambda s: [s.place_pin("new", B, 30.0, 3)],
    "a pin that contradicts is set": lambda s: [
        SetPin("bad", A, START_NS + 30 * 10**9, 300.0, 0.0, 0.5, None, None, 0.0, "")
    ],
    "a pin is moved": lambda s: [s.place_pin("of A", A, 60.0, None)],
    "a pin is moved to the other": lambda s: [s.place_pin("of A", B, 60.0, None)],
    "a pin is removed": lambda s: [RemovePin("of A")],
    "the other's pin is removed": lambda s: [RemovePin("of B")],
    "a meeting is removed": lambda s: [RemovePin("met")],
    "every pin is removed": lambda s: [RemovePin(one) for one in s.script.pipeline.state.site.pins],
    "a start is said": lambda s: [SetStart(A, 5.0, 5.0, -3.2, -0.5, 0.5, 0.05)],
    "a start is said of who has no pins": lambda s: [
        *(RemovePin(one) for one in s.script.pipeline.state.site.pins),
        SetStart(A, 5.0, 5.0, -3.2, -0.5, 0.5, 0.05),
    ],
    "the anchor is moved": lambda s: [SetAnchor(52.001, 4.001, 0.0, 0.1)],
    "a beacon is moved": lambda s: [PlaceBeacon("door", "", *truth(16.0), None, 0.3, 3.0)],
    "a beacon is removed": lambda s: [RemoveBeacon("door")],
    "a plan is loaded": lambda s: [SetPlan(PLAN)],
    "a reference barometer is named": lambda s: [SetReference(B, 0.0)],
    "a unit is renamed": lambda s: [RegisterUnit(A, "another")],
    "somebody else wears it": lambda s: [Assign(A, "p2", "Ada", "crew", "role")],
    "a new incident is opened": lambda s: [CloseIncident("i1"), OpenIncident("i2", "Next")],
    "somebody is forgotten": lambda s: [CloseIncident("i1"), ForgetWearers(A)],
    "whom somebody met is forgotten": lambda s: [CloseIncident("i1"), ForgetWearers(B)],
}


def sends_positions(incident: PinnedIncident) -> None:
    incident.go(5)


def is_silent(incident: PinnedIncident) -> None:
    incident.script.away.add(A)
    incident.go(40)


def is_backfilled(incident: PinnedIncident) -> None:
    """Half of the missed messages have come."""
    incident.script.away.add(A)
    incident.go(30)
    incident.script.away.clear()
    incident.go(2)
    incident.script.backfill(15)


CIRCUMSTANCES = (sends_positions, is_silent, is_backfilled)


@pytest.fixture(scope="module", params=CIRCUMSTANCES, ids=lambda one: one.__name__)
def walked(request: pytest.FixtureRequest) -> PinnedIncident:
    incident = PinnedIncident()
    request.param(incident)
    return incident


def changed_story(change: str, walked: PinnedIncident) -> PinnedIncident:
    incident = copy(walked)
    incident.script = walked.script.restarted()
    for action in CHANGES[change](incident):
        outputs = incident.script.act(action)
        assert not any(isinstance(one, Refused) for one in outputs), outputs
    return incident


@pytest.mark.slow
@pytest.mark.parametrize("change", CHANGES)
def test_markers_trails_and_consoles_follow(change: str, walked: PinnedIncident) -> None:
    script = changed_story(change, walked).script
    shown = markers(script)
    assert shown == markers(looked_at_again(script)), "at once, whoever is silent too"

    script.backfill(99)
    script.wait(15)
    mine, new = script.console, script.joined()
    assert mine.pins == new.pins
    assert mine.beacons == new.beacons
    for unit_id in (A, B):
        assert mine.units[unit_id].position == new.units[unit_id].position
        assert mine.units[unit_id].trust == new.units[unit_id].trust
        drawn, kept = mine.trails.get(unit_id, []), new.trails.get(unit_id, [])
        assert off_m(drawn, kept) < 1.5
        assert off_m(kept, drawn) < 1.5


def markers(script: Script) -> dict[str, tuple[object, ...]]:
    units = script.pipeline.state.units.values()
    return {
        unit.unit_id: (one.north_m, one.east_m, one.down_m, one.floor)
        for unit in units
        if (one := unit.place.fused) is not None
    }


def looked_at_again(script: WatchedScript) -> Script:
    """State of a station that starts from the checkpoint of this one: the same anchor changes only
    the places.
    """
    again = script.restarted()
    anchor = again.pipeline.state.site.anchor
    assert anchor is not None
    again.act(SetAnchor(anchor.lat_deg, anchor.lon_deg, anchor.height_m, anchor.rotation_rad))
    return again


def off_m(trail: list[TrailPoint], other: list[TrailPoint]) -> float:
    """Distance of a trail from another, at the same times."""
    worst_m = 0.0
    for point in trail:
        at = bisect_left(other, point.t_ms, key=lambda one: one.t_ms)
        near = other[max(at - 1, 0) : at + 1]
        worst_m = max(worst_m, min((apart_m(point, one) for one in near), default=math.inf))
    return worst_m


def both_gone_upstairs() -> WatchedScript:
    """Both climb three floors side by side, in a minute."""
    script = WatchedScript()
    script.register(A, B)
    script.act(OpenIncident("i1", "Mill Lane"))
    for second in range(60):
        script.now_s += 1.0
        down_m = -9.3 * min(max(second - 15, 0) / 20.0, 1.0)
        for unit_id in (A, B):
            script.position(unit_id, float(second), 0.0, down_m=down_m, distance_m=float(second))
        script.tick()
    return script


def test_floor_set_for_one_unit_holds_for_a_silent_one_there() -> None:
    script = both_gone_upstairs()
    walked_ns = script.t_ns
    script.wait(40)
    before = {unit_id: shown_floor(script, unit_id) for unit_id in (A, B)}
    script.act(SetPin("p", A, walked_ns, 59.0, 0.0, 1.0, 2, None, 0.0, "second floor"))
    after = {unit_id: shown_floor(script, unit_id) for unit_id in (A, B)}
    assert (before, after) == ({A: 3, B: 3}, {A: 2, B: 2})


def shown_floor(script: WatchedScript, unit_id: str) -> int | None:
    position = script.console.units[unit_id].position
    return None if position is None else position.floor


def test_waiting_pin_is_published_as_the_path_comes() -> None:
    """Used, contradicted, or of a time before the path."""
    script = WatchedScript()
    walk = Walk(A, B, script=script)
    walk.start(A)
    walk.go(20, silent=(B,))
    walk.go(20, silent=(A, B))
    north_m, east_m = truth(40.0)
    for pin_id, unit_id, off_m in (("good", A, 0.0), ("bad", A, 500.0), ("early", B, 0.0)):
        at = north_m + off_m, east_m
        script.act(SetPin(pin_id, unit_id, script.t_ns, *at, 1.0, None, None, 0.0, ""))
    assert [pin.state for pin in script.console.pins] == ["waiting"] * 3
    walk.go(61, silent=(B,))
    walk.go(1)
    pins = {pin.pin_id: pin for pin in script.console.pins}
    assert [pins[one].state for one in ("good", "bad", "early")] == ["used", "conflict", "waiting"]
    assert "begins 62 seconds later" in pins["early"].text


@pytest.mark.parametrize("unit_id", [A, B], ids=["with pins", "without"])
def test_start_set_late_corrects_the_whole_trail(unit_id: str) -> None:
    """The heading of the unit was unknown, and its start on the first floor."""
    script = WatchedScript()
    walk = Walk(unit_id, turn_rad=0.7, script=script)
    for _ in range(300):
        walk.go(1)
        script.tick()
    if unit_id == A:
        walk.pin("p", A, 295.0)
    script.act(SetPlan(PLAN))
    script.act(SetStart(unit_id, 0.0, 0.0, -3.2, -0.7, 0.5, 0.05))
    assert walk.worst_m(unit_id) < 9.0, "what its heading drifted"
    assert {step.floor for step in walk.trail(unit_id)} == {3}
    assert not script.pipeline.state.site.learnt_floors.buildings, "it was not there that it walked"
    assert off_m(script.console.trails[unit_id], script.joined().trails[unit_id]) == 0.0
    before = walk.trail(unit_id).copy()
    walk.go(20)
    assert walk.trail(unit_id)[: len(before)] == before


def test_erased_person_leaves_no_place() -> None:
    script = WatchedScript()
    walk = Walk(A, script=script)
    walk.start(A)
    walk.go(60)
    walk.pin("p", A, 50.0)
    state = script.pipeline.state
    assert len(walk.trail(A)) > 20
    assert A in state.site.learnt_floors.walks
    script.act(CloseIncident("i1"))
    script.act(ForgetWearers(A))
    unit = state.units[A]
    assert (unit.place.fused, unit.position, unit.trails.shown, unit.trails.unpinned) == (
        None,
        None,
        [],
        None,
    )
    assert A not in state.paths
    assert A not in state.site.learnt_floors.walks
    assert not script.joined().trails.get(A)


@pytest.mark.parametrize("unit_id", [A, B], ids=["with pins", "without"])
def test_start_may_be_anywhere_and_be_removed(unit_id: str) -> None:
    """The path without the pins has the same trail."""
    script = WatchedScript()
    walk = Walk(unit_id, turn_rad=0.7, script=script)
    walk.go(100)
    if unit_id == A:
        walk.pin("p", A, 95.0)
    for north_m, east_m in ((40.0, -30.0), (-15.0, 60.0)):
        script.act(SetStart(unit_id, north_m, east_m, 0.0, -0.7, 0.5, 0.05))
    if unit_id == A:
        script.act(RemovePin("p"))
    begin_ns = script.t_ns - 100 * 10**9
    assert len(walk.trail(unit_id)) > 40
    for step in walk.trail(unit_id):
        walked_m = truth((step.t_ns - begin_ns) / 1e9)
        place_m = step.north_m + 15.0, step.east_m - 60.0
        assert math.dist(place_m, walked_m) < 5.0, "what its heading drifted"


def test_backfilled_path_of_before_can_be_pinned() -> None:
    """The unit set out beyond the radio's range; the commander had reported its place."""
    script = WatchedScript()
    walk = Walk(A, script=script)
    script.away.add(A)
    for second in range(100):
        walk.go(1)
        script.tick()
        if second == 39:
            early = SetPin("early", A, script.t_ns, *truth(40.0), 0.5, None, None, 0.0, "")
            script.act(early)
    walk.start(A)
    script.away.clear()
    for _ in range(20):
        walk.go(1)
        script.tick()
    assert walk.state("early") == "waiting"
    assert script.console.pins[0].text.startswith("the path that is known begins 61 seconds later")
    for _ in range(20):
        walk.go(1)
        script.backfill(10)
        script.tick()
    assert walk.state("early") == "used"
    walk.pin("late", A, 20.0)
    assert walk.state("late") == "used"
    assert walk.worst_m(A, end_s=40.0) < 2.0
    assert {pin.state for pin in script.console.pins} == {"used"}


@pytest.mark.slow
def test_corrected_anchor_moves_units_placed_by_satellites() -> None:
    """A unit that went inside and is silent since, too; one that a person placed on the plan
    stays.
    """
    true, wrong = Anchor(52.0, 4.0, 0.0, 0.0), Anchor(52.001, 4.0005, 0.0, 0.3)
    script = WatchedScript()
    script.register(A, B)
    script.act(OpenIncident("i1", "Mill Lane"))
    script.act(SetStart(B, 0.0, 5.0, 0.0, 0.0, 0.5, 0.05))
    script.act(SetAnchor(wrong.lat_deg, wrong.lon_deg, 0.0, wrong.rotation_rad))
    for second in range(400):
        script.now_s += 1.0
        for unit_id in (A, B):
            script.position(unit_id, float(second), 0.0, distance_m=float(second))
        lat_deg, lon_deg, _ = true.to_geodetic(float(second), 0.0, 0.0)
        if second < 390:
            script.gps(A, lat_deg, lon_deg, horizontal_std_m=2.0)
        script.tick()
    script.wait(20)
    assert distance_m(script, A, (399.0, 0.0)) > 100.0
    script.act(SetAnchor(true.lat_deg, true.lon_deg, 0.0, 0.0))
    script.wait(5)
    assert distance_m(script, A, (399.0, 0.0)) < 4.0
    assert distance_m(script, B, (399.0, 5.0)) < 0.1
    for unit_id, east_m in ((A, 0.0), (B, 5.0)):
        trail = script.console.trails[unit_id]
        assert max(abs(point.east_m - east_m) for point in trail) < 4.0
        assert (trail[0].north_m, trail[-1].north_m) == pytest.approx((0.0, 399.0), abs=5.0)


def distance_m(script: WatchedScript, unit_id: str, place_m: tuple[float, float]) -> float:
    position = script.console.units[unit_id].position
    assert position is not None
    return math.dist((position.north_m, position.east_m), place_m)


@pytest.mark.slow
def test_plan_with_other_storeys_renumbers_trails() -> None:
    """Trails of units without pins too, received or silent; pinned trails as without pins."""
    incident = PinnedIncident()
    incident.script.act(RemovePin("met"))
    incident.script.act(RemovePin("of B"))
    incident.script.away.add(B)
    incident.go(5)
    before = incident.script.pipeline.state.units[B].trails.shown[:]
    assert before[-1].floor == 0
    incident.script.act(SetPlan(PLAN))
    incident.script.wait(8)
    units = incident.script.pipeline.state.units
    assert [step.floor for step in units[B].trails.shown] == [2] * len(before)
    assert [msgspec.structs.replace(step, floor=2) for step in before] == units[B].trails.shown
    assert {point.floor for point in incident.script.console.trails[B]} == {2}
    plain = units[A].trails.unpinned
    assert plain is not None
    assert {step.floor for step in (*plain, *units[A].trails.shown)} == {2}


def test_floor_of_one_unit_renumbers_the_trail_of_another() -> None:
    script = both_gone_upstairs()
    upstairs_ns = script.t_ns - 15 * 10**9
    state = script.pipeline.state
    reported = {step.floor for step in state.units[B].trails.shown if step.t_ns > upstairs_ns}
    assert reported == {3}
    script.act(SetPin("p", A, script.t_ns, 59.0, 0.0, 0.5, 4, None, 0.0, ""))
    script.wait(5)
    assert {step.floor for step in state.units[B].trails.shown if step.t_ns > upstairs_ns} == {4}
    drawn = script.console.trails[B]
    assert {point.floor for point in drawn if point.t_ms > upstairs_ns // 10**6} == {4}
