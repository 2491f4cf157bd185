"""Walls of a DXF drawing, by the library ``ezdxf``, of the optional part ``muster[plans]``."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from importlib import import_module
from importlib.util import find_spec
from typing import Any

from base_station.drawings.draft import METRES_PER_UNIT, Draft, LengthUnit, Options, noted
from base_station.drawings.shapes import MOST_POINTS, DrawnShape, Point, box_of, plan_of
from shared.coded_text import coded
from shared.errors import UserError

_MISSING = coded(
    "dxf-library-missing",
    "the library ezdxf, which reads DXF, is not installed at the station: pip "
    "install --require-hashes -r deploy/requirements-plans.lock; or print the "
    "drawing to PDF",
)
_UNITS: dict[int, LengthUnit] = {1: "in", 2: "ft", 4: "mm", 5: "cm", 6: "m"}  # of $INSUNITS
_NO_UNIT = coded(
    "dxf-no-unit",
    "the DXF does not say in which unit of length it is drawn; choose it, and send it again",
)
_DRAWN = {"LINE", "LWPOLYLINE", "POLYLINE", "ARC", "ELLIPSE", "SPLINE", "CIRCLE"}
_WALLS = re.compile(r"wall|wand|w[äa]nde|mauer|\bmurs?\b", re.IGNORECASE)
_STAIRS = re.compile(r"stair|trepp|escalier", re.IGNORECASE)
_ROUGH_M = 0.05  # how far a curve's line may lie from it


def read_dxf(content: bytes, options: Options) -> Draft:
    """Read a DXF drawing.  Raises UserError with the fault of the file, and advice."""
    if find_spec("ezdxf") is None:
        raise UserError(_MISSING)
    library: Any = import_module("ezdxf")
    recover: Any = import_module("ezdxf.recover")
    try:
        document, _ = recover.read(io.BytesIO(content))
    except (library.DXFError, OSError, ValueError) as error:
        raise UserError(
            coded("dxf-unreadable", "the DXF cannot be read; save it anew, or print it to PDF")
        ) from error
    unit = options.unit or _UNITS.get(document.header.get("$INSUNITS", 0))
    if unit is None:
        raise UserError(_NO_UNIT)
    lines = list(_lines(document.modelspace(), METRES_PER_UNIT[unit]))
    named = any(_WALLS.search(layer) for layer, _ in lines)
    shapes = [shape for layer, points in lines for shape in _shapes(layer, points, named)]
    if not shapes:
        raise UserError(coded("dxf-no-wall", "the drawing has no line that could be a wall"))
    # Drawings begin anywhere, often far away in a grid of a survey.
    west, south, _, _ = box_of(point for shape in shapes for point in shape.points)
    placed = [
        shape._replace(points=[(x - west, y - south) for x, y in shape.points]) for shape in shapes
    ]
    notes: tuple[str, ...] = (
        coded(
            "note-dxf-unit",
            "Its unit of length is {unit}; it lies with its lower left corner at the origin.",
            unit=unit,
        ),
    )
    if not named:
        notes += (
            coded(
                "note-dxf-no-walls",
                "No layer has the name of walls: every line is taken for one.",
            ),
        )
    return noted(Draft(plan=plan_of(options.name, placed)), notes)


def _shapes(layer: str, points: list[Point], named: bool) -> Iterator[DrawnShape]:
    if _STAIRS.search(layer):
        if points[0] == points[-1] and len(points) > 3:
            yield DrawnShape("stairs", 0, points)
    elif not named or _WALLS.search(layer):
        yield DrawnShape("wall", 0, points)


def _lines(modelspace: Any, metres: float) -> Iterator[tuple[str, list[Point]]]:
    """Layer and points of each line, including those within blocks."""
    disassemble: Any = import_module("ezdxf.disassemble")
    entities = disassemble.recursive_decompose(modelspace)
    drawn = (one for one in entities if one.dxftype() in _DRAWN)
    count = 0
    for primitive in disassemble.to_primitives(drawn):
        if primitive.path is None:
            continue
        vertices = primitive.path.flattening(_ROUGH_M / metres)
        points = [(float(at.x) * metres, float(at.y) * metres) for at in vertices]
        count += len(points)
        if count > MOST_POINTS:
            raise UserError(
                coded(
                    "dxf-too-fine",
                    "the DXF has more than {most} points; leave out furniture and hatching",
                    most=MOST_POINTS,
                )
            )
        if len(points) >= 2:
            yield str(primitive.entity.dxf.layer), points
