"""Plans with a damaged feature: refused when loaded, with its name; of one already in a log the
rest is shown, and nothing else stops.
"""

from __future__ import annotations

import copy
import math
from typing import Any

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from base_station.core.checkpoint import Checkpoint
from base_station.engine.foxglove_topics import FoxgloveTopics
from base_station.site.plan import Plan, check_plan, read_plan, salvage_plan
from base_station.site.plan_reader import PlanReader
from base_station.views.station import StationFacts, health_view
from shared.errors import UserError
from shared.geo import Anchor
from shared.messages.station import SetAnchor, SetPlan
from tests.rig.live_station import make_pipeline
from tests.rig.station_script import START_NS, Script

RING = [[0.0, 0.0], [20.0, 0.0], [20.0, 10.0], [0.0, 10.0], [0.0, 0.0]]
ANCHOR = Anchor(60.0, 10.0, 0.0)


def feature(kind: str, geometry: object, floor: object = 0) -> dict[str, Any]:
    return {
        "type": "Feature",
        "properties": {"kind": kind, "floor": floor, "name": "store"},
        "geometry": geometry,
    }


OUTLINE = feature("outline", {"type": "Polygon", "coordinates": [RING]})
WALL = feature("wall", {"type": "LineString", "coordinates": [[5, 0], [5, 4]]})
DOOR = feature("door", {"type": "MultiPoint", "coordinates": [[5, 4], [5, 5, 1.0]]})
BROKEN: dict[str, Any] = {
    "a room without a place": feature("room", None),
    "a room that is a number": feature("room", 5),
    "a room without coordinates": feature("room", {"type": "Polygon"}),
    "a room of null coordinates": feature("room", {"type": "Polygon", "coordinates": None}),
    "a room of no ring": feature("room", {"type": "Polygon", "coordinates": []}),
    "a room of an empty ring": feature("room", {"type": "MultiPolygon", "coordinates": [[[]]]}),
    "a room that is a line": feature("room", {"type": "LineString", "coordinates": RING}),
    "a room of an unknown type": feature("room", {"type": "Circle", "coordinates": [0, 0]}),
    "a room of words": feature("room", {"type": "Polygon", "coordinates": [[["0", 0], [1, 1]]]}),
    "a thing of one coordinate": feature("door", {"type": "Point", "coordinates": [1]}),
    "a thing far away": feature("door", {"type": "Point", "coordinates": [1e300, 0]}),
    "a thing in a collection": feature(
        "", {"type": "GeometryCollection", "geometries": [{"type": "Polygon", "coordinates": [[]]}]}
    ),
    "a wall of a point": feature("wall", {"type": "Point", "coordinates": [1, 1]}),
    "a feature that is null": None,
    "a feature that is a list": [],
    "a feature of another type": {**OUTLINE, "type": "Fixture"},
    "properties that are a list": {**OUTLINE, "properties": []},
    "no geometry at all": {"type": "Feature", "properties": {"kind": "room"}},
}
broken = pytest.mark.parametrize("damaged", BROKEN.values(), ids=BROKEN.keys())


def plan_of(*features: object, name: object = "Mill") -> bytes:
    muster = {"frame": "site-m", "name": name, "floors": [{"floor": 0, "down_m": 0.0}]}
    document = {"type": "FeatureCollection", "muster": muster, "features": features}
    return msgspec.json.encode(document)


@broken
def test_plan_is_refused_with_its_unusable_feature(damaged: object) -> None:
    with pytest.raises(UserError, match="feature 1"):
        read_plan(plan_of(OUTLINE, damaged, WALL))


@broken
def test_damaged_plan_of_a_log_is_shown_without_its_fault(damaged: object) -> None:
    plan = salvage_plan(plan_of(OUTLINE, damaged, WALL))
    assert "feature 1" in plan.damage
    assert (
        len(plan.outlines) == len(plan.walls) == 1 or damaged == BROKEN["a feature of another type"]
    )
    drawn = msgspec.json.decode(plan.geojson)
    assert drawn["features"] == [OUTLINE, WALL]
    assert drawn["muster"]["damage"] == plan.damage
    assert FoxgloveTopics().plan(plan, ANCHOR, START_NS)


@broken
def test_station_that_reads_a_damaged_plan_continues(damaged: object) -> None:
    script = Script()
    script.act(SetAnchor(60.0, 10.0, 0.0, 0.0))
    script.act(SetPlan(plan_of(OUTLINE, damaged, WALL)))
    script.tick()
    plan = script.pipeline.state.site.plan
    assert plan is not None
    (problem,) = health_view(script.pipeline.state, StationFacts()).problems
    assert "feature 1" in problem


def test_state_saved_by_another_version_is_checked_again() -> None:
    script = Script()
    script.act(SetPlan(plan_of(OUTLINE, WALL)))
    saved = msgspec.msgpack.decode(script.pipeline.checkpoint(), type=Checkpoint)
    geojson = plan_of(OUTLINE, BROKEN["a room without a place"])
    saved.state.site.plan = Plan(geojson, (), ())  # it did not check rooms
    again = make_pipeline(saved).state.site.plan
    assert again is not None
    assert "feature 1" in again.damage
    assert len(again.outlines) == 1


def test_valid_plan_has_no_damage_and_is_drawn_unchanged() -> None:
    geojson = plan_of(OUTLINE, WALL, DOOR, feature("", None))
    plan = check_plan(geojson)
    assert plan.damage == ""
    assert plan.geojson == geojson


LARGE = [[math.cos(t / 200.0), math.sin(t / 200.0)] for t in range(1257)]


@pytest.mark.parametrize(
    ("one", "words"),
    [
        (feature("room", {"type": "Polygon", "coordinates": [RING[:4]]}), "not closed"),
        (feature("room", {"type": "Polygon", "coordinates": [RING[:1] * 3]}), "not closed"),
        (feature("room", {"type": "Polygon", "coordinates": [RING]}, "G"), "floor of a room"),
        (feature("wall", WALL["geometry"], 3), "floor 3"),
        (feature("outline", {"type": "Polygon", "coordinates": [[*LARGE, LARGE[0]]]}), "1263 poin"),
        (feature("stairs", {"type": "MultiLineString", "coordinates": [RING] * 1001}), "1001 stai"),
        (
            feature("wall", {"type": "LineString", "coordinates": [[0, 0], [9e4, 0]] * 2}),
            "270 km long",
        ),
    ],
)
def test_feature_forbidden_in_a_new_plan_is_still_read_in_an_old_one(
    one: dict[str, Any], words: str
) -> None:
    geojson = plan_of(OUTLINE, one)
    with pytest.raises(UserError, match=words):
        check_plan(geojson)
    assert read_plan(geojson).damage == ""


def test_name_is_text() -> None:
    with pytest.raises(UserError, match="name"):
        check_plan(plan_of(OUTLINE, name={"en": "Mill"}))


def _places(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    inner = value.items() if isinstance(value, dict) else enumerate(value)
    found = [path] if path else []
    for key, one in inner:
        here = (*path, key)
        found += _places(one, here) if isinstance(one, dict | list) else [here]
    return found


SOUND = msgspec.json.decode(plan_of(OUTLINE, WALL, DOOR, feature("room", OUTLINE["geometry"])))


@given(
    path=st.sampled_from(_places(SOUND)),
    odd=st.sampled_from([None, 5, -1e300, "x", [], [[]], [[[]]], {}, {"type": "Point"}, True]),
)
def test_any_value_of_a_member_is_read_or_refused(path: tuple[Any, ...], odd: Any) -> None:
    plan = copy.deepcopy(SOUND)
    holder = plan
    for key in path[:-1]:
        holder = holder[key]
    holder[path[-1]] = odd
    geojson = msgspec.json.encode(plan)
    try:
        read = PlanReader().plan(geojson)
    except UserError:
        return  # no plan at all
    assert FoxgloveTopics().plan(read, ANCHOR, START_NS)
    assert PlanReader().grid(read) is None or read.walls


def test_plan_read_beforehand_is_the_same_plan() -> None:
    geojson = plan_of(OUTLINE, WALL)
    beforehand, afresh = PlanReader(), PlanReader()
    beforehand.check(geojson)
    plan = beforehand.plan(geojson)
    assert plan == afresh.plan(geojson)
    grid, other = beforehand.grid(plan), afresh.grid(afresh.plan(geojson))
    assert grid is not None
    assert other is not None
    assert grid is beforehand.grid(plan)
    assert grid.area_m2 == other.area_m2
