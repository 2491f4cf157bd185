"""Innovation monitor: a stance contradicts by itself, or as one of a series."""

from __future__ import annotations

import numpy as np
import pytest

from edge.tracker.foot.config import EskfConfig, config_record
from edge.tracker.foot.state import STEP, new_filter_state, new_progress
from edge.tracker.foot.zupt.stance_consistency import begin_stance, inflate_for_misfit
from edge.tracker.preprocessing.sample_ring import new_ring

CONFIG = config_record(EskfConfig())[0]


def misfits(sums, speed_mps=2.0, scale_std=0.0):
    """Let stances take away ``speed_mps`` at these sums; return which of them contradict."""
    ring, step, progress = new_ring(200.0), np.zeros(1, STEP)[0], new_progress()[0]
    state = new_filter_state()[0]
    state["scale_errors"]["std"] = scale_std
    state["swing_speed_mps"] = 5.0
    found = []
    for number, nis in enumerate(sums):
        ring[0]["t_s"] = float(number)
        progress["last_stance_s"] = number - 0.5
        state["velocity_n_mps"][0] = speed_mps
        begin_stance(ring, step, progress, state, 0, CONFIG)
        state["stance_nis"] = nis
        inflate_for_misfit(progress, state, ring[0]["t_s"], CONFIG)
        found.append(bool(state["stance_misfits"]))
    return found, float(state["misfit_n_m"][0])


@pytest.mark.parametrize(
    ("sums", "expected"),
    [
        ([31.0], [True]),
        ([30.0], [False]),
        ([20.0, 20.0], [False, True]),
        ([20.0, 0.5, 0.5, 0.5, 20.0], [False] * 5),  # long ago
        ([10.0] * 8, [False] * 8),  # of which each is probable
        ([30.0, 5.0, 5.0], [False] * 3),
    ],
)
def test_a_contradiction_is_one_that_is_improbable_or_a_series(sums, expected):
    found, _ = misfits(sums)
    assert found == expected


def test_every_contradiction_widens_by_the_distance_of_its_velocity():
    _, widened_m = misfits([20.0, 20.0, 20.0])
    assert widened_m == pytest.approx(2 * 2.0 * 0.5)


def test_difference_explained_by_the_gains_is_no_evidence():
    assert misfits([40.0, 40.0], scale_std=0.1)[0] == [False, False]
