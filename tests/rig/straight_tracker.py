"""A unit's pipeline whose tracker has everyone walk north at 1 m/s."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from edge.agent.fitted_sensor import FittedSensor
from edge.agent.pipeline import TrackerPipeline, UnitIdentity
from edge.samples import (
    ImuBatch,
    SensorBatch,
    SensorDescription,
)
from edge.tracker.choice.one_sensor import OneSensorTracker
from edge.tracker.interface import Quality, Reason, TrackBatch
from shared.clock import NS_PER_S, ManualClock
from shared.earth_field import EarthField
from shared.header_factory import HeaderFactory
from shared.path_noise import PathNoise

RATE_HZ = 100
SENSOR = SensorDescription("fake", RATE_HZ)


class StraightAhead:
    """A tracker that has everyone walk north at 1 m/s with a stride a second."""

    path_noise: PathNoise | None = None

    def __init__(self, spoil: bool = False, north_std_rad: float = np.inf) -> None:
        self._spoil = spoil
        self.north_std_rad = north_std_rad
        self.learned: list[tuple[EarthField, int]] = []

    def push(self, batch: ImuBatch) -> TrackBatch:
        n = len(batch)
        t_s = batch.t_ns / NS_PER_S
        position = np.zeros((n, 3))
        position[:, 0] = np.nan if self._spoil else t_s
        return TrackBatch(
            t_ns=batch.t_ns,
            position_n_m=position,
            velocity_n_mps=np.tile([1.0, 0.0, 0.0], (n, 1)),
            quaternion_nb=np.tile([1.0, 0.0, 0.0, 0.0], (n, 1)),
            position_cov_m2=np.tile(np.diag([0.04, 0.01, 0.09]), (n, 1, 1)),
            heading_std_rad=np.full(n, 0.1),
            stationary=t_s % 1.0 < 0.4,
            past_shift_n_m=np.zeros((n, 2)),
            past_turn_rad=np.zeros(n),
            distance_m=t_s,
            steps=np.floor(t_s).astype(np.int64),
            quality=np.full(n, Quality.DEGRADED, np.uint8),
            reasons=np.full(n, Reason.NO_STANCE, np.uint32),
            magnetic_north_rad=np.full(n, 0.3),
            magnetic_north_std_rad=np.full(n, self.north_std_rad),
        )

    def set_earth_field(self, field: EarthField, t_ns: int) -> None:
        self.learned.append((field, t_ns))

    def finish(self) -> TrackBatch:
        return self.push(walk(0))


def walk(n: int, start_s: float = 0.0, shake_mps2: float = 3.0) -> ImuBatch:
    t_ns = (np.arange(n) * NS_PER_S // RATE_HZ) + round(start_s * NS_PER_S)
    accel = np.tile([0.0, 0.0, 9.81], (n, 1))
    accel[:, 0] = shake_mps2 * np.sin(40.0 * t_ns / NS_PER_S)
    accel[:, 1] = 1e-4 * np.arange(n)  # never the same twice
    gyro = np.tile(1e-6 * np.arange(n)[:, np.newaxis], 3)
    return ImuBatch(t_ns, accel, gyro, pressure_pa=np.linspace(0, n - 1, n) + 100_000.0)


def pipeline(tracker=None, rate_hz: float = 5.0) -> TrackerPipeline:
    identity = UnitIdentity("1.0", "test", "straight", (FittedSensor(SENSOR),))
    header_factory = HeaderFactory("u1", 7, ManualClock())
    worn = OneSensorTracker(tracker or StraightAhead())
    return TrackerPipeline(identity, worn, header_factory, rate_hz, foot_sensor="")


def steps(pipe, imu: ImuBatch, sizes: list[int]):
    """All messages when ``imu`` comes in batches of these sizes."""
    messages = []
    cuts = [0, *np.cumsum(sizes).tolist(), len(imu)]
    for start, stop in pairwise(cuts):
        part = ImuBatch(
            imu.t_ns[start:stop],
            imu.accel_mps2[start:stop],
            imu.gyro_radps[start:stop],
            pressure_pa=None if imu.pressure_pa is None else imu.pressure_pa[start:stop],
        )
        messages += pipe.step(SensorBatch(part))
    return messages


def of(messages, kind):
    return [message for message in messages if isinstance(message, kind)]
