"""DXF drawings become walls, in the unit that they or a person names."""

from __future__ import annotations

import io
from typing import Any

import msgspec
import pytest
from ezdxf.filemanagement import new

from base_station.drawings import dxf
from base_station.drawings.draft import Draft, LengthUnit, Options
from base_station.drawings.reader import read_drawing
from base_station.site.plan import check_plan
from shared.errors import UserError


def drawing(units: int, metre: float, wall_layer: str = "A-WALL") -> bytes:
    """A wall of 10 m, one of a block, a stairwell and a chair, far from the origin."""
    document: Any = new(units=units)
    space = document.modelspace()
    block = document.blocks.new("door wing")
    block.add_line((0, 0), (0, 2 * metre), dxfattribs={"layer": wall_layer})
    at = 6_400_000.0 * metre
    space.add_line((at, 0), (at + 10 * metre, 0), dxfattribs={"layer": wall_layer})
    space.add_blockref("door wing", (at + 10 * metre, 0))
    ring = [(at, 0), (at + metre, 0), (at + metre, metre), (at, metre)]
    space.add_lwpolyline(ring, close=True, dxfattribs={"layer": "Stairs"})
    space.add_circle((at + 3 * metre, metre), metre / 2, dxfattribs={"layer": "Furniture"})
    space.add_text("Hall")
    written = io.StringIO()
    document.write(written)
    return written.getvalue().encode()


def read(content: bytes, unit: LengthUnit | None = None) -> tuple[Draft, list[Any]]:
    draft = read_drawing(content, Options("House", unit=unit))
    assert draft.plan is not None
    check_plan(msgspec.json.encode(draft.plan))
    return draft, draft.plan["features"]


@pytest.mark.parametrize(
    ("units", "metre", "unit"),
    [(4, 1000.0, None), (6, 1.0, None), (2, 1 / 0.3048, None), (0, 100.0, "cm")],
)
def test_walls_are_metres_whatever_the_unit(
    units: int, metre: float, unit: LengthUnit | None
) -> None:
    _, (wall, in_block, stairs) = read(drawing(units, metre), unit)
    assert wall["geometry"]["coordinates"] == [pytest.approx([0, 0]), pytest.approx([10, 0])]
    assert in_block["geometry"]["coordinates"][1] == pytest.approx([10, 2])
    assert (stairs["properties"]["kind"], stairs["geometry"]["type"]) == ("stairs", "Polygon")


def test_without_a_layer_of_walls_every_line_is_one_and_it_is_noted() -> None:
    draft, features = read(drawing(6, 1.0, wall_layer="0"))
    assert [one["properties"]["kind"] for one in features].count("wall") == 3
    assert any("No layer" in note for note in draft.notes)
    assert [one.code for one in draft.note_codes] == ["note-dxf-unit", "note-dxf-no-walls"]


@pytest.mark.parametrize(
    ("content", "unit", "reason"),
    [
        (drawing(0, 1.0), None, "does not say in which unit"),
        (drawing(6, 1000.0), None, "choose another unit"),
        (drawing(6, 1.0), "mm", "choose another unit"),
        (b"0\nSECTION\n2\nHEADER\n9", None, "no unit|cannot be read|does not say"),
        (b"999\nnothing", None, "cannot be read|does not say"),
    ],
)
def test_file_that_is_no_plan_is_refused(
    content: bytes, unit: LengthUnit | None, reason: str
) -> None:
    with pytest.raises(UserError, match=reason):
        read_drawing(content, Options(unit=unit))


def test_without_its_library_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dxf, "find_spec", lambda _: None)
    with pytest.raises(UserError, match=r"requirements-plans\.lock; or print"):
        read_drawing(b"0\nSECTION\n", Options())
