"""What a unit says it has seen: beacons, tags and other units, as pins."""

from __future__ import annotations

import math

import pytest

from shared.messages import Sighting, SightingKind
from shared.messages.pins import (
    PlaceBeacon,
    RemoveBeacon,
)
from tests.round_walk import Walk, truth


@pytest.fixture
def walk() -> Walk:
    walk = Walk("FF-01")
    walk.start("FF-01")
    walk.go(300)
    return walk


def sighting(walk: Walk, kind: SightingKind, seen_id: str, range_m: float | None = None) -> None:
    header = walk.script.header("FF-01")
    walk.script.say(Sighting(header, kind, seen_id, range_m))


def test_a_beacon_counts_once_it_is_placed_and_moves_with_it(walk: Walk) -> None:
    sighting(walk, SightingKind.TAG, "door-3")
    (pin,) = walk.script.pipeline.state.pins.values()
    assert walk.state(pin.pin_id) == "waiting"
    before_m = walk.now_off_m("FF-01")
    north_m, east_m = truth(walk.walked_s)
    walk.script.act(PlaceBeacon("door-3", "door", north_m, east_m, None, 0.2, 0.5))
    assert walk.state(pin.pin_id) == "used"
    assert walk.now_off_m("FF-01") < 1.0 < before_m
    walk.script.act(RemoveBeacon("door-3"))
    assert walk.state(pin.pin_id) == "waiting"
    assert walk.now_off_m("FF-01") == before_m


def test_who_stays_near_a_beacon_passes_it_once(walk: Walk) -> None:
    for range_m in (8.0, 3.0, 1.0, 5.0):
        sighting(walk, SightingKind.BEACON, "b1", range_m)
        walk.go(2)
    (pin,) = walk.script.pipeline.state.pins.values()
    assert pin.std_m == pytest.approx(math.hypot(1.0 / math.sqrt(2.0), 0.5))
    walk.go(30)
    sighting(walk, SightingKind.BEACON, "b1", 4.0)
    assert len(walk.script.pipeline.state.pins) == 2


def test_a_sighting_of_nobody_is_counted_and_changes_nothing(walk: Walk) -> None:
    sighting(walk, SightingKind.UNIT, "stranger")
    sighting(walk, SightingKind.UNIT, "FF-01")
    sighting(walk, SightingKind.UNKNOWN, "x")
    sighting(walk, SightingKind.BEACON, "far", 5000.0)
    assert walk.script.pipeline.state.pins == {}
    assert sum(walk.script.pipeline.state.units["FF-01"].not_used.values()) == 4
