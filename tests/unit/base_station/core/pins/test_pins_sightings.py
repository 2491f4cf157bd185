"""Sightings by a unit as pins: beacons, tags and other units."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import pytest

from base_station.core.events import PinsChanged, TrailBackfilled
from base_station.core.pins.evidence import reported_floors
from base_station.fusion.odometry.path_history import PathHistory
from base_station.fusion.odometry.points import PathArrays
from base_station.fusion.smoothing.interface import EncounterConstraint, Solution, UnitEvidence
from base_station.fusion.smoothing.path_graph import PathGraph
from base_station.storage.db.known_people import person_lookup
from base_station.views.station import pin_views
from shared.channels import SIGHTING, backfilled_key
from shared.clock import NS_PER_S
from shared.codec import encode
from shared.messages import Sighting, SightingKind
from shared.messages.pins import (
    PlaceBeacon,
    RemoveBeacon,
    RemovePin,
    SetMeeting,
)
from tests.rig.round_walk import Walk, truth, walk_from_the_engine


@pytest.fixture
def walk() -> Walk:
    return walk_from_the_engine()


def sighting(
    walk: Walk,
    kind: SightingKind,
    seen_id: str,
    range_m: float | None = None,
    captured_s: float | None = None,
) -> None:
    header = walk.script.header("FF-01", captured_s)
    walk.script.say(Sighting(header, kind, seen_id, range_m))


def test_beacon_counts_once_it_is_placed_and_moves_with_it(walk: Walk) -> None:
    sighting(walk, SightingKind.TAG, "door-3")
    (pin,) = walk.script.pipeline.state.site.pins.values()
    assert walk.state(pin.pin_id) == "waiting"
    before_m = walk.now_off_m("FF-01")
    north_m, east_m = truth(walk.walked_s)
    walk.script.act(PlaceBeacon("door-3", "door", north_m, east_m, None, 0.2, 0.5))
    assert walk.state(pin.pin_id) == "used"
    assert walk.now_off_m("FF-01") < 1.0 < before_m
    sighting(walk, SightingKind.TAG, "door-3")
    sighting(walk, SightingKind.TAG, "door-3", captured_s=walk.script.now_s - 60.0)  # received late
    walk.script.act(PlaceBeacon("door-3", "front door", north_m, east_m, None, 0.2, 0.5))
    assert walk.script.pipeline.state.site.beacons["door-3"].seen_ns == walk.script.t_ns
    walk.script.act(RemoveBeacon("door-3"))
    assert walk.state(pin.pin_id) == "waiting"
    assert walk.now_off_m("FF-01") == before_m


def test_radio_beacon_placed_later_counts_for_units_that_passed_it(walk: Walk) -> None:
    sighting(walk, SightingKind.BEACON, "b1", 0.5)
    (pin,) = walk.script.pipeline.state.site.pins
    assert walk.state(pin) == "waiting"
    walk.script.act(PlaceBeacon("b1", "door", *truth(walk.walked_s), None, 0.2, 3.0))
    assert walk.state(pin) == "used"


def test_sighting_before_its_beacon_was_placed_counts_once_it_is(
    walk: Walk,
) -> None:
    sighting(walk, SightingKind.BEACON, "b1")
    sighting(walk, SightingKind.BEACON, "b2", 4.0)
    for reach_m in (30.0, 12.0):
        for beacon_id in ("b1", "b2"):
            walk.script.act(PlaceBeacon(beacon_id, "mast", 0.0, 0.0, None, 0.2, reach_m))
        somewhere, ranged = walk.script.pipeline.state.site.pins.values()
        assert somewhere.std_m == reach_m / 2.0
        assert ranged.std_m == pytest.approx(math.hypot(4.0 / math.sqrt(2.0), 0.5))


def test_beacon_passed_without_contact_counts_once_backfilled(
    walk: Walk,
) -> None:
    script, passed_s = walk.script, walk.walked_s - 100
    script.act(PlaceBeacon("b1", "door", *truth(passed_s), None, 0.2, 3.0))
    before_m = walk.worst_m("FF-01")
    seen = Sighting(script.header("FF-01", float(passed_s)), SightingKind.BEACON, "b1", 0.5)
    script.record(backfilled_key("FF-01", SIGHTING.suffix), encode(seen))
    (pin,) = script.pipeline.state.site.pins.values()
    assert walk.state(pin.pin_id) == "used"
    assert pin.t_ns == script.t_ns - 100 * 10**9
    assert walk.worst_m("FF-01") < 0.7 * before_m


def test_stay_near_a_beacon_is_one_pass(walk: Walk) -> None:
    for range_m in (8.0, 3.0, 1.0, 5.0):
        sighting(walk, SightingKind.BEACON, "b1", range_m)
        walk.go(2)
    (pin,) = walk.script.pipeline.state.site.pins.values()
    assert pin.std_m == pytest.approx(math.hypot(1.0 / math.sqrt(2.0), 0.5))
    walk.go(30)
    sighting(walk, SightingKind.BEACON, "b1", 4.0)
    assert len(walk.script.pipeline.state.site.pins) == 2


def test_backfilled_sightings_are_solved_now_and_then(walk: Walk) -> None:
    """Each solves a whole past, and live messages wait for it."""
    script, begin_s = walk.script, walk.script.now_s - walk.walked_s
    script.act(PlaceBeacon("door", "", *truth(10.0), None, 0.3, 3.0))
    begun = len(script.outputs)
    for number in range(30):
        header = script.header("FF-01", begin_s + 10.0 * number)
        sighting = Sighting(header, SightingKind.BEACON, "door", 2.0)
        script.now_s += 0.01
        script.record(backfilled_key("FF-01", SIGHTING.suffix), encode(sighting))
    reported = script.outputs[begun:]
    assert sum(isinstance(one, TrailBackfilled) for one in reported) <= 1
    assert (
        sum(isinstance(one, PinsChanged) for one in reported)
        == len(script.pipeline.state.site.pins)
        > 9
    )
    script.wait(4)
    reported = script.outputs[begun:]
    assert sum(isinstance(one, TrailBackfilled) for one in reported) <= 2
    assert "waiting" not in {walk.state(one) for one in script.pipeline.state.site.pins}


def test_sighting_of_an_unknown_tag_is_counted_and_changes_nothing(walk: Walk) -> None:
    sighting(walk, SightingKind.UNIT, "stranger")
    sighting(walk, SightingKind.UNIT, "FF-01")
    sighting(walk, SightingKind.UNKNOWN, "x")
    sighting(walk, SightingKind.BEACON, "far", 5000.0)
    sighting(walk, SightingKind.BEACON, "", 1.0)
    assert walk.script.pipeline.state.site.pins == {}
    assert sum(walk.script.pipeline.state.units["FF-01"].rejected_counts.values()) == 5


def test_sighting_of_an_unregistered_unit_is_not_used(walk: Walk) -> None:
    script = walk.script
    for kind, seen_id in ((SightingKind.UNIT, "FF-01"), (SightingKind.BEACON, "b1")):
        script.say(Sighting(script.header("stranger"), kind, seen_id, 1.0))
    assert script.pipeline.state.site.pins == {}


def test_mutual_sightings_are_one_encounter() -> None:
    both = Walk("FF-01", "FF-02")
    both.go(10)
    sighting(both, SightingKind.UNIT, "FF-02", 2.0)
    other = both.script.header("FF-02")
    both.script.say(Sighting(other, SightingKind.UNIT, "FF-01", 1.0))
    state = both.script.pipeline.state
    (pin,) = state.site.pins.values()
    assert pin.unit_id == "FF-02", "the nearer of the two"
    assert state.site.pin_verdicts.keys() == state.site.pins.keys()


@pytest.mark.parametrize("range_m", [1.0, 30.0], ids=["surer", "vaguer"])
def test_encounter_set_by_a_person_is_not_replaced_by_sightings(range_m: float) -> None:
    """Nor are the sightings lost when it is removed."""
    both = Walk("FF-01", "FF-02")
    both.go(10)
    both.script.act(SetMeeting("m", "FF-01", "FF-02", both.script.t_ns, 5.0, "at the stairs"))
    sighting(both, SightingKind.UNIT, "FF-02", range_m)
    pins = both.script.pipeline.state.site.pins
    assert [pin.by for pin in pins.values()] == ["chief", "FF-01"]
    both.script.act(RemovePin("m"))
    assert [pin.by for pin in pins.values()] == ["FF-01"]


def test_sighted_unit_is_no_beacon_of_the_same_name() -> None:
    walk = Walk("FF-01", "FF-02")
    walk.script.act(PlaceBeacon("FF-02", "door", 0.0, 0.0, 3, 0.2, 8.0))
    walk.go(20)
    sighting(walk, SightingKind.UNIT, "FF-02")
    state = walk.script.pipeline.state
    assert state.site.beacons["FF-02"].seen_ns is None
    assert reported_floors(state, state.site) == []
    (met,) = pin_views(state, person_lookup({}))
    assert (met.kind, met.north_m, met.floor) == ("meeting", None, None)
    sighting(walk, SightingKind.BEACON, "FF-02")
    assert [stated.floor for stated in reported_floors(state, state.site)] == [3]


def test_path_is_unpacked_once_for_all_reported_floors(
    walk: Walk, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With hundreds of sightings all units would wait for each."""
    walk.script.act(PlaceBeacon("b1", "door", 0.0, 0.0, 0, 0.2, 3.0))
    for ago_s in (200.0, 150.0, 100.0, 50.0):
        sighting(walk, SightingKind.BEACON, "b1", captured_s=walk.script.now_s - ago_s)
    unpacked: list[PathHistory] = []
    arrays = PathHistory.arrays

    def counting(history: PathHistory) -> PathArrays:
        unpacked.append(history)
        return arrays(history)

    monkeypatch.setattr(PathHistory, "arrays", counting)
    assert (
        len(reported_floors(walk.script.pipeline.state, walk.script.pipeline.state.site, ["FF-01"]))
        == 4
    )
    assert len(unpacked) == 1


@pytest.mark.parametrize(
    ("kind", "placed", "std_m"),
    [
        (SightingKind.BEACON, False, 1.5),
        (SightingKind.BEACON, True, 4.0),
        (SightingKind.TAG, False, 0.3),
        (SightingKind.TAG, True, 4.0),
        (SightingKind.UNIT, False, 1.5),
    ],
)
def test_sighting_without_a_range_lies_within_the_reach(
    kind: SightingKind, placed: bool, std_m: float
) -> None:
    walk = Walk("FF-01", "FF-02")
    walk.go(1)
    if placed:
        walk.script.act(PlaceBeacon("FF-02", "door", 0.0, 0.0, None, 0.2, 8.0))
    sighting(walk, kind, "FF-02")
    (pin,) = walk.script.pipeline.state.site.pins.values()
    assert pin.std_m == pytest.approx(std_m)


def test_encounter_before_the_path_of_one_changes_nothing() -> None:
    """Its first position comes a minute later, from another place."""
    met, alone = Walk("FF-01", "FF-02"), Walk("FF-01", "FF-02")
    for walk in (met, alone):
        walk.start("FF-01")
        walk.go(60, silent=("FF-02",))
        if walk is met:
            sighting(walk, SightingKind.UNIT, "FF-02", 1.0)
        walk.go(60, silent=("FF-02",))
        walk.go(10)
    (pin,) = met.script.pipeline.state.site.pins
    assert met.state(pin) == "waiting"
    assert met.trail("FF-01") == alone.trail("FF-01")
    assert met.trail("FF-02") == alone.trail("FF-02")


def test_sighting_before_the_incident_is_not_the_begin_of_the_path(walk: Walk) -> None:
    north_m, east_m = truth(0.0)
    walk.script.act(PlaceBeacon("door-3", "door", north_m, east_m + 50.0, None, 0.2, 0.5))
    before = walk.trail("FF-01")
    sighting(walk, SightingKind.TAG, "door-3", captured_s=-600.0)
    (pin,) = walk.script.pipeline.state.site.pins
    assert walk.state(pin) == "waiting"
    assert walk.trail("FF-01") == before


def test_sightings_leave_room_for_pins_of_people(
    walk: Walk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("base_station.core.pins.sightings.MAX_SIGHTINGS", 3)
    for number in range(5):
        sighting(walk, SightingKind.TAG, f"door-{number}")
    assert len(walk.script.pipeline.state.site.pins) == 3
    walk.pin("p1", "FF-01", 250.0)
    assert walk.state("p1") == "used"
    assert seen_ids(walk) == ["door-2", "door-3", "door-4"]


def test_pins_of_people_are_not_displaced_by_sightings(
    walk: Walk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("base_station.core.pins.sightings.MAX_SIGHTINGS", 2)
    for pin_id in ("p1", "p2"):
        walk.pin(pin_id, "FF-01", 250.0)
    sighting(walk, SightingKind.TAG, "door-3")
    assert list(walk.script.pipeline.state.site.pins) == ["p1", "p2"]
    counts = walk.script.pipeline.state.units["FF-01"].rejected_counts
    assert counts == {"no room for sightings beside what people pinned": 1}


def test_long_stay_gives_up_its_beginning_and_a_pass_stays(
    walk: Walk, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A wearer who works beside a beacon for hours displaces neither others nor later sightings."""
    monkeypatch.setattr("base_station.core.pins.sightings.MAX_SIGHTINGS", 4)
    state = walk.script.pipeline.state
    sighting(walk, SightingKind.TAG, "door-1", captured_s=walk.script.now_s - 250.0)
    for ago_s in (200.0, 150.0, 100.0, 50.0, 0.0):
        sighting(walk, SightingKind.BEACON, "pump", captured_s=walk.script.now_s - ago_s)
    sighting(walk, SightingKind.TAG, "door-2")
    kept = sorted((pin.t_ns - state.t_ns) / NS_PER_S for pin in state.site.pins.values())
    assert kept == [-250.0, -50.0, 0.0, 0.0]
    assert sorted(seen_ids(walk)) == ["door-1", "door-2", "pump", "pump"]


def seen_ids(walk: Walk) -> list[str]:
    """Ids of sightings in the order of reception, without pins of people."""
    return [pin.other_id for pin in walk.script.pipeline.state.site.pins.values() if pin.other_id]


@pytest.mark.slow
def test_unit_met_often_is_solved_once(monkeypatch: pytest.MonkeyPatch) -> None:
    both = Walk("FF-01", "FF-02")
    for unit_id in both.units:
        both.start(unit_id)
    both.go(120)
    solved: list[tuple[str, ...]] = []
    solve = PathGraph.solve

    def counting(
        smoother: PathGraph,
        units: Mapping[str, UnitEvidence],
        encounters: Sequence[EncounterConstraint] = (),
    ) -> Solution:
        solved.append(tuple(units))
        return solve(smoother, units, encounters)

    for number in range(4):
        both.go(30)
        if number == 3:
            monkeypatch.setattr(PathGraph, "solve", counting)
        sighting(both, SightingKind.UNIT, "FF-02", 1.0)
    assert len(both.script.pipeline.state.site.pins) == 4
    assert sorted(solved) == [("FF-01",)] * 2 + [("FF-02",)] * 2
