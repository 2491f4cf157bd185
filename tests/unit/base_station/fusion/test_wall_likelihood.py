"""Room beside a wall is less evidence the less is known of the step that leads there."""

from __future__ import annotations

import math

import numpy as np
import pytest

from base_station.fusion.wall_likelihood import BESIDE_WALL, log_beside_wall
from base_station.site.floor_grid import CELL_M

MOVE_M = 0.35
FOOT_M2, TRUNK_M2, HAND_M2 = MOVE_M * np.array([0.03, 0.16, 0.28]) ** 2


@pytest.mark.parametrize("step_var_m2", [FOOT_M2, TRUNK_M2, HAND_M2, 4.0])
def test_strip_beside_a_wall_counts_for_the_part_that_an_error_leaves_in_it(
    step_var_m2: float,
) -> None:
    rng = np.random.default_rng(1)
    place_m = rng.uniform(0.0, CELL_M, 400_000)
    moved_m = place_m + math.sqrt(step_var_m2) * rng.normal(size=len(place_m))
    part = float(((moved_m > 0.0) & (moved_m < CELL_M)).mean())
    likelihood = math.exp(log_beside_wall(np.array(step_var_m2)))
    assert likelihood == pytest.approx(1.0 - (1.0 - BESIDE_WALL) * part, abs=0.002)


def test_precise_step_keeps_all_of_it_and_one_of_metres_nothing() -> None:
    precise, foot, trunk, hand, metres = np.exp(
        log_beside_wall(np.array([1e-12, FOOT_M2, TRUNK_M2, HAND_M2, 100.0]))
    )
    assert precise == pytest.approx(BESIDE_WALL, abs=1e-4)
    assert BESIDE_WALL < foot < 0.55 < trunk < 0.75 < hand < 0.85
    assert metres == pytest.approx(1.0, abs=0.01)
