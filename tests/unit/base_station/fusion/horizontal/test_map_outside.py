"""A person who leaves an upper floor by a window, onto a ladder or a roof, is not held in the
building for long by a plan that has no floor there.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from base_station.fusion import FUSERS
from base_station.fusion.interface import Start
from base_station.site.floor_grid import FloorGrid
from shared.messages import Header
from shared.path_noise import PathNoise
from tests.rig.incident.scores import CHI2_95_2DOF, normalised2
from tests.rig.message_factory import position
from tests.rig.walled_plan import Line, walled_grid

WIDE_M, LONG_M, STEP_M = 20.0, 30.0, 0.2
PERIOD_NS = 200_000_000
HAND = PathNoise(0.08, 0.28, 0.014)


def upper_floor() -> FloorGrid:
    """A corridor from south to north in the middle, and rooms with doors on both sides of it."""
    ring = [[0.0, 0.0], [WIDE_M, 0.0], [WIDE_M, LONG_M], [0.0, LONG_M], [0.0, 0.0]]
    walls: list[Line] = [ring]
    for north in np.arange(0.0, LONG_M, 5.0).tolist():
        walls += [[[0.0, north], [9.0, north]], [[11.0, north], [WIDE_M, north]]]
        for east in (9.0, 11.0):
            walls += [
                [[east, north], [east, north + 2.0]],
                [[east, north + 3.0], [east, north + 5]],
            ]
    return walled_grid(ring, walls, floor=1)


def places(metres_outside: float) -> list[tuple[float, float]]:
    """North and east along the corridor, through a room and straight out of its window."""
    corridor = [(north, 10.0) for north in np.arange(1.0, 17.5, STEP_M).tolist()]
    east = np.arange(10.0, WIDE_M + metres_outside, STEP_M)
    return corridor + [(17.5, one) for one in east.tolist()]


@pytest.mark.parametrize(
    ("noise", "released_m"), [(None, 6.0), (HAND, 14.0)], ids=["on a foot", "in a hand"]
)
def test_person_outside_of_an_upper_floor_is_released_by_the_plan(
    noise: PathNoise | None, released_m: float
) -> None:
    fuser, way = FUSERS[0].new(), places(25.0)
    fuser.set_map(upper_floor())
    fuser.start(Start(*way[0], -3.0, 0.0, 0.3, 0.05))
    for row, (north_m, east_m) in enumerate(way):
        header = Header("FF-01", 1, row + 1, row * PERIOD_NS)
        moved = {"north_m": north_m - way[0][0], "east_m": east_m - way[0][1], "path_noise": noise}
        fuser.predict(position(header, **moved))
        estimate = fuser.estimate()
        assert estimate is not None
        error_m = np.array([estimate.north_m - north_m, estimate.east_m - east_m])
        if east_m > WIDE_M + released_m:
            assert math.hypot(*error_m) < 1.0
            assert normalised2(estimate, error_m) < CHI2_95_2DOF
