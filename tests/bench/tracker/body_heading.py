"""Heading of ``body`` on ten minutes of search with a compass, as worn and after a calibration:

    python -m tests.bench.tracker.body_heading

The direction of each ten seconds of way is compared with the truth's, from that of the first
half minute on, which is held.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from edge.calibration.correction import Correction
from edge.samples import Floats, ImuBatch, SensorDescription
from edge.simulation.legs import Segment
from edge.tracker.body.tracker import BodyTracker
from edge.tracker.track_rows import join_rows
from tests.bench.tracker.simulated_calibration import calibration_of
from tests.rig.inertial_walk import InertialWalk, inertial_walk

PLACES: tuple[Segment, ...] = ("hip", "chest")
SEEDS = (1, 2, 3, 4)
_LASTS_S, _PART_S = 600.0, 10.0
_HELD = 3  # parts at the start
_LEAST_M = 3.0  # of a part that has a direction


def heading_errors_rad(walk: InertialWalk, description: SensorDescription, imu: ImuBatch) -> Floats:
    """Return the errors of direction, one for each part of the walk that has one."""
    tracker = BodyTracker(replace(description, place=walk.description.place))
    rows = join_rows([tracker.push(imu), tracker.finish()])
    ways = _ways(np.asarray(rows.t_ns * 1e-9, np.float64), rows.position_n_m)
    true_ways = _ways(walk.t_s, walk.truth.position_n_m)
    known = (np.abs(ways) > _LEAST_M) & (np.abs(true_ways) > _LEAST_M)
    turned = ways[known] / true_ways[known]
    unit = turned / np.abs(turned)
    errors: Floats = np.angle(unit / np.sum(unit[:_HELD]))
    return errors


def _ways(t_s: Floats, position_n_m: Floats) -> np.ndarray[tuple[int], np.dtype[np.complex128]]:
    """Return the way of each part, north + i east."""
    at_s = np.arange(_PART_S / 2.0, _LASTS_S - _PART_S, _PART_S)
    north_m, east_m = (np.interp(at_s, t_s, position_n_m[:, axis]) for axis in range(2))
    return np.diff(north_m + 1j * east_m)


def _rms_deg(errors_rad: Sequence[Floats]) -> float:
    return float(np.degrees(np.sqrt(np.mean(np.concatenate(errors_rad) ** 2))))


def main() -> None:
    as_worn, calibrated = [], []
    for place in PLACES:
        for seed in SEEDS:
            walk = inertial_walk("search-ground-floor", seed, place, lasts_s=_LASTS_S)
            as_worn.append(heading_errors_rad(walk, walk.description, walk.imu))
            calibration = calibration_of(walk.simulation)
            described = calibration.described(walk.description)
            imu = Correction(calibration, described).push(walk.imu)
            calibrated.append(heading_errors_rad(walk, described, imu))
    print(f"as worn {_rms_deg(as_worn):.1f} deg RMS, calibrated {_rms_deg(calibrated):.1f} deg")


if __name__ == "__main__":
    main()
