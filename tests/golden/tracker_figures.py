"""Trajectories and figures of every registered tracker that change only on purpose.

``python -m tests.golden.tracker_figures`` shows before and after and writes the
new ones; look at every figure that got worse before committing them.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import TypedDict

import numpy as np

from edge.app.track import run_tracker
from edge.sources.recording import RecordingSource, read_truth
from edge.tracker.interface import FOOT, BodyDimensions, TrackBatch
from edge.tracker.registry import (
    MULTI_SENSOR_TRACKERS,
    TRACKERS,
    find_multi_sensor_tracker,
    find_tracker,
    make_multi_sensor_tracker,
)
from tests.bench.tracker.documented_routes import ROUTES
from tests.bench.tracker.scoring import Score, score_track
from tests.bench.tracker.several_sensors import RECORDED_PLACES, track_places
from tests.bench.tracker.simulated_walks import track_simulated
from tests.rig.sensors_of_person import track_person, walk_with_sensors, worn

GOLDEN = Path(__file__).with_name("trackers")  # a file each
TRIALS = (
    "walks/vicon/2017-11-22-11-22-46",  # walking
    "walks/vicon/2017-11-22-11-36-45",  # running
    "walks/vicon/2017-11-22-11-50-42",  # crawling
    "walks/footprints/35",  # sprint, saturated
    "walks/footprints/40",  # late stamps
    "walks/loops/31",  # strides over a second at 250 Hz
    "walks/xio/short_walk",  # repeated samples
    "hard/footprints/30",  # sprint, clipped in rate and force
    "hard/vicon/2018-02-09-11-16-53",  # feet raised and put down slowly
)
SIMULATED = (  # where nobody recorded what a tracker is worn for
    "corridor-174m?seed=0",
    "three-turns-60m?seed=1",
    "five-floors?seed=2",
    "gaits?seed=0",
)
SEVERAL_RECORDED = ("body/ipol/1-1", "body/ipol/5-1")
SEVERAL_SIMULATED = ("court-86m?seed=0", "roundabout-50m?seed=1")
_OF_SEVERAL = [entry.name for entry in MULTI_SENSOR_TRACKERS]
NAMES = [*(entry.name for entry in TRACKERS), *_OF_SEVERAL]
_DIMENSIONS = BodyDimensions(leg_length_m=0.87)  # of the simulated person
FIGURES = (
    "ate_m",
    "vertical_rms_m",
    "closure_horizontal_m",
    "closure_vertical_m",
    "distance_m",
)
EVERY_S = 2.0  # of the trajectories


class Walked(TypedDict):
    """One trial by one tracker."""

    figures: dict[str, float]  # to a tenth of a millimetre
    steps: int
    quality: list[int]  # of the same rows as the path
    path_n_m: list[list[float]]  # to a millimetre, from the first row on


def golden_path(tracker: str) -> Path:
    return GOLDEN / f"{tracker}.json"


def read_golden(tracker: str) -> dict[str, Walked]:
    """Return what was written last; empty for a tracker that has no file yet."""
    path = golden_path(tracker)
    golden: dict[str, Walked] = json.loads(path.read_text()) if path.exists() else {}
    return golden


def measure(data: Path, tracker: str) -> dict[str, Walked]:
    """Track every golden trial of a tracker, recorded ones below ``data``."""
    trials = trials_of(tracker)
    walk: Callable[[str], Walked]
    if trials is SIMULATED:
        walk = partial(_simulated, tracker=tracker)
    elif trials is SEVERAL_SIMULATED:
        walk = partial(_several_simulated, tracker=tracker)
    elif trials is SEVERAL_RECORDED:
        walk = partial(_several_recorded, data, tracker=tracker)
    else:
        walk = partial(_recorded, data, tracker=tracker)
    return {trial: walk(trial) for trial in trials}


def trials_of(tracker: str) -> tuple[str, ...]:
    """Return the golden trials of a tracker."""
    if tracker in RECORDED_PLACES:
        return SEVERAL_RECORDED
    if tracker in _OF_SEVERAL:
        return SEVERAL_SIMULATED
    return TRIALS if FOOT in find_tracker(tracker).worn_on else SIMULATED


def _recorded(data: Path, trial: str, tracker: str) -> Walked:
    source = RecordingSource(data / trial)
    rows = run_tracker(source, tracker, quiet=True)
    closed_loop = source.trial.truth_kind == "closed_loop"
    return _walked(rows, score_track(rows, read_truth(data / trial), closed_loop=closed_loop))


def _simulated(trial: str, tracker: str) -> Walked:
    rows, truth = track_simulated(trial, tracker)
    return _walked(rows, score_track(rows, truth, closed_loop=False))


def _several_recorded(data: Path, trial: str, tracker: str) -> Walked:
    rows = track_places(data / trial, RECORDED_PLACES[tracker], tracker)
    return _walked(rows, score_track(rows, None, closed_loop=True))


def _several_simulated(trial: str, tracker: str) -> Walked:
    name, _, seed = trial.partition("?seed=")
    places = find_multi_sensor_tracker(tracker).places
    walks = walk_with_sensors(ROUTES[name], [choices[0] for choices in places], int(seed))
    tracking = make_multi_sensor_tracker(tracker, worn(walks), _DIMENSIONS)
    samples = {place: walk.sensed() for place, walk in walks.items()}
    rows = track_person(tracking, samples)
    return _walked(rows, score_track(rows, None, closed_loop=True))


def _walked(rows: TrackBatch, score: Score) -> Walked:
    values = asdict(score)
    at = _every(rows)
    path_n_m = rows.position_n_m[at] - rows.position_n_m[0]
    return Walked(
        figures={name: round(values[name], 4) for name in FIGURES if values[name] is not None},
        steps=int(rows.steps[-1]),
        quality=rows.quality[at].tolist(),
        path_n_m=np.round(path_n_m, 3).tolist(),
    )


def _every(rows: TrackBatch) -> list[int]:
    """Return the first row of every ``EVERY_S``."""
    since_s = (rows.t_ns - rows.t_ns[0]) * 1e-9
    first = np.unique(since_s // EVERY_S, return_index=True)[1]
    return [int(row) for row in first]


def main() -> None:
    root = Path(__file__).resolve().parents[2]
    data = Path(os.environ.get("MUSTER_DATA", root.parent / "shared" / "data"))
    GOLDEN.mkdir(exist_ok=True)
    for tracker in NAMES:
        before, after = read_golden(tracker), measure(data, tracker)
        for trial, walked in after.items():
            old = before[trial]["figures"] if trial in before else {}
            for name, value in walked["figures"].items():
                print(f"{tracker} {trial} {name}: {old.get(name)} -> {value}")
        lines = (f"{json.dumps(trial)}: {json.dumps(walked)}" for trial, walked in after.items())
        golden_path(tracker).write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
