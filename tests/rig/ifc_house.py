"""House of two storeys as an IFC file, made by ``ifcopenshell``: walls, doors, stairs and rooms."""

from __future__ import annotations

import math
from typing import Any, Literal

import ifcopenshell
import ifcopenshell.guid

WIDTH_M, DEPTH_M, THICK_M, STOREY_M = 12.0, 8.0, 0.3, 3.0
Schema = Literal["IFC2X3", "IFC4", "IFC4X3"]
PREFIXES = {0.001: "MILLI", 0.01: "CENTI", 1.0: None}


class IfcHouse:
    """File under construction; lengths are metres, written in the file's unit."""

    def __init__(
        self,
        schema: Schema = "IFC4",
        unit_m: float = 1.0,
        origin_m: tuple[float, float, float] = (0.0, 0.0, 0.0),
    ) -> None:
        self.file: Any = ifcopenshell.file(schema=schema)
        self.unit_m = unit_m
        make = self.file.create_entity
        up, axis = self._direction(0.0, 0.0, 1.0), self._direction(1.0, 0.0, 0.0)
        world = make("IfcAxis2Placement3D", self._point(0.0, 0.0, 0.0), up, axis)
        self.context = make("IfcGeometricRepresentationContext", None, "Model", 3, 1e-5, world)
        units = make("IfcUnitAssignment", [self._length_unit()])
        self.project = make(
            "IfcProject", ifcopenshell.guid.new(), Name="House",
            RepresentationContexts=[self.context], UnitsInContext=units,
        )  # fmt: skip
        self.site = self.add("IfcSite", "Site", at_m=origin_m)
        self.building = self.add("IfcBuilding", "House", parent=self.site)
        self._aggregate(self.project, self.site)
        self._aggregate(self.site, self.building)

    def add(self, kind: str, name: str, parent: Any = None, **attributes: Any) -> Any:
        """Entity of a kind at ``at_m``, with its x axis turned left by ``turned_rad``."""
        at_m = attributes.pop("at_m", (0.0, 0.0, 0.0))
        turned_rad = attributes.pop("turned_rad", 0.0)
        placed = self._placement(at_m, turned_rad, parent)
        return self.file.create_entity(
            kind, ifcopenshell.guid.new(), Name=name, ObjectPlacement=placed, **attributes
        )

    def storey(self, name: str, height_m: float) -> Any:
        storey = self.add("IfcBuildingStorey", name, self.building, at_m=(0.0, 0.0, height_m))
        storey.Elevation = height_m / self.unit_m
        self._aggregate(self.building, storey)
        return storey

    def block(
        self,
        kind: str,
        name: str,
        storey: Any,
        at_m: tuple[float, float, float],
        size_m: tuple[float, float, float],
        turned_rad: float = 0.0,
        **attributes: Any,
    ) -> Any:
        """Element of a storey whose shape is a block; ``at_m`` is its lower left corner."""
        element = self.add(kind, name, storey, at_m=at_m, turned_rad=turned_rad, **attributes)
        self.shape(element, size_m)
        if kind == "IfcSpace":
            self._aggregate(storey, element)
        elif kind != "IfcOpeningElement":
            self._contain(storey, element)
        return element

    def shape(self, element: Any, size_m: tuple[float, float, float]) -> None:
        """Give an element the shape of a block."""
        make = self.file.create_entity
        wide, deep, high = (length / self.unit_m for length in size_m)
        middle = make("IfcCartesianPoint", (wide / 2.0, deep / 2.0))
        profile = make(
            "IfcRectangleProfileDef", "AREA", None,
            make("IfcAxis2Placement2D", middle, make("IfcDirection", (1.0, 0.0))), wide, deep,
        )  # fmt: skip
        axes = (self._direction(0.0, 0.0, 1.0), self._direction(1.0, 0.0, 0.0))
        at = make("IfcAxis2Placement3D", self._point(0.0, 0.0, 0.0), *axes)
        solid = make("IfcExtrudedAreaSolid", profile, at, self._direction(0.0, 0.0, 1.0), high)
        body = make("IfcShapeRepresentation", self.context, "Body", "SweptSolid", [solid])
        element.Representation = make("IfcProductDefinitionShape", None, None, [body])

    def opening(
        self,
        wall: Any,
        storey: Any,
        at_m: tuple[float, float, float],
        size_m: tuple[float, float, float],
        turned_rad: float = 0.0,
        filled_by: str = "",
    ) -> None:
        """Opening of a wall, with a door or a window in it."""
        make = self.file.create_entity
        void = self.block("IfcOpeningElement", "Opening", storey, at_m, size_m, turned_rad)
        make(
            "IfcRelVoidsElement", ifcopenshell.guid.new(),
            RelatingBuildingElement=wall, RelatedOpeningElement=void,
        )  # fmt: skip
        if not filled_by:
            return
        wing = self.block(filled_by, filled_by, storey, at_m, size_m, turned_rad)
        make(
            "IfcRelFillsElement", ifcopenshell.guid.new(),
            RelatingOpeningElement=void, RelatedBuildingElement=wing,
        )  # fmt: skip

    def content(self) -> bytes:
        text: str = self.file.to_string()
        return text.encode()

    def _length_unit(self) -> Any:
        make = self.file.create_entity
        if self.unit_m in PREFIXES:
            return make("IfcSIUnit", None, "LENGTHUNIT", PREFIXES[self.unit_m], "METRE")
        metre = make("IfcSIUnit", None, "LENGTHUNIT", None, "METRE")
        factor = make("IfcMeasureWithUnit", make("IfcLengthMeasure", self.unit_m), metre)
        lengths = make("IfcDimensionalExponents", 1, 0, 0, 0, 0, 0, 0)
        return make("IfcConversionBasedUnit", lengths, "LENGTHUNIT", "FOOT", factor)

    def _placement(self, at_m: tuple[float, float, float], turned_rad: float, parent: Any) -> Any:
        axis = self._direction(math.cos(turned_rad), math.sin(turned_rad), 0.0)
        up = self._direction(0.0, 0.0, 1.0)
        at = self.file.create_entity("IfcAxis2Placement3D", self._point(*at_m), up, axis)
        above = parent.ObjectPlacement if parent is not None else None
        return self.file.create_entity("IfcLocalPlacement", above, at)

    def _point(self, *at_m: float) -> Any:
        lengths = tuple(length / self.unit_m for length in at_m)
        return self.file.create_entity("IfcCartesianPoint", lengths)

    def _direction(self, *ratios: float) -> Any:
        return self.file.create_entity("IfcDirection", ratios)

    def _aggregate(self, whole: Any, part: Any) -> None:
        self.file.create_entity(
            "IfcRelAggregates", ifcopenshell.guid.new(), RelatingObject=whole, RelatedObjects=[part]
        )

    def _contain(self, storey: Any, element: Any) -> None:
        self.file.create_entity(
            "IfcRelContainedInSpatialStructure", ifcopenshell.guid.new(),
            RelatedElements=[element], RelatingStructure=storey,
        )  # fmt: skip


def house_of_two_storeys(
    schema: Schema = "IFC4",
    unit_m: float = 1.0,
    origin_m: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> IfcHouse:
    """House of 12 m by 8 m with a wall across its middle, on both storeys.

    The south wall of the ground floor has a door of 1 m from x = 2 m, the wall in the middle one of
    0.9 m from y = 3 m; a window in the north wall is as low as the cut.  The roof is a storey
    without walls.
    """
    house = IfcHouse(schema, unit_m, origin_m)
    levels = [house.storey("Ground floor", 0.0), house.storey("Upper floor", STOREY_M)]
    house.storey("Roof", 2.0 * STOREY_M)
    for level in levels:
        walls = walls_of(house, level)
        house.opening(
            walls["middle"], level, (6.3, 3.0, 0.0), (0.9, THICK_M, 2.1), math.pi / 2.0, "IfcDoor"
        )
        house.opening(walls["north"], level, (3.0, 7.7, 0.9), (2.0, THICK_M, 1.2), 0.0, "IfcWindow")
        if level == levels[0]:
            house.opening(
                walls["south"], level, (2.0, 0.0, 0.0), (1.0, THICK_M, 2.1), 0.0, "IfcDoor"
            )
        for name, left_m in (("Hall", THICK_M), ("Office", 6.0 + THICK_M)):
            size_m = (5.7 if name == "Hall" else 5.4, 7.4, 2.7)
            house.block("IfcSpace", name, level, (left_m, THICK_M, 0.0), size_m)
    house.block("IfcStairFlight", "Flight", levels[0], (0.4, 4.0, 0.0), (1.2, 3.0, STOREY_M))
    house.block("IfcTransportElement", "Lift", levels[0], (9.0, 6.0, 0.0), (1.6, 1.6, 6.0))
    house.block("IfcColumn", "Column", levels[0], (9.0, 3.0, 0.0), (0.3, 0.3, STOREY_M))
    return house


def walls_of(house: IfcHouse, level: Any) -> dict[str, Any]:
    """The four outer walls of a storey, and the one in the middle."""
    long_m, short_m = (WIDTH_M, THICK_M, STOREY_M), (THICK_M, DEPTH_M, STOREY_M)
    corners = {
        "south": ((0.0, 0.0, 0.0), long_m),
        "north": ((0.0, DEPTH_M - THICK_M, 0.0), long_m),
        "west": ((0.0, 0.0, 0.0), short_m),
        "east": ((WIDTH_M - THICK_M, 0.0, 0.0), short_m),
        "middle": ((6.0, 0.0, 0.0), short_m),
    }
    return {
        name: house.block("IfcWall", name, level, at_m, size_m)
        for name, (at_m, size_m) in corners.items()
    }
