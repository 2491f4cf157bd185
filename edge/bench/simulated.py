"""The thesis's walks (Huang 2009, chapter 4), simulated, for ``muster bench track --simulated``."""

from __future__ import annotations

import numpy as np

from edge.bench.scoring import Score, score_track
from edge.simulation import open_simulation
from edge.sources.recording import RecordedTruth
from edge.tracker import make_tracker
from edge.tracker.rows import join_rows

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
    truth = RecordedTruth(t_s, simulation.truth(t_s).position_n_m)
    return score_track(rows, truth, closed_loop=False)
