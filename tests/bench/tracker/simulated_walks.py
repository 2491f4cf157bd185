"""The documents' walks, simulated, for ``muster bench track --simulated``.

Trackers of a foot walk those of Huang 2009, chapter 4, with sensors as they are and calibrated;
others those of their own documents (``documented_routes``).
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from msgspec.structs import replace

from edge.calibration.correction import Correction
from edge.samples import ImuBatch, SensorDescription
from edge.simulation.factory import open_simulation
from edge.simulation.simulation import Simulation
from edge.sources.recording import RecordedTruth
from edge.tracker.interface import FOOT, TrackBatch
from edge.tracker.mechanization.strapdown import rotation_matrix
from edge.tracker.registry import find_tracker, make_tracker
from edge.tracker.track_rows import join_rows
from tests.bench.tracker.documented_routes import ROUTES
from tests.bench.tracker.scoring import Score, score_track
from tests.bench.tracker.simulated_calibration import calibration_of

WALKS = ("square-60m", "rectangle", "j-shape", "track-400m")
SEEDS = range(3)
CALIBRATED = "&calibrated"
_TRUTH_STEP_S = 0.5


def simulated_walks(tracker: str) -> tuple[str, ...]:
    """Every walk for a tracker with every seed, as ``NAME?seed=N``, ``&calibrated`` or not."""
    if FOOT not in find_tracker(tracker).worn_on:
        return tuple(f"{route}?seed={seed}" for route in ROUTES for seed in SEEDS)
    return tuple(
        f"{walk}?seed={seed}{sensors}"
        for sensors in ("", CALIBRATED)
        for walk in WALKS
        for seed in SEEDS
    )


def score_simulated(walk: str, tracker: str) -> Score:
    """Run one simulated walk through a tracker and score it against its exact truth."""
    rows, truth = track_simulated(walk, tracker)
    # Where a sensor faces on a trunk is not known, so the frame of its attitude is not the path's.
    heading_known = FOOT in find_tracker(tracker).worn_on
    return score_track(rows, truth, closed_loop=False, heading_known=heading_known)


def track_simulated(walk: str, tracker: str) -> tuple[TrackBatch, RecordedTruth]:
    """Return the rows of a walk and the truth in their frame."""
    sensed = _sense(walk, find_tracker(tracker).worn_on[0])
    tracking = make_tracker(tracker, sensed.description)
    rows = join_rows([*map(tracking.push, sensed.imus), tracking.finish()])
    t_s = np.arange(rows.t_ns[0] * 1e-9, rows.t_ns[-1] * 1e-9, _TRUTH_STEP_S)
    motion = sensed.simulation.truth(t_s)
    start_nb = np.zeros((3, 3))
    rotation_matrix(rows.quaternion_nb[0], start_nb)
    turn = start_nb @ motion.rotation_nb[0].T
    yaw_rad = np.arctan2(turn[1, 0] - turn[0, 1], turn[0, 0] + turn[1, 1])
    c, s = np.cos(yaw_rad), np.sin(yaw_rad)
    to_walk = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return rows, RecordedTruth(t_s, motion.position_n_m @ to_walk.T)


class _Sensed(NamedTuple):
    """Samples of the sensor of a walk, calibrated or not."""

    simulation: Simulation
    description: SensorDescription
    imus: tuple[ImuBatch, ...]


@lru_cache(maxsize=32)  # to simulate a walk takes three times as long as to track it
def _sense(walk: str, worn_on: str) -> _Sensed:
    simulation = _open(walk.removesuffix(CALIBRATED), worn_on)
    description = simulation.description
    imus = tuple(batch.imu for batch in simulation.batches())
    if walk.endswith(CALIBRATED):
        calibration = calibration_of(simulation)
        correction = Correction(calibration, description)
        imus = tuple(correction.push(imu) for imu in imus)
        description = calibration.described(description)
    return _Sensed(simulation, description, imus)


def _open(walk: str, worn_on: str) -> Simulation:
    name, _, seed = walk.partition("?seed=")
    if name in ROUTES:
        return Simulation(replace(ROUTES[name], worn_on=worn_on), int(seed))
    return open_simulation(f"{walk}&worn_on={worn_on}")
