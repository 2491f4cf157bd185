"""Floors of a building's model, each cut at about a person's waist, as shapes of a plan.

Solids of walls are whole: openings are not taken out of them, since a window is no way.  Only
doors, and openings without anything in them that begin at the floor, become gaps.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from base_station.drawings.ifc_building import ModelBuilding, ModelElement, ModelLevel, name_of
from base_station.drawings.ifc_sections import (
    Solid,
    footprint,
    gap_of,
    joined,
    outlines_of,
    rings_of,
    section,
    united,
    united_walls,
    wall_lines,
)
from base_station.drawings.shapes import DrawnShape, Point
from shared.coded_text import CodedText, coded

CUT_M = 1.0  # above the floor
_STOREY_APART_M = 2.0  # a wall of one floor is also one of another that is as far and cut by it
_REACHED_M = 0.5  # stairs end as much above or below a floor
_STEPS_M = 1.0  # stairs that are lower change no floor
_BEYOND_M = {True: 0.05, False: 0.25}  # depth of a gap beyond its opening, or beyond a mere door
_SILL_M = 0.3  # an opening that begins higher is no passage
_PASSAGE_M = 0.5  # width
_LIFT = "Lift"
_ORDER = ("room", "lift", "stairs")  # the later is drawn over the earlier


class DrawnFloors(NamedTuple):
    shapes: list[DrawnShape]  # by the number of their floor; x and y in the frame of the file
    levels: dict[int, ModelLevel]  # by number, 0: ground
    unused: tuple[str, ...]  # names of storeys that are no floor
    left_out: Counter[str]  # how many elements, by what they are


class _DrawnFloor:
    """Shapes of one level, before they are joined."""

    def __init__(self, level: ModelLevel) -> None:
        self.level = level
        self.walls: list[Any] = []
        self.gaps: list[Any] = []
        self.doors: list[list[Point]] = []
        self.areas: list[tuple[str, list[Point], str]] = []  # kind of element, ring, name

    @property
    def cut_m(self) -> float:
        return self.level.height_m + CUT_M

    @property
    def is_used(self) -> bool:
        """True if people can be on it: a foundation has walls only."""
        return bool(self.doors or self.areas)


def draw_floors(building: ModelBuilding, solids: Mapping[int, Solid]) -> DrawnFloors:
    """Cut the solids of the elements, by the id of the part that has them."""
    floors = [_DrawnFloor(level) for level in building.levels]
    left_out: Counter[str] = Counter()
    for element in building.elements:
        found = [solids[part.id()] for part in element.parts if part.id() in solids]
        if not found:
            left_out[_without_shape(_WORDS[element.kind])] += 1
        elif not _add(floors, element, found):
            left_out[_UNUSED.get(element.kind, _not_cut)(_WORDS[element.kind])] += 1
    used = [floor for floor in floors if floor.is_used]
    kept = used or [floor for floor in floors if floor.walls]
    unused = tuple(floor.level.name for floor in floors if floor not in kept)
    ground = min(
        range(len(kept)),
        key=lambda row: abs(kept[row].level.height_m - building.ground_m),
        default=0,
    )
    numbered = {row - ground: floor for row, floor in enumerate(kept)}
    shapes = list(_shapes(numbered))
    levels = {number: floor.level for number, floor in numbered.items()}
    return DrawnFloors(shapes, levels, unused, left_out)


_WORDS = {
    "wall": coded("note-walls", "walls"),
    "door": coded("note-doors", "doors"),
    "passage": coded("note-openings", "openings"),
    "stairs": coded("note-stairs", "stairs"),
    "lift": coded("note-lifts", "lifts"),
    "room": coded("note-rooms", "rooms"),
}


def _without_shape(elements: str) -> CodedText:
    return coded("note-without-shape", "{elements} without a shape", elements=elements)


def _not_cut(elements: str) -> CodedText:
    return coded(
        "note-not-cut",
        "{elements} not at {cut_m:g} m above a floor",
        elements=elements,
        cut_m=CUT_M,
    )


def _too_low(elements: str) -> CodedText:
    return coded(
        "note-too-low", "{elements} lower than {steps_m:g} m", elements=elements, steps_m=_STEPS_M
    )


def _no_passage(elements: str) -> CodedText:
    return coded(
        "note-no-passage",
        "{elements} without a door that are too small, or begin above the floor",
        elements=elements,
    )


_UNUSED = {"stairs": _too_low, "passage": _no_passage}


def _add(floors: list[_DrawnFloor], element: ModelElement, solids: list[Solid]) -> bool:
    """Add an element to each floor that it is on; False if there is none."""
    match element.kind:
        case "stairs":
            return _add_stairs(floors, solids)
        case "door" | "passage":
            return _add_gap(floors, element, joined(solids))
    is_added = False
    for floor in _cut_by(floors, element, joined(solids)):
        # Parts are cut one by one: of solids within each other the inner one would be a hole.
        area = united([section(one, floor.cut_m) for one in solids])
        if area.is_empty:
            continue
        is_added = True
        if element.kind == "wall":
            floor.walls.append(area)
        else:
            name = name_of(element.entity) or (_LIFT if element.kind == "lift" else "")
            floor.areas += [(element.kind, ring, name) for ring in rings_of(area)]
    return is_added


def _cut_by(
    floors: list[_DrawnFloor], element: ModelElement, solid: Solid
) -> Iterator[_DrawnFloor]:
    """Floors whose plane cuts a solid; of planes close to its own floor only that one."""
    for row, floor in enumerate(floors):
        if not solid.bottom_m < floor.cut_m <= solid.top_m:
            continue
        if element.level is None or row == element.level:
            yield floor
        elif element.kind != "room":
            apart_m = abs(floor.level.height_m - floors[element.level].level.height_m)
            if apart_m >= _STOREY_APART_M:
                yield floor


def _add_gap(floors: list[_DrawnFloor], element: ModelElement, solid: Solid) -> bool:
    is_opening = all(part.is_a("IfcOpeningElement") for part in element.parts)
    is_added = False
    for floor in _cut_by(floors, element, solid):
        area = section(solid, floor.cut_m)
        if area.is_empty:
            continue
        gap = gap_of(area, element.along)
        if element.kind == "passage" and not (
            solid.bottom_m <= floor.level.height_m + _SILL_M
            and gap.end_m - gap.begin_m >= _PASSAGE_M
        ):
            continue
        floor.gaps.append(gap.area(_BEYOND_M[is_opening]))
        if element.kind == "door":
            floor.doors.append(gap.line())
        is_added = True
    return is_added


def _add_stairs(floors: list[_DrawnFloor], solids: list[Solid]) -> bool:
    """Add to each floor that the stairs reach the ground that they cover."""
    bottom_m, top_m = min(one.bottom_m for one in solids), max(one.top_m for one in solids)
    if top_m - bottom_m < _STEPS_M:
        return False
    rings = rings_of(united([footprint(one) for one in solids]))
    reached = [
        floor
        for floor in floors
        if bottom_m - _REACHED_M <= floor.level.height_m <= top_m + _REACHED_M
    ]
    for floor in reached:
        floor.areas += [("stairs", ring, "") for ring in rings]
    return bool(reached)


def _shapes(floors: Mapping[int, _DrawnFloor]) -> Iterator[DrawnShape]:
    walls = {number: united_walls(floor.walls) for number, floor in floors.items()}
    outlines = dict(zip(walls, outlines_of(list(walls.values())), strict=True))
    for number, floor in floors.items():
        for kind, ring, name in sorted(floor.areas, key=lambda area: _ORDER.index(area[0])):
            yield DrawnShape("room" if kind == "lift" else kind, number, ring, name)
        for ring in outlines[number]:
            yield DrawnShape("outline", number, ring)
        for ring in wall_lines(walls[number], floor.gaps):
            yield DrawnShape("wall", number, ring)
        for line in floor.doors:
            yield DrawnShape("door", number, line)
