"""Several sensors on one simulated person, and their samples as a unit would push them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from edge.samples import ImuBatch
from edge.simulation.scenario import Scenario
from edge.tracker.interface import (
    LEFT_FOOT,
    RIGHT_FOOT,
    MultiSensorTracker,
    TrackBatch,
    WornSensor,
)
from edge.tracker.track_rows import join_rows
from tests.rig.inertial_walk import InertialWalk, inertial_walk, motion_at

BLOCK_S = 0.1
HALF_STRIDE_S = 0.54
_SEGMENTS: dict[str, Any] = {LEFT_FOOT: "foot", RIGHT_FOOT: "foot"}


def walk_with_sensors(
    scenario: Scenario | str, places: Sequence[str], seed: int = 0, **changes: Any
) -> dict[str, InertialWalk]:
    """Return the walk of one person as sensors at several places have it, by place.

    The simulated person has one foot; the other one makes the same strides half a stride earlier.
    """
    walks = {
        place: inertial_walk(scenario, seed, _SEGMENTS.get(place, place), number=number, **changes)
        for number, place in enumerate(places)
    }
    if RIGHT_FOOT in walks:
        walks[RIGHT_FOOT] = _earlier(walks[RIGHT_FOOT], HALF_STRIDE_S)
    stop = min(len(walk.imu) for walk in walks.values())
    return {place: _part(walk, slice(0, stop)) for place, walk in walks.items()}


def _earlier(walk: InertialWalk, by_s: float) -> InertialWalk:
    walk = _part(walk, slice(int(np.searchsorted(walk.imu.t_ns, round(by_s * 1e9))), None))
    imu = replace(walk.imu, t_ns=walk.imu.t_ns - walk.imu.t_ns[0])
    return replace(
        walk, imu=imu, truth=replace(walk.truth, t_s=np.asarray(imu.t_ns * 1e-9, np.float64))
    )


def _part(walk: InertialWalk, rows: slice) -> InertialWalk:
    return replace(walk, imu=walk.imu.part(rows), truth=motion_at(walk.truth, rows))


def worn(walks: Mapping[str, InertialWalk]) -> dict[str, WornSensor]:
    """Return the sensors of a walk, each named after its place."""
    return {place: WornSensor(walk.description, place) for place, walk in walks.items()}


def in_turn(
    samples: Mapping[str, ImuBatch], block_s: float = BLOCK_S
) -> Iterator[tuple[str, ImuBatch]]:
    """Give the samples of all sensors block by block, as they would come."""
    begin_ns = min(int(imu.t_ns[0]) for imu in samples.values())
    stop_ns = max(int(imu.t_ns[-1]) for imu in samples.values()) + 1
    block_ns = round(block_s * 1e9)
    for from_ns in range(begin_ns, stop_ns, block_ns):
        for name, imu in samples.items():
            first, last = np.searchsorted(imu.t_ns, [from_ns, from_ns + block_ns])
            if first < last:
                yield name, imu.part(slice(int(first), int(last)))


def track_person(
    tracker: MultiSensorTracker, samples: Mapping[str, ImuBatch], block_s: float = BLOCK_S
) -> TrackBatch:
    """Return all rows of a tracker that is given all samples."""
    batches = [tracker.push(name, batch) for name, batch in in_turn(samples, block_s)]
    return join_rows([*batches, tracker.finish()])
