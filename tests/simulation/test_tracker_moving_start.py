"""A recording that begins in mid-swing has no stance before the foot is on the ground."""

from __future__ import annotations

import numpy as np
import pytest

from tests.bench.tracker.walk_errors import track
from tests.rig.exact_strides import part, walk

MADE = walk(strides=6, start_s=2.0)
SWING_S, STRIDE_M = 0.7, 1.3


@pytest.mark.parametrize("into_s", [0.05, 0.15, 0.25, 0.4])
def test_truncated_swing_is_no_stance(into_s):
    first = round((2.0 + into_s) * MADE.description.rate_hz)
    rows = track(MADE.description, part(MADE.imu, slice(first, None)), "eskf")
    landed = round((SWING_S - into_s) * MADE.description.rate_hz)
    assert not rows.stationary[: landed - 10].any()
    stands = np.flatnonzero(rows.stationary)
    walked_m = np.linalg.norm(rows.position_n_m[-1] - rows.position_n_m[stands[20]])
    assert walked_m == pytest.approx(5 * STRIDE_M, rel=0.02)
    assert abs(rows.position_n_m[-1, 2] - rows.position_n_m[stands[20], 2]) < 0.02
