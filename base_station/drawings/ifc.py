"""Models of buildings (IFC2x3, IFC4, IFC4x3), by ``ifcopenshell`` of the part ``muster[ifc]``."""

from __future__ import annotations

import io
import zipfile
from importlib import import_module
from importlib.util import find_spec
from typing import Any

import numpy as np

from base_station.drawings.draft import Draft, Options, noted
from base_station.drawings.ifc_building import ModelBuilding, building_of
from base_station.drawings.ifc_place import ModelPlace, place_of
from base_station.drawings.ifc_plan import DrawnFloors, draw_floors
from base_station.drawings.ifc_sections import Solid
from base_station.drawings.shapes import MOST_POINTS, box_of, plan_of
from shared.coded_text import CodedText, Measure, coded
from shared.errors import UserError

BEGINS = b"ISO-10303-21"
ENDING = ".ifc"
_ENDS = b"END-ISO-10303-21"
_LAST_BYTES = 4096  # among which a whole file ends
_MOST_UNPACKED_BYTES = 100_000_000
_MISSING = coded(
    "ifc-library-missing",
    "the library ifcopenshell, which reads IFC, is not installed at the "
    "station: pip install --require-hashes -r deploy/requirements-ifc.lock; or "
    "export the floors as DXF, IMDF or PDF",
)
_UNREADABLE = coded(
    "ifc-unreadable",
    "the IFC cannot be read; save it anew as IFC2x3, IFC4 or IFC4x3, or print its floors to PDF",
)
_CONTRADICTORY = coded(
    "ifc-contradictory",
    "the IFC has references that its schema does not allow; check it and save "
    "it anew, or print its floors to PDF",
)
_NO_STOREY = coded(
    "ifc-no-storey",
    "the IFC has no storeys (IfcBuildingStorey): export it with them, or print its floors to PDF",
)
_NO_WALL = coded(
    "ifc-no-wall", "the IFC has no wall with a shape on any of its storeys; print its floors to PDF"
)
_SUGGESTED = coded(
    "note-suggested",
    "Its place on the Earth is that of its site, which many drawing programs set by themselves: "
    "look at it before you use it.",
)
_NO_PLACE = coded("note-no-place", "It has no place on the Earth: align it by two points.")
_NOT_DRAWN = {
    "IfcColumn": coded("note-columns", "columns"),
    "IfcBuildingElementProxy": coded("note-no-class", "elements without a class"),
}


def is_zipped_ifc(content: bytes) -> bool:
    """True if a ZIP file contains an IFC file; the ZIP file may be torn."""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            return any(_is_ifc(entry) for entry in archive.infolist())
    except zipfile.BadZipFile:
        return False


def read_zipped_ifc(content: bytes, options: Options) -> Draft:
    """Read the first IFC file in a ZIP file, such as ``.ifczip``. Raises UserError as
    ``read_ifc``.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            entry = next(one for one in archive.infolist() if _is_ifc(one))
            if entry.file_size > _MOST_UNPACKED_BYTES:
                raise UserError(
                    coded(
                        "ifc-zip-too-large",
                        "the IFC in this ZIP file is larger than {most_mb}; export walls, doors, "
                        "stairs and spaces only",
                        most_mb=Measure(
                            _MOST_UNPACKED_BYTES / 1e6, f"{_MOST_UNPACKED_BYTES // 10**6} MB"
                        ),
                    )
                )
            unpacked = archive.read(entry)
    except (zipfile.BadZipFile, NotImplementedError, RuntimeError, OSError) as error:
        raise UserError(
            coded("ifc-zip-unreadable", "this ZIP file cannot be read: {error}", error=str(error))
        ) from error
    return read_ifc(unpacked, options)


def read_ifc(content: bytes, options: Options) -> Draft:
    """Read an IFC file.  Raises UserError with the fault of the file, and advice."""
    if find_spec("ifcopenshell") is None:
        raise UserError(_MISSING)
    file = _opened(content)
    unit: Any = import_module("ifcopenshell.util.unit")
    unit_m = float(unit.calculate_unit_scale(file))
    try:
        building = building_of(file, unit_m)
    except (AttributeError, AssertionError) as error:  # a reference that leads to another class
        raise UserError(_CONTRADICTORY) from error
    if not building.levels:
        raise UserError(_NO_STOREY)
    drawn = draw_floors(building, _solids(file, building))
    if not drawn.shapes:
        raise UserError(_NO_WALL)
    # Models begin anywhere, often far away in a grid of a survey.
    west, south, _, _ = box_of(point for shape in drawn.shapes for point in shape.points)
    shapes = [
        shape._replace(points=[(x - west, y - south) for x, y in shape.points])
        for shape in drawn.shapes
    ]
    ground_m = drawn.levels[0].height_m
    heights_m = {
        floor: round(level.height_m - ground_m, 3) for floor, level in drawn.levels.items()
    }
    place, notes = place_of(file, unit_m, (west, south))
    for kind, words in _NOT_DRAWN.items():  # though people may not walk through them
        drawn.left_out[words] += len(file.by_type(kind))
    draft = Draft(
        plan=plan_of(options.name, shapes, heights_m),
        lat_deg=place.lat_deg if place else None,
        lon_deg=place.lon_deg if place else None,
        plan_rotation_rad=place.rotation_rad if place else 0.0,
        is_place_surveyed=place is not None and place.is_surveyed,
    )
    return noted(draft, (*_notes_of(drawn, heights_m), *notes, *_note_of_place(place)))


def _is_ifc(entry: zipfile.ZipInfo) -> bool:
    return entry.filename.lower().endswith(ENDING)


def _opened(content: bytes) -> Any:
    if _ENDS not in content[-_LAST_BYTES:]:
        raise UserError(
            coded("ifc-torn", "the IFC is torn: its end is missing; copy or save it anew")
        )
    library: Any = import_module("ifcopenshell")
    try:
        # Its own letters are ASCII; others are escaped by the standard, or wrongly of some code.
        file = library.file.from_string(content.decode("latin-1"))
        projects = file.by_type("IfcProject")
    except (RuntimeError, library.Error, library.SchemaError) as error:
        raise UserError(_UNREADABLE) from error
    if not projects:
        raise UserError(_UNREADABLE)
    return file


def _solids(file: Any, building: ModelBuilding) -> dict[int, Solid]:
    """Solids by the id of the part, for parts whose shape the library can make."""
    parts = {part.id(): part for element in building.elements for part in element.parts}
    if not parts:
        return {}
    geometry: Any = import_module("ifcopenshell.geom")
    shape: Any = import_module("ifcopenshell.util.shape")
    settings = geometry.settings()
    settings.set("use-world-coords", True)
    settings.set("disable-opening-subtractions", True)
    solids = {}
    count = 0
    for made in geometry.iterator(settings, file, 1, include=list(parts.values())):
        vertices = np.array(shape.get_vertices(made.geometry), dtype=np.float64)
        triangles = np.array(shape.get_faces(made.geometry), dtype=np.int64)
        if len(triangles) and np.isfinite(vertices).all():
            solids[made.id] = Solid(vertices, triangles)
            count += len(vertices)
        if count > 100 * MOST_POINTS:
            raise UserError(
                coded(
                    "ifc-too-detailed",
                    "the IFC has too much detail; export walls, doors and stairs only",
                )
            )
    return solids


def _notes_of(drawn: DrawnFloors, heights_m: dict[int, float]) -> list[CodedText]:
    floors = ", ".join(  # signs alone: it is the same in every language
        f"{floor} = {level.name or '?'} ({heights_m[floor]:.2f} m)"
        for floor, level in drawn.levels.items()
    )
    notes = [coded("note-floors", "Its floors: {floors}.", floors=floors)]
    if drawn.unused:
        names = ", ".join(name or "?" for name in drawn.unused)
        notes.append(
            coded(
                "note-storeys-left-out",
                "Storeys without doors, rooms and stairs are left out: {names}.",
                names=names,
            )
        )
    notes += [
        coded("note-left-out", "Left out are {elements}: {count}.", elements=elements, count=count)
        for elements, count in sorted(drawn.left_out.items())
        if count
    ]
    return notes


def _note_of_place(place: ModelPlace | None) -> tuple[str, ...]:
    if place is None:
        return (_NO_PLACE,)
    return () if place.is_surveyed else (_SUGGESTED,)
