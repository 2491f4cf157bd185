"""Stated uncertainty of ``body`` on long walks, worn anywhere: ten minutes of a search."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from edge.simulation.simulation import CONSUMER_SENSORS, UNCALIBRATED_SENSORS
from edge.sources.recording import RecordedTruth
from edge.tracker.interface import TrackBatch
from tests.bench.tracker.scoring import score_track
from tests.bench.tracker.walk_errors import track
from tests.rig.inertial_walk import InertialWalk, inertial_walk

SEEDS = range(2)
_SETTLED_S = 30.0  # the walking direction is known
_TRUTH_S = 0.5


@pytest.mark.parametrize("worn_on", ["hip", "chest", "pocket"])
@pytest.mark.parametrize(
    ("sensors", "aids"), [(CONSUMER_SENSORS, ()), (UNCALIBRATED_SENSORS, ("mag_ut",))]
)
def test_stated_uncertainty_covers_ten_minutes_of_search(worn_on, sensors, aids):
    """Iron beside the compass, gains of the gyroscope, and the cone of a thigh turn it."""
    scores, inside = [], []
    for seed in SEEDS:
        walk = inertial_walk(
            "search-ground-floor", seed, worn_on, sensors, lasts_s=600.0, rate_hz=60.0
        )
        rows = track(walk.description, walk.sensed(*aids), "body")
        every = round(_TRUTH_S * walk.description.rate_hz)
        truth = RecordedTruth(walk.t_s[::every], walk.truth.position_n_m[::every])
        way_m = float(np.hypot(*np.diff(truth.position_n_m[:, :2], axis=0).T).sum())
        score = score_track(rows, truth, closed_loop=False)
        assert score.ate_m is not None
        scores.append((score.ate_m / way_m, score.coverage_95_from_start, score.silently_wrong))
        inside.append(_headings_inside(walk, rows))
        assert np.sqrt(np.trace(rows.position_cov_m2[-1, :2, :2])) < 0.06 * way_m
    ate, covered, silent = np.mean(np.array(scores, np.float64), axis=0)
    assert ate < 0.02
    assert covered > 0.92
    assert silent == 0.0
    assert np.mean(inside) > 0.92


def _headings_inside(walk: InertialWalk, rows: TrackBatch) -> float:
    """Share of the headings in the stated 95 %, against that of the settled walk."""
    every = round(_TRUTH_S * walk.description.rate_hz)
    stated = Rotation.from_quat(rows.quaternion_nb[::every], scalar_first=True)
    off = (stated * Rotation.from_matrix(walk.truth.rotation_nb[::every]).inv()).as_matrix()
    off_rad = np.unwrap(np.arctan2(off[:, 1, 0] - off[:, 0, 1], off[:, 0, 0] + off[:, 1, 1]))
    first = round(_SETTLED_S / _TRUTH_S)
    error_rad = off_rad[first:] - off_rad[first]
    return float(np.mean(np.abs(error_rad) < 1.96 * rows.heading_std_rad[::every][first:]))
