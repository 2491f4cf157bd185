"""Sections of solids are areas, and walls with gaps are closed lines."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from numpy.typing import NDArray

from base_station.drawings.ifc_sections import (
    MOST_OUTLINE_POINTS,
    Solid,
    footprint,
    gap_of,
    joined,
    outlines_of,
    section,
    united_walls,
    wall_lines,
)

QUADS = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]]
TRIANGLES = np.array([[q[i] for i in half] for q in QUADS for half in ((0, 1, 2), (0, 2, 3))])


def block(x: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> Solid:
    corners: NDArray[np.float64] = np.array([[a, b, c] for c in z for b in y for a in x])
    return Solid(corners, TRIANGLES)


def test_a_plane_cuts_a_block_in_its_area_and_misses_it_above() -> None:
    solid = block((0.0, 5.0), (0.0, 0.3), (0.0, 3.0))
    assert section(solid, 1.0).area == pytest.approx(1.5)
    assert section(solid, 3.5).is_empty
    assert section(solid, 3.0).area == pytest.approx(1.5)
    assert footprint(solid).area == pytest.approx(1.5)


def test_a_surface_that_bounds_no_solid_is_a_thin_wall() -> None:
    solid = block((0.0, 5.0), (0.0, 0.3), (0.0, 3.0))
    sheet = solid._replace(triangles=solid.triangles[4:6])
    assert section(sheet, 1.0).area == pytest.approx(5.0 * 0.04, rel=0.05)


def test_joints_between_walls_are_closed_and_doors_are_not() -> None:
    parts = [
        block((0.0, 4.97), (0.0, 0.3), (0.0, 3.0)),
        block((5.03, 10.0), (0.0, 0.3), (0.0, 3.0)),
    ]
    walls = united_walls([section(one, 1.0) for one in parts])
    (whole,) = wall_lines(walls, [])
    corners = {(round(x, 6) + 0.0, round(y, 6) + 0.0) for x, y in whole}
    assert corners == {(0.0, 0.0), (10.0, 0.0), (10.0, 0.3), (0.0, 0.3)}
    door = section(block((2.0, 3.0), (0.1, 0.2), (0.0, 2.1)), 1.0)
    gap = gap_of(door, (1.0, 0.0))
    assert gap.line() == [pytest.approx((2.0, 0.15)), pytest.approx((3.0, 0.15))]
    assert len(wall_lines(walls, [gap.area(0.2)])) == 2


def test_a_gap_lies_along_its_wall() -> None:
    door = section(block((2.0, 2.3), (1.0, 2.0), (0.0, 2.1)), 1.0)
    begin, end = gap_of(door, (0.0, 1.0)).line()
    assert begin == pytest.approx((2.15, 1.0))
    assert end == pytest.approx((2.15, 2.0))


def test_parts_of_an_element_are_one_solid() -> None:
    both = joined([block((0, 1), (0, 1), (0, 1)), block((2, 3), (0, 1), (0, 2))])
    assert (both.bottom_m, both.top_m) == (0.0, 2.0)
    assert section(both, 0.5).area == pytest.approx(2.0)


def test_only_walls_that_enclose_something_have_an_outline_and_it_has_few_points() -> None:
    angles = np.linspace(0.0, 2.0 * np.pi, 4001)
    wavy = (20.0 + 2.0 * np.sin(200.0 * angles)) * np.exp(1j * angles)
    outer = np.column_stack([wavy.real, wavy.imag])
    inner = 0.9 * outer
    ring = shapely.Polygon(outer, [inner])
    alone = section(block((0.0, 5.0), (0.0, 0.3), (0.0, 3.0)), 1.0)
    first, second = outlines_of([alone, ring])
    assert first == []
    assert 0 < sum(map(len, second)) <= MOST_OUTLINE_POINTS
