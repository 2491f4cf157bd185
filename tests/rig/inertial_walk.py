"""Inertial walks of the simulator: all samples of a sensor, wherever it is worn, and the truth.

What a tracker under test needs of one walk.  ``of_one_person`` has several sensors on one person
who walks once: a lower back and a foot, a chest and a shank.  Paths that units publish, without
any sensor, are made by ``tests.rig.published_path``.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from itertools import takewhile

import msgspec
import numpy as np

from edge.samples import Floats, ImuBatch, SensorDescription
from edge.simulation.body_plan import LEG_LENGTH_M
from edge.simulation.factory import find_scenario
from edge.simulation.kinematics import Motion
from edge.simulation.legs import Segment
from edge.simulation.scenario import Scenario
from edge.simulation.simulation import CONSUMER_SENSORS, SensorErrors, Simulation

_BLOCK_S = 2.0


@dataclass(frozen=True, eq=False)
class InertialWalk:
    """One sensor on one walk; ``truth`` is its own motion at every sample."""

    simulation: Simulation
    description: SensorDescription
    imu: ImuBatch  # accelerometer, gyroscope, magnetometer, barometer, temperature
    truth: Motion
    leg_length_m: float

    @property
    def t_s(self) -> Floats:
        return self.truth.t_s

    def sensed(self, *aids: str) -> ImuBatch:
        """Return the samples of accelerometer and gyroscope, and of the aids named like columns."""
        return only(self.imu, *aids)


def inertial_walk(
    scenario: Scenario | str,
    seed: int = 0,
    worn_on: Segment | None = None,
    sensors: SensorErrors = CONSUMER_SENSORS,
    number: int = 0,
    lasts_s: float = math.inf,
    **changes: object,
) -> InertialWalk:
    """Return the walk of a scenario, or of the built-in one of that name.

    ``changes`` replace fields of the scenario, such as ``duration_s`` or ``rate_hz``; ``number``
    tells sensors apart that one person wears; ``lasts_s``: the walk is cut there.
    """
    if isinstance(scenario, str):
        scenario = find_scenario(scenario)
    if worn_on is not None:
        changes["worn_on"] = worn_on
    simulation = Simulation(msgspec.structs.replace(scenario, **changes), seed, sensors, number)
    imu = samples(simulation, lasts_s=lasts_s)
    truth = simulation.truth(np.asarray(imu.t_ns * 1e-9, np.float64))
    return InertialWalk(simulation, simulation.description, imu, truth, LEG_LENGTH_M)


def of_one_person(
    scenario: Scenario | str, worn_on: Sequence[Segment], seed: int = 0
) -> list[InertialWalk]:
    """Return the same walk as sensors on several segments have it, each with its own errors."""
    return [
        inertial_walk(scenario, seed, segment, number=number)
        for number, segment in enumerate(worn_on)
    ]


def inertial_samples(simulation: Simulation) -> ImuBatch:
    """Return what accelerometer and gyroscope measure on the whole walk."""
    return only(samples(simulation))


def only(imu: ImuBatch, *aids: str) -> ImuBatch:
    """Return the samples of accelerometer and gyroscope, and of the aids named like columns."""
    kept = {name: getattr(imu, name) for name in aids}
    return ImuBatch(imu.t_ns, imu.accel_mps2, imu.gyro_radps, **kept)


def samples(
    simulation: Simulation, block_s: float = _BLOCK_S, lasts_s: float = math.inf
) -> ImuBatch:
    """Return all that the simulated unit samples with its inertial sensors, until ``lasts_s``.

    The noise is drawn block by block.
    """
    blocks = simulation.batches(block_s)
    parts = [batch.imu for batch in takewhile(lambda one: one.imu.t_ns[0] < lasts_s * 1e9, blocks)]
    return ImuBatch(
        *(
            np.concatenate([getattr(part, field.name) for part in parts])
            for field in fields(ImuBatch)
        )
    )


def motion_at(truth: Motion, rows: slice) -> Motion:
    """Return the truth at some of its times."""
    return Motion(*(getattr(truth, field.name)[rows] for field in fields(Motion)))
