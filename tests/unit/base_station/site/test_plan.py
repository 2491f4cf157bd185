"""Plans: required features, the floor of a height, and inside and outside."""

from __future__ import annotations

import cmath
import math

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from base_station.site.plan import Plan, read_plan
from shared.errors import UserError

HOUSE = {
    "type": "FeatureCollection",
    "muster": {
        "frame": "site-m",
        "floors": [
            {"floor": 1, "down_m": -3.2},
            {"floor": 0, "down_m": 0.0},
            {"floor": -1, "down_m": 2.8},
        ],
    },
    "features": [
        {
            "type": "Feature",
            "properties": {"kind": "outline", "floor": 0},
            "geometry": {
                "type": "Polygon",
                "coordinates": [[[0, 0], [20, 0], [20, 10], [0, 10], [0, 0]]],
            },
        },
        {"type": "Feature", "properties": {"kind": "door"}, "geometry": None},
        {"type": "Feature", "properties": None, "geometry": None},
    ],
}


@pytest.fixture
def house() -> Plan:
    return read_plan(msgspec.json.encode(HOUSE))


def test_storeys_are_distinguished_by_height(house: Plan) -> None:
    assert [house.floor_at(down_m, None) for down_m in (3.0, 0.3, -3.0, -50.0)] == [-1, 0, 1, 1]


def test_floor_is_kept_until_about_the_middle_of_the_stairs(house: Plan) -> None:
    middle_m = -1.6
    assert house.floor_at(middle_m - 0.2, 0) == 0
    assert house.floor_at(middle_m + 0.2, 1) == 1
    assert house.floor_at(middle_m - 0.6, 0) == 1
    assert house.floor_at(middle_m + 0.6, 1) == 0


def test_plan_without_storeys_gives_no_floor() -> None:
    plan = read_plan(b'{"type":"FeatureCollection","muster":{"frame":"site-m"},"features":[]}')
    assert plan.floor_at(0.0, 3) is None
    assert not plan.is_inside(5.0, 5.0, False)


CORNERED = ((0.0, 0.0), (20.0, 0.0), (20.0, 10.0), (10.0, 10.0), (10.0, 20.0), (0.0, 20.0))


@pytest.mark.parametrize(
    ("east_m", "north_m", "depth_m"),
    [
        (5.0, 5.0, 5.0),
        (5.0, 19.0, 1.0),
        (12.0, 12.0, -2.0),
        (23.0, 14.0, -5.0),
        (-3.0, 21.0, -(10**0.5)),
    ],
)
@given(angle_rad=st.floats(-math.pi, math.pi))
def test_depth_inside_a_building_is_independent_of_its_rotation(
    east_m: float, north_m: float, depth_m: float, angle_rad: float
) -> None:
    def turned(point: tuple[float, float]) -> tuple[float, float]:
        turned = complex(*point) * cmath.exp(1j * angle_rad)
        return turned.real, turned.imag

    plan = Plan(b"", (), (tuple(map(turned, CORNERED)),))
    there_east_m, there_north_m = turned((east_m, north_m))
    assert plan.depth_m(there_north_m, there_east_m) == pytest.approx(depth_m, abs=1e-9)
    assert plan.away_m(there_north_m, there_east_m) == pytest.approx(max(0.0, -depth_m), abs=1e-9)


def test_inside_is_east_first_and_has_hysteresis_at_the_wall(house: Plan) -> None:
    assert house.is_inside(north_m=5.0, east_m=15.0, inside=False)
    assert not house.is_inside(north_m=15.0, east_m=5.0, inside=False)
    for was_inside in (True, False):
        assert house.is_inside(north_m=10.5, east_m=5.0, inside=was_inside) == was_inside
        assert house.is_inside(north_m=9.5, east_m=5.0, inside=was_inside) == was_inside
    assert not house.is_inside(north_m=12.0, east_m=5.0, inside=True)


@pytest.mark.parametrize(
    ("geojson", "words"),
    [
        (b"not json", "no JSON"),
        (b"\xff\xfe", "no JSON"),
        (b"[]", "FeatureCollection"),
        (b'{"type":"FeatureCollection","features":[]}', "no scale"),
        (b'{"type":"FeatureCollection","muster":{"frame":"wgs84"}}', "no scale"),
        (
            b'{"type":"FeatureCollection","muster":{"frame":"site-m","floors":[{"floor":0}]}}',
            "down_m",
        ),
        (
            b'{"type":"FeatureCollection","muster":{"frame":"site-m"},"features":[{"properties":'
            b'{"kind":"outline"},"geometry":{"type":"Polygon","coordinates":[]}}]}',
            "two points",
        ),
        (
            b'{"type":"FeatureCollection","muster":{"frame":"site-m"},"features":[{"properties":'
            b'{"kind":"outline"},"geometry":null}]}',
            r"outline \(feature 0\) has the geometry null: it must be one of LineString",
        ),
        (
            b'{"type":"FeatureCollection","muster":{"frame":"site-m"},"features":[{"properties":'
            b'{"kind":"wall","floor":"up"}, "geometry":{"type":"LineString","coordinates":'
            b"[[0,0],[1,1]]}}]}",
            r"floor of a wall \(feature 0\) that cannot be read: Expected `int`, got `str`",
        ),
        (b'{"type":"FeatureCollection","muster":{"frame":"site-m"},"features":5}', "array"),
        (
            b'{"type":"FeatureCollection","muster":{"frame":"site-m","floors":['
            b'{"floor":1,"down_m":0},{"floor":1,"down_m":-3}]}}',
            "floor 1 more than once",
        ),
        (
            b'{"type":"FeatureCollection","muster":{"frame":"site-m","floors":['
            b'{"floor":1234567890123456789012345,"down_m":0}]}}',
            "<= 1000",
        ),
        (
            b'{"type":"FeatureCollection","muster":{"frame":"site-m","floors":['
            b'{"floor":1,"down_m":1e300}]}}',
            "<= 100000",
        ),
        (
            b'{"type":"FeatureCollection","muster":{"frame":"site-m"},"features":[{"properties":'
            b'{"kind":"wall"},"geometry":{"type":"LineString","coordinates":'
            b"[[0,0],[1e308,-1e308]]}}]}",
            "<= 100000",
        ),
        (b"[" * 100_000, "recursion"),
    ],
)
def test_unusable_plan_is_refused_with_its_fault(geojson: bytes, words: str) -> None:
    with pytest.raises(UserError, match=words):
        read_plan(geojson)


@pytest.mark.parametrize("kind", ["wall", "outline", "stairs"])
@pytest.mark.parametrize("points", [[], [[1.0, 2.0]]])
def test_line_of_fewer_than_two_points_is_refused(kind: str, points: list[list[float]]) -> None:
    feature = {
        "type": "Feature",
        "properties": {"kind": kind, "floor": 0},
        "geometry": {"type": "LineString", "coordinates": points},
    }
    site = {"frame": "site-m", "floors": []}
    plan = {"type": "FeatureCollection", "muster": site, "features": [feature]}
    with pytest.raises(UserError, match="two points"):
        read_plan(msgspec.json.encode(plan))


def test_lines_and_areas_of_several_parts_are_as_many_walls_outlines_and_stairs() -> None:
    first, second = [[0, 0], [4, 0], [4, 3]], [[10, 0], [14, 0], [14, 3]]
    hole = [[1, 0.5], [2, 0.5], [2, 1]]

    def feature(kind: str, shape: str, coordinates: object) -> dict[str, object]:
        geometry = {"type": shape, "coordinates": coordinates}
        return {"type": "Feature", "properties": {"kind": kind, "floor": 1}, "geometry": geometry}

    features = [
        feature("wall", "MultiLineString", [first, second]),
        feature("outline", "MultiPolygon", [[first, hole], [second]]),
        feature("stairs", "MultiPolygon", [[first], [second]]),
        feature("wall", "Polygon", [first, hole]),
    ]
    site = {"frame": "site-m", "floors": []}
    plan = read_plan(
        msgspec.json.encode({"type": "FeatureCollection", "muster": site, "features": features})
    )
    both = [tuple(map(tuple, line)) for line in (first, second)]
    assert [wall.line for wall in plan.walls] == [*both, both[0]]
    assert [wall.floor for wall in plan.walls] == [1, 1, 1]
    assert list(plan.outlines) == both
    assert [one.ring for one in plan.stairs] == both


@pytest.mark.parametrize("shape", ["MultiLineString", "MultiPolygon"])
@pytest.mark.parametrize("coordinates", [[], [[]], [[[]]], 5, [5], [[5]], None])
def test_impossible_parts_are_refused(shape: str, coordinates: object) -> None:
    geometry = {"type": shape, "coordinates": coordinates}
    feature = {"type": "Feature", "properties": {"kind": "wall"}, "geometry": geometry}
    plan = {"type": "FeatureCollection", "muster": {"frame": "site-m"}, "features": [feature]}
    with pytest.raises(UserError, match=r"wall \(feature 0\)"):
        read_plan(msgspec.json.encode(plan))


def test_wall_that_is_no_number_is_refused() -> None:
    plan = (
        b'{"type":"FeatureCollection","muster":{"frame":"site-m"},"features":[{"properties":'
        b'{"kind":"wall","floor":0},"geometry":{"type":"LineString",'
        b'"coordinates":[[0,0],[1e999,0]]}}]}'
    )
    with pytest.raises(UserError, match="out of range"):
        read_plan(plan)
