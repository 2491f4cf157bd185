"""IFC models of buildings become floors, walls with doors, stairs and rooms."""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import msgspec
import pytest

from base_station.drawings import ifc
from base_station.drawings.draft import Draft, Options
from base_station.drawings.reader import read_drawing
from base_station.site.plan import Plan, check_plan
from shared.errors import UserError
from tests.rig.ifc_house import STOREY_M, IfcHouse, Schema, house_of_two_storeys, walls_of

FOOT_M = 0.3048


def read(content: bytes) -> tuple[Draft, Plan]:
    draft = read_drawing(content, Options("House"))
    assert draft.plan is not None
    return draft, check_plan(msgspec.json.encode(draft.plan))


def shapes(draft: Draft, kind: str, floor: int = 0) -> list[Any]:
    assert draft.plan is not None
    return [
        one
        for one in draft.plan["features"]
        if one["properties"]["kind"] == kind and one["properties"]["floor"] == floor
    ]


def line(feature: Any) -> list[tuple[float, float]]:
    return [(x, y) for x, y in feature["geometry"]["coordinates"]]


def zipped(content: bytes, name: str = "house.ifc") -> bytes:
    written = io.BytesIO()
    with zipfile.ZipFile(written, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(name, content)
    return written.getvalue()


@pytest.mark.parametrize(
    ("schema", "unit_m"), [("IFC2X3", 0.001), ("IFC4", 1.0), ("IFC4X3", FOOT_M), ("IFC4", 0.01)]
)
def test_storeys_are_floors_in_metres_whatever_the_schema_and_the_unit(
    schema: Schema, unit_m: float
) -> None:
    draft, plan = read(house_of_two_storeys(schema, unit_m).content())
    assert [(one.floor, one.down_m) for one in plan.storeys] == [(0, 0.0), (1, -STOREY_M)]
    (outline,) = shapes(draft, "outline")
    corners = outline["geometry"]["coordinates"][0]
    assert sorted(map(tuple, corners))[0] == pytest.approx((0.0, 0.0), abs=0.01)
    assert sorted(map(tuple, corners))[-1] == pytest.approx((12.0, 8.0), abs=0.01)
    assert "Its floors: 0 = Ground floor (0.00 m), 1 = Upper floor (3.00 m)." in draft.notes
    assert "Storeys without doors, rooms and stairs are left out: Roof." in draft.notes
    assert "Left out are columns: 1." in draft.notes


def crossed(draft: Draft, begin: tuple[float, float], end: tuple[float, float], floor: int) -> bool:
    """True if a wall stands between two places on one axis."""
    for wall in shapes(draft, "wall", floor):
        points = line(wall)
        for (x0, y0), (x1, y1) in pairwise(points):
            if _cuts(begin, end, (x0, y0), (x1, y1)):
                return True
    return False


def _cuts(a: Any, b: Any, c: Any, d: Any) -> bool:
    def side(p: Any, q: Any, r: Any) -> float:
        return float((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]))

    return side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0


def test_doors_are_gaps_and_windows_are_not() -> None:
    draft, _ = read(house_of_two_storeys().content())
    south_door, south_wall = ((2.5, -1.0), (2.5, 1.0)), ((4.5, -1.0), (4.5, 1.0))
    inner_door, window = ((5.5, 3.4), (7.0, 3.4)), ((4.0, 7.0), (4.0, 9.0))
    assert not crossed(draft, *south_door, floor=0)
    assert crossed(draft, *south_wall, floor=0)
    assert crossed(draft, *south_door, floor=1)
    assert not crossed(draft, *inner_door, floor=1)
    assert crossed(draft, *window, floor=0)
    assert sorted(map(line, shapes(draft, "door"))) == [
        [(2.0, 0.15), (3.0, 0.15)],
        [(6.15, 3.0), (6.15, 3.9)],
    ]


def test_stairs_are_on_both_floors_and_a_lift_is_a_room() -> None:
    draft, plan = read(house_of_two_storeys().content())
    assert sorted(one.floor for one in plan.stairs) == [0, 1]
    names = [[one["properties"].get("name") for one in shapes(draft, "room", at)] for at in (0, 1)]
    assert names == [["Hall", "Office", "Lift"]] * 2


def test_an_opening_without_a_door_is_a_passage_where_it_begins_at_the_floor() -> None:
    house = house_of_two_storeys()
    level, _, _ = house.file.by_type("IfcBuildingStorey")
    north = next(one for one in house.file.by_type("IfcWall") if one.Name == "north")
    house.opening(north, level, (8.0, 7.7, 0.0), (1.0, 0.3, 2.1))
    house.opening(north, level, (10.0, 7.7, 0.7), (1.0, 0.3, 1.0))
    draft, _ = read(house.content())
    assert not crossed(draft, (8.5, 7.0), (8.5, 9.0), floor=0)
    assert crossed(draft, (10.5, 7.0), (10.5, 9.0), floor=0)
    assert len(shapes(draft, "door")) == 2
    assert any("openings without a door" in note for note in draft.notes)


def test_a_door_without_an_opening_is_a_gap_too() -> None:
    """As in a curtain wall, whose panels are its parts."""
    house = IfcHouse()
    level = house.storey("Ground", 0.0)
    walls_of(house, level)
    curtain = house.add("IfcCurtainWall", "Front", level)
    panel = house.add("IfcPlate", "Panel", level, at_m=(12.0, -0.1, 0.0))
    house.shape(panel, (8.0, 0.05, 3.0))
    house.file.create_entity(
        "IfcRelAggregates", "0" * 22, RelatingObject=curtain, RelatedObjects=[panel]
    )
    house.block("IfcDoor", "Door", level, (14.0, -0.12, 0.0), (1.0, 0.1, 2.1))
    draft, _ = read(house.content())
    assert crossed(draft, (13.0, -1.0), (13.0, 1.0), floor=0)
    assert not crossed(draft, (14.5, -1.0), (14.5, 1.0), floor=0)


def test_a_wall_over_two_storeys_is_on_both() -> None:
    house = IfcHouse()
    ground, upper = house.storey("Ground", 0.0), house.storey("Upper", STOREY_M)
    house.block("IfcWall", "Tall", ground, (0.0, 0.0, 0.0), (10.0, 0.3, 6.0))
    house.block("IfcWall", "Parapet", upper, (0.0, 5.0, 0.0), (10.0, 0.3, 0.9))
    house.block("IfcSpace", "Hall", ground, (0.0, 0.3, 0.0), (10.0, 4.0, 2.5))
    house.block("IfcSpace", "Terrace", upper, (0.0, 0.3, 0.0), (10.0, 4.0, 2.5))
    draft, _ = read(house.content())
    assert [len(shapes(draft, "wall", floor)) for floor in (0, 1)] == [1, 1]
    assert "Left out are walls not at 1 m above a floor: 1." in draft.notes


def test_storeys_of_about_one_height_are_one_floor_and_cellars_are_below() -> None:
    house = IfcHouse()
    for name, height_m in (("Cellar", -2.8), ("Raw", -0.15), ("Finished", 0.0)):
        level = house.storey(name, height_m)
        if name == "Raw":
            continue
        house.block("IfcWall", name, level, (0.0, 0.0, 0.0), (10.0, 0.3, 2.5))
        house.block("IfcSpace", name, level, (0.0, 0.3, 0.0), (10.0, 4.0, 2.5))
    _, plan = read(house.content())
    assert [(one.floor, one.down_m) for one in plan.storeys] == [(-1, 2.8), (0, 0.0)]


def test_huge_coordinates_are_brought_to_the_origin() -> None:
    here, _ = read(house_of_two_storeys().content())
    far, _ = read(house_of_two_storeys("IFC4", 0.001, (3_512_345.0, 5_401_234.0, 431.0)).content())
    assert far.plan is not None
    assert here.plan is not None
    for one, other in zip(far.plan["features"], here.plan["features"], strict=True):
        assert one["properties"] == other["properties"]
    door, near_door = (line(shapes(one, "door")[0])[0] for one in (far, here))
    assert door == pytest.approx(near_door, abs=2e-3)


def test_elements_without_a_shape_are_counted() -> None:
    house = house_of_two_storeys()
    house.add("IfcWall", "Only a name", house.building)
    draft, _ = read(house.content())
    assert any("walls without a shape: 1" in note for note in draft.notes)


def test_a_zip_file_is_unpacked() -> None:
    draft, _ = read(zipped(house_of_two_storeys().content()))
    assert len(shapes(draft, "wall")) == 1


def without_storeys() -> bytes:
    house = IfcHouse()
    house.block("IfcWall", "Wall", house.building, (0.0, 0.0, 0.0), (10.0, 0.3, 3.0))
    return house.content()


def without_walls() -> bytes:
    house = IfcHouse()
    house.storey("Ground", 0.0)
    return house.content()


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (lambda: house_of_two_storeys().content()[:9000], "is torn: its end is missing"),
        (lambda: b"ISO-10303-21;\nrubbish\nEND-ISO-10303-21;", "cannot be read; save it anew as"),
        (
            lambda: house_of_two_storeys().content().replace(b"'IFC4'", b"'IFC9'"),
            "cannot be read; save it anew as IFC2x3, IFC4 or IFC4x3",
        ),
        (
            lambda: re.sub(
                rb"(IFCLOCALPLACEMENT\()#\d+", rb"\1#1", house_of_two_storeys().content()
            ),
            "references that its schema does not allow",
        ),
        (without_storeys, "has no storeys"),
        (without_walls, "has no wall with a shape"),
        (lambda: zipped(b"ISO-10303-21;"), "is torn"),
        (lambda: zipped(b"", "readme.txt"), "no IMDF"),
        (lambda: b"<?xml version='1.0'?><ifcXML/>", "save an ifcXML as IFC"),
        (lambda: b"AC1032", "is a DWG"),
    ],
)
def test_bad_files_are_refused_with_advice(content: Callable[[], bytes], reason: str) -> None:
    with pytest.raises(UserError, match=reason):
        read_drawing(content(), Options())


def test_a_zip_file_that_would_be_too_large_is_not_unpacked(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(ifc, "_MOST_UNPACKED_BYTES", 1000)
    with pytest.raises(UserError, match="larger than"):
        read_drawing(zipped(house_of_two_storeys().content()), Options())


def test_without_its_library_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ifc, "find_spec", lambda _: None)
    with pytest.raises(UserError, match=r"requirements-ifc\.lock; or export"):
        read_drawing(house_of_two_storeys().content(), Options())
