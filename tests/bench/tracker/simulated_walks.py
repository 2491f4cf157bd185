"""The thesis's walks (Huang 2009, chapter 4), simulated, for ``muster bench track --simulated``."""

from __future__ import annotations

import numpy as np

from edge.simulation.factory import open_simulation
from edge.sources.recording import RecordedTruth
from edge.tracker.foot.filter.strapdown import rotation_matrix
from edge.tracker.foot.output.track_rows import join_rows
from edge.tracker.registry import make_tracker
from tests.bench.tracker.scoring import Score, score_track

WALKS = ("square-60m", "rectangle", "j-shape", "track-400m")
SEEDS = range(3)
_TRUTH_STEP_S = 0.5


def simulated_walks() -> tuple[str, ...]:
    """Every walk with every seed, as ``NAME?seed=N``."""
    return tuple(f"{walk}?seed={seed}" for walk in WALKS for seed in SEEDS)


def score_simulated(walk: str, tracker: str) -> Score:
    """Run one simulated walk through a tracker and score it against its exact truth."""
    simulation = open_simulation(walk)
    tracking = make_tracker(tracker, simulation.description)
    rows = join_rows([*(tracking.push(batch.imu) for batch in simulation.batches()),
                      tracking.finish()])  # fmt: skip
    t_s = np.arange(rows.t_ns[0] * 1e-9, rows.t_ns[-1] * 1e-9, _TRUTH_STEP_S)
    motion = simulation.truth(t_s)
    start_nb = np.zeros((3, 3))
    rotation_matrix(rows.quaternion_nb[0], start_nb)
    turn = start_nb @ motion.rotation_nb[0].T
    yaw_rad = np.arctan2(turn[1, 0] - turn[0, 1], turn[0, 0] + turn[1, 1])
    c, s = np.cos(yaw_rad), np.sin(yaw_rad)
    to_walk = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    truth = RecordedTruth(t_s, motion.position_n_m @ to_walk.T)
    return score_track(rows, truth, closed_loop=False, heading_known=True)
