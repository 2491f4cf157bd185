"""Pins, encounters, starts and beacons that are refused, each with a sentence."""

from __future__ import annotations

import math

import pytest

from base_station.core.events import Refused
from shared.messages.pins import (
    PlaceBeacon,
    RemoveBeacon,
    RemovePin,
    SetMeeting,
    SetPin,
    StartTogether,
)
from shared.messages.station import SetPlan
from tests.rig.round_walk import PLAN, Walk, walk_from_the_engine
from tests.rig.station_script import Script


@pytest.fixture
def walk() -> Walk:
    return walk_from_the_engine()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"unit_id": "nobody"}, "no registered unit"),
        ({"north_m": math.nan}, "no pair of numbers"),
        ({"std_m": 0.0}, "more than 0"),
        ({"std_m": -1.0}, "more than 0"),
        ({"std_m": math.nan}, "cannot be weighed"),
        ({"t_ns": 10**10}, "before the path"),
        ({"t_ns": 4 * 10**18}, "in the future"),
        ({"floor": 7}, "no floor 7"),
        ({"north_m": 9000.0}, "from the plan's building"),
        ({"heading_rad": math.inf}, "heading needs"),
        ({"heading_rad": 1.0, "heading_std_rad": 0.0}, "more than 0"),
    ],
)
def test_bad_pins_are_refused_with_a_sentence(
    walk: Walk, changes: dict[str, object], sentence: str
) -> None:
    walk.script.act(SetPlan(PLAN))
    before = walk.trail("FF-01")
    good = SetPin("p", "FF-01", walk.script.t_ns, 1.0, 1.0, 1.0, None, None, 0.3, "")
    fields = {name: getattr(good, name) for name in good.__struct_fields__} | changes
    outputs = walk.script.act(SetPin(**fields))
    (refused,) = [output for output in outputs if isinstance(output, Refused)]
    assert sentence in refused.reason
    assert walk.script.pipeline.state.site.pins == {}
    assert walk.trail("FF-01") == before


@pytest.mark.parametrize(
    ("other_id", "t_s", "std_m", "sentence"),
    [
        ("FF-01", 0.0, 1.0, "cannot meet itself"),
        ("nobody", 0.0, 1.0, "no registered unit"),
        ("FF-02", 9.0, 1.0, "is 9 seconds in the future"),
        ("FF-02", -31.0, 1.0, "is 12 seconds before the path of FF-01"),
        ("FF-02", -3.0 * 3600.0, 1.0, "is 3 hours before the path of FF-01"),
        ("FF-02", -400.0 * 86400.0, 1.0, "is 400 days before the path of FF-01"),
        ("FF-02", 0.0, 0.0, "more than 0"),
    ],
)
def test_bad_meetings_are_refused_with_a_sentence(
    other_id: str, t_s: float, std_m: float, sentence: str
) -> None:
    walk = Walk("FF-01")
    walk.go(20)
    walk.script.register("FF-02")
    t_ns = walk.script.t_ns + round(t_s * 1e9)
    outputs = walk.script.act(SetMeeting("m", "FF-01", other_id, t_ns, std_m, ""))
    (refused,) = [output for output in outputs if isinstance(output, Refused)]
    assert sentence in refused.reason
    assert walk.script.pipeline.state.site.pins == {}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("action", "sentence"),
    [
        (StartTogether("s", (), 0, 1.0, 1.0, 1.0, None, None, 0.3, ""), "no unit to place"),
        (
            StartTogether("s", ("FF-01", "nobody"), 0, 1.0, 1.0, 1.0, None, None, 0.3, ""),
            "no registered unit",
        ),
        (PlaceBeacon("b", "", 1.0, 1.0, None, 1.0, math.nan), "number of metres"),
        (PlaceBeacon("b", "", 1.0, 1.0, None, 1.0, -1.0), "number of metres"),
        (PlaceBeacon("b", "", math.inf, 1.0, None, 1.0, 1.0), "no pair of numbers"),
    ],
)
def test_bad_starts_and_beacons_are_refused_with_a_sentence(
    walk: Walk, action: StartTogether | PlaceBeacon, sentence: str
) -> None:
    (refused,) = walk.script.act(action)
    assert isinstance(refused, Refused)
    assert sentence in refused.reason
    state = walk.script.pipeline.state
    assert (state.site.pins, state.site.beacons) == ({}, {})


def test_missing_pin_cannot_be_removed() -> None:
    for action in (RemovePin("p"), RemoveBeacon("b")):
        (refused,) = Script().act(action)
        assert isinstance(refused, Refused)


def test_number_of_pins_is_bounded_by_what_can_be_solved(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("base_station.core.pins.pin_registry.MAX_PINS", 2)
    walk = Walk("FF-01")
    walk.go(20)
    for pin_id in ("p1", "p2", "p2", "p3"):
        walk.pin(pin_id, "FF-01", 10.0)
    assert list(walk.script.pipeline.state.site.pins) == ["p1", "p2"]
    assert [type(one) for one in walk.script.outputs].count(Refused) == 1


def test_common_start_without_room_for_all_is_refused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("base_station.core.pins.pin_registry.MAX_PINS", 2)
    walk = Walk("FF-01", "FF-02")
    walk.go(20)
    walk.pin("p1", "FF-01", 10.0)
    both = StartTogether("s", walk.units, 0, 0.0, 0.0, 0.5, None, None, 0.3, "")
    (refused,) = walk.script.act(both)
    assert isinstance(refused, Refused)
    assert list(walk.script.pipeline.state.site.pins) == ["p1"]
