"""Building of an IFC file: its floors, and the elements from which a plan is drawn.

Only the structure is read here, from IFC2x3, IFC4 and IFC4x3 alike; solids come later (``ifc``).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from importlib import import_module
from typing import Any, NamedTuple

from base_station.drawings.shapes import Point

_APART_M = 1.0  # storeys that are nearer to each other are one floor: raw and finished, split
_NOT_ROOMS = {"EXTERNAL", "GFA"}
_MOVING = ("ESCALATOR", "MOVINGWALKWAY", "MOVINGWALK")
_EAST: Point = (1.0, 0.0)


class ModelLevel(NamedTuple):
    """Floor: storeys of about the same height."""

    height_m: float  # in the frame of the file
    name: str


class ModelElement(NamedTuple):
    kind: str  # wall, door, passage, stairs, lift or room
    entity: Any
    parts: tuple[Any, ...]  # that have the shape; none: the element has no shape
    level: int | None  # row of the levels; None: the file does not name its storey
    along: Point = _EAST  # of a door: unit vector along the wall


class ModelBuilding(NamedTuple):
    levels: tuple[ModelLevel, ...]  # lowest first
    elements: tuple[ModelElement, ...]
    ground_m: float  # height that the file has for the ground floor


def building_of(file: Any, unit_m: float) -> ModelBuilding:
    """Structure of a file whose unit of length is as long."""
    storeys = file.by_type("IfcBuildingStorey")
    contained = Counter(
        storey.id()
        for relation in file.by_type("IfcRelContainedInSpatialStructure")
        for storey in (relation.RelatingStructure,)
        for element in relation.RelatedElements
        if element.is_a("IfcWall")
    )
    levels, level_of = _levels(storeys, contained, unit_m)
    datums = [_height_m(one, unit_m) for one in file.by_type("IfcBuilding") if one.ObjectPlacement]
    elements = tuple(
        element._replace(level=level_of.get(_storey_id(element.entity)))
        for element in _elements(file)
    )
    return ModelBuilding(tuple(levels), elements, datums[0] if datums else 0.0)


def placed_at(entity: Any) -> Any:
    """Matrix (4, 4) of an entity's placement, in units of the file."""
    placement: Any = import_module("ifcopenshell.util.placement")
    return placement.get_local_placement(entity.ObjectPlacement)


def name_of(entity: Any) -> str:
    """Number and name of a room or a storey."""
    names = (entity.Name, getattr(entity, "LongName", None))
    return " ".join(dict.fromkeys(one.strip() for one in names if one and one.strip()))[:80]


def _levels(
    storeys: Sequence[Any], walls: Counter[int], unit_m: float
) -> tuple[list[ModelLevel], dict[int | None, int]]:
    """Levels, and the level of each storey by its id.  Of several storeys at one level, that with
    most walls counts.
    """
    levels: list[ModelLevel] = []
    level_of: dict[int | None, int] = {}
    groups: list[list[tuple[float, Any]]] = []
    for height_m, storey in sorted(
        ((_height_m(one, unit_m), one) for one in storeys), key=lambda pair: pair[0]
    ):
        if not groups or height_m - groups[-1][0][0] >= _APART_M:
            groups.append([])
        groups[-1].append((height_m, storey))
    for number, group in enumerate(groups):
        height_m, storey = max(group, key=lambda pair: walls[pair[1].id()])
        levels.append(ModelLevel(height_m, name_of(storey)))
        level_of |= {one.id(): number for _, one in group}
    return levels, level_of


def _height_m(entity: Any, unit_m: float) -> float:
    if entity.ObjectPlacement:
        return float(placed_at(entity)[2][3]) * unit_m
    return float(getattr(entity, "Elevation", None) or 0.0) * unit_m


def _storey_id(entity: Any) -> int | None:
    element: Any = import_module("ifcopenshell.util.element")
    storey = element.get_parent(entity, "IfcBuildingStorey")
    return storey.id() if storey else None


def _elements(file: Any) -> Iterator[ModelElement]:
    yield from _walls(file)
    yield from _openings(file)
    yield from _stairs_and_lifts(file)
    for space in file.by_type("IfcSpace"):
        if _use(space, "InteriorOrExteriorSpace") not in _NOT_ROOMS:
            yield ModelElement("room", space, _parts(space), None)


def _walls(file: Any) -> Iterator[ModelElement]:
    for kind in ("IfcWall", "IfcCurtainWall"):
        for wall in file.by_type(kind):
            yield ModelElement("wall", wall, _parts(wall, without="IfcDoor"), None)
    for window in file.by_type("IfcWindow"):
        if not window.FillsVoids:  # else the wall around it is closed anyway
            yield ModelElement("wall", window, _parts(window), None)


def _openings(file: Any) -> Iterator[ModelElement]:
    for door in file.by_type("IfcDoor"):
        voids = [relation.RelatingOpeningElement for relation in door.FillsVoids]
        shaped = tuple(void for void in voids if void.Representation) or _parts(door)
        yield ModelElement("door", door, shaped, None, _along(door))
    for relation in file.by_type("IfcRelVoidsElement"):
        wall, void = relation.RelatingBuildingElement, relation.RelatedOpeningElement
        if wall.is_a("IfcWall") and _is_passage(void):
            yield ModelElement("passage", void, _parts(void), None, _along(wall))


def _stairs_and_lifts(file: Any) -> Iterator[ModelElement]:
    for kind in ("IfcStair", "IfcRamp"):
        for stairs in file.by_type(kind):
            yield ModelElement("stairs", stairs, _parts(stairs, only=_WALKED), None)
    for kind in ("IfcStairFlight", "IfcRampFlight"):
        for flight in file.by_type(kind):
            if not flight.Decomposes:  # else it is a part of stairs
                yield ModelElement("stairs", flight, _parts(flight), None)
    for lift in file.by_type("IfcTransportElement"):
        is_moving = _use(lift, "OperationType") in _MOVING
        yield ModelElement("stairs" if is_moving else "lift", lift, _parts(lift), None)


_WALKED = ("IfcStairFlight", "IfcRampFlight", "IfcSlab", "IfcStair", "IfcRamp")


def _parts(entity: Any, without: str = "", only: Sequence[str] = ()) -> tuple[Any, ...]:
    """The entity itself, or those of its parts that have a shape."""
    if entity.Representation:
        return (entity,)
    below = [part for relation in entity.IsDecomposedBy for part in relation.RelatedObjects]
    return tuple(
        shaped
        for part in below
        if not (without and part.is_a(without)) and (not only or any(map(part.is_a, only)))
        for shaped in _parts(part, without, only)
    )


def _use(entity: Any, in_ifc2x3: str) -> str:
    """PredefinedType of an entity, which had another name in IFC2x3."""
    return str(getattr(entity, "PredefinedType", None) or getattr(entity, in_ifc2x3, None))


def _is_passage(void: Any) -> bool:
    return not void.HasFillings and getattr(void, "PredefinedType", None) != "RECESS"


def _along(entity: Any) -> Point:
    """Horizontal x axis of an entity, along which walls run and doors are wide."""
    if not entity.ObjectPlacement:
        return _EAST
    matrix = placed_at(entity)
    x, y = float(matrix[0][0]), float(matrix[1][0])
    length = (x * x + y * y) ** 0.5
    return (x / length, y / length) if length > 0.5 else _EAST
