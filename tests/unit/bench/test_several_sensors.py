"""Swings of a track against marked ones."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from edge.tracker.track_rows import empty_rows
from tests.bench.tracker.several_sensors import swing_errors


def rows_with_swings(swings_s, until_s=6.0, rate_hz=100.0):
    t_s = np.arange(0.0, until_s, 1.0 / rate_hz)
    stationary = np.ones(len(t_s), np.bool_)
    for begin_s, end_s in swings_s:
        stationary[(t_s >= begin_s - 1e-9) & (t_s < end_s - 1e-9)] = False
    return replace(empty_rows(), t_ns=np.round(t_s * 1e9).astype(np.int64), stationary=stationary)


def test_errors_are_those_of_beginning_and_end():
    rows = rows_with_swings([(1.0, 1.6), (2.0, 2.55)])
    errors_s = swing_errors(rows, np.array([(1.1, 1.5), (2.2, 2.6)]))
    assert errors_s == pytest.approx(np.array([(-0.1, 0.1), (-0.2, -0.05)]))


def test_swing_without_track_is_missed():
    rows = rows_with_swings([(1.0, 1.6)])
    assert swing_errors(rows, np.array([(1.1, 1.5), (4.1, 4.5)])).shape == (1, 2)


def test_missed_stance_leaves_no_swing_to_compare():
    rows = rows_with_swings([(1.0, 2.55)])  # two swings in one
    assert swing_errors(rows, np.array([(1.1, 1.5), (2.2, 2.6)])).shape == (0, 2)
