"""Perturbations of recorded walks: another sensor, another person.

Each perturbation takes a description, samples and a generator and gives both as the worse
sensor would have; all of a trial's perturbations are the same in every run.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from edge.samples import Floats, ImuBatch, SensorDescription

Made = tuple[SensorDescription, ImuBatch]
Change = Callable[[SensorDescription, ImuBatch, np.random.Generator], Made]

CUT_S = 3.0
BIAS_RADPS = np.radians(0.5)
ACCEL_SCALE = 0.03
CLIPPED_AT = 0.7  # of the recording's largest reading
SPIKES = 0.001  # of the samples
LEAST_FULL_SCALE_MPS2 = 2.0 * 9.81  # of accelerometers that are made
HOLE_AT_S = 10.0
JITTER = 0.5  # of a sample interval


@dataclass(frozen=True, slots=True)
class Perturbation:
    name: str
    apply: Change


def as_recorded(description: SensorDescription, imu: ImuBatch, _: np.random.Generator) -> Made:
    return description, imu


def other_mount(description: SensorDescription, imu: ImuBatch, rng: np.random.Generator) -> Made:
    """Any rotation; by right angles where a full scale is told along the axes."""
    rotation = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    if description.gyro_full_scale_radps is not None:
        rotation = np.eye(3)[rng.permutation(3)]
    rotation[0] *= np.linalg.det(rotation)
    return description, _with(imu, imu.accel_mps2 @ rotation.T, imu.gyro_radps @ rotation.T)


def late_start(description: SensorDescription, imu: ImuBatch, _: np.random.Generator) -> Made:
    first = int(np.searchsorted(imu.t_ns, imu.t_ns[0] + round(1e9 * CUT_S)))
    return description, imu.part(slice(first, None))


def late_and_biased(
    description: SensorDescription, imu: ImuBatch, rng: np.random.Generator
) -> Made:
    return gyro_bias(2.0 * BIAS_RADPS)(*late_start(description, imu, rng), rng)


def gyro_bias(bias_radps: float) -> Change:
    """Off by so much about any axis."""

    def change(description: SensorDescription, imu: ImuBatch, rng: np.random.Generator) -> Made:
        axis = rng.normal(size=3)
        off_radps = bias_radps * axis / np.linalg.norm(axis)
        return description, _with(imu, imu.accel_mps2, imu.gyro_radps + off_radps)

    return change


def accel_scale(description: SensorDescription, imu: ImuBatch, rng: np.random.Generator) -> Made:
    scale = 1.0 + ACCEL_SCALE * rng.choice((-1.0, 1.0), 3)
    return description, _with(imu, scale * imu.accel_mps2, imu.gyro_radps)


def gyro_scale(share: float) -> Change:
    """Every axis off by ``share``, up or down."""

    def change(description: SensorDescription, imu: ImuBatch, rng: np.random.Generator) -> Made:
        scale = 1.0 + share * rng.choice((-1.0, 1.0), 3)
        return description, _with(imu, imu.accel_mps2, scale * imu.gyro_radps)

    return change


def gyro_scale_of_all_axes(share: float) -> Change:
    """All axes off by ``share`` alike, up or down: what landings show least."""

    def change(description: SensorDescription, imu: ImuBatch, rng: np.random.Generator) -> Made:
        scale = 1.0 + share * rng.choice((-1.0, 1.0))
        return description, _with(imu, imu.accel_mps2, scale * imu.gyro_radps)

    return change


def thrice_the_noise(
    description: SensorDescription, imu: ImuBatch, rng: np.random.Generator
) -> Made:
    def noisier(readings: Floats) -> Floats:
        added = np.sqrt(8.0) * _quietest_std(readings, description.rate_hz)
        return np.asarray(readings + added * rng.normal(size=readings.shape))

    return description, _with(imu, noisier(imu.accel_mps2), noisier(imu.gyro_radps))


def gyro_clipped(description: SensorDescription, imu: ImuBatch, _: np.random.Generator) -> Made:
    full_scale = CLIPPED_AT * float(np.nanmax(np.abs(imu.gyro_radps)))
    clipped = np.clip(imu.gyro_radps, -full_scale, full_scale)
    reported = replace(description, gyro_full_scale_radps=full_scale)
    return reported, _with(imu, imu.accel_mps2, clipped)


def gyro_clipped_undeclared(
    description: SensorDescription, imu: ImuBatch, rng: np.random.Generator
) -> Made:
    _, clipped = gyro_clipped(description, imu, rng)
    return replace(description, gyro_full_scale_radps=None), clipped


def accel_clipped(description: SensorDescription, imu: ImuBatch, _: np.random.Generator) -> Made:
    full_scale = CLIPPED_AT * float(np.nanmax(np.abs(imu.accel_mps2)))
    clipped = np.clip(imu.accel_mps2, -full_scale, full_scale)
    reported = replace(description, accel_full_scale_mps2=full_scale)
    return reported, _with(imu, clipped, imu.gyro_radps)


def accel_clipped_undeclared(
    description: SensorDescription, imu: ImuBatch, rng: np.random.Generator
) -> Made:
    _, clipped = accel_clipped(description, imu, rng)
    return replace(description, accel_full_scale_mps2=None), clipped


def accel_of_2_g_undeclared(
    description: SensorDescription, imu: ImuBatch, _: np.random.Generator
) -> Made:
    clipped = np.clip(imu.accel_mps2, -LEAST_FULL_SCALE_MPS2, LEAST_FULL_SCALE_MPS2)
    undeclared = replace(description, accel_full_scale_mps2=None)
    return undeclared, _with(imu, clipped, imu.gyro_radps)


def samples_lost(share: float) -> Change:
    """Here and there one."""

    def change(description: SensorDescription, imu: ImuBatch, rng: np.random.Generator) -> Made:
        kept = rng.random(len(imu)) >= share
        return description, _only(imu, kept)

    return change


def hole(lasts_s: float) -> Change:
    """All samples of so long are lost."""

    def change(description: SensorDescription, imu: ImuBatch, _: np.random.Generator) -> Made:
        since_s = 1e-9 * (imu.t_ns - imu.t_ns[0])
        return description, _only(imu, np.abs(since_s - HOLE_AT_S) > lasts_s / 2.0)

    return change


def holes(lasts_s: float, every_s: float) -> Change:
    """All samples of so long are lost, again and again."""

    def change(description: SensorDescription, imu: ImuBatch, _: np.random.Generator) -> Made:
        since_s = 1e-9 * (imu.t_ns - imu.t_ns[0])
        return description, _only(imu, (since_s + 0.5 * every_s) % every_s >= lasts_s)

    return change


def gyro_spikes(description: SensorDescription, imu: ImuBatch, rng: np.random.Generator) -> Made:
    """Some samples have any rate of the recording's range on one axis."""
    gyro_radps = imu.gyro_radps.copy()
    rows = np.flatnonzero(rng.random(len(imu)) < SPIKES)
    highest_radps = np.abs(gyro_radps).max()
    rates_radps = rng.uniform(-highest_radps, highest_radps, len(rows))
    gyro_radps[rows, rng.integers(3, size=len(rows))] = rates_radps
    return description, _with(imu, imu.accel_mps2, gyro_radps)


def hangs(columns: slice, lasts_s: float) -> Change:
    """Repeat one reading of the accelerometer's (0 to 2) or gyroscope's axes (3 to 5)."""

    def change(description: SensorDescription, imu: ImuBatch, _: np.random.Generator) -> Made:
        since_s = 1e-9 * (imu.t_ns - imu.t_ns[0])
        rows = np.flatnonzero((since_s >= HOLE_AT_S) & (since_s < HOLE_AT_S + lasts_s))
        readings = np.hstack((imu.accel_mps2, imu.gyro_radps))
        readings[rows, columns] = readings[rows[:1], columns]
        return description, _with(imu, readings[:, :3], readings[:, 3:])

    return change


def late_stamps(description: SensorDescription, imu: ImuBatch, rng: np.random.Generator) -> Made:
    late_ns = JITTER * 1e9 / description.rate_hz * rng.random(len(imu))
    t_ns = np.maximum.accumulate(imu.t_ns + late_ns.astype(np.int64))
    return description, ImuBatch(t_ns, imu.accel_mps2, imu.gyro_radps)


def slower(rate_hz: float, *, filtered: bool) -> Change:
    """About ``rate_hz``: means of consecutive samples, or every so manieth as it is."""

    def change(description: SensorDescription, imu: ImuBatch, _: np.random.Generator) -> Made:
        every = max(1, round(description.rate_hz / rate_hz))
        reported = replace(description, rate_hz=description.rate_hz / every)
        if not filtered:
            return reported, ImuBatch(
                imu.t_ns[::every], imu.accel_mps2[::every], imu.gyro_radps[::every]
            )
        even = _evenly(imu, description.rate_hz)
        count = len(even) // every * every
        return reported, ImuBatch(
            even.t_ns[:count].reshape(-1, every).mean(axis=1).astype(np.int64),
            even.accel_mps2[:count].reshape(-1, every, 3).mean(axis=1),
            even.gyro_radps[:count].reshape(-1, every, 3).mean(axis=1),
        )

    return change


PERTURBATIONS: tuple[Perturbation, ...] = (
    Perturbation("as recorded", as_recorded),
    Perturbation("another mount", other_mount),
    Perturbation("first 3 s missing", late_start),
    Perturbation("the same, gyroscope 1 deg/s off", late_and_biased),
    Perturbation("gyroscope 0.5 deg/s off", gyro_bias(BIAS_RADPS)),
    Perturbation("accelerometer scale 3 % off", accel_scale),
    Perturbation("gyroscope scale 1 % off", gyro_scale(0.01)),
    Perturbation("gyroscope scale 3 % off", gyro_scale(0.03)),
    Perturbation("noise x 3", thrice_the_noise),
    Perturbation("gyroscope clips at 70 %", gyro_clipped),
    Perturbation("the same, undeclared", gyro_clipped_undeclared),
    Perturbation("accelerometer clips at 70 %", accel_clipped),
    Perturbation("accelerometer so, undeclared", accel_clipped_undeclared),
    Perturbation("accelerometer of 2 g, undeclared", accel_of_2_g_undeclared),
    Perturbation("1 % of samples lost", samples_lost(0.01)),
    Perturbation("10 % of samples lost", samples_lost(0.1)),
    Perturbation("0.05 s lost every 2 s", holes(0.05, 2.0)),
    Perturbation("0.15 s lost at once", hole(0.15)),
    Perturbation("0.4 s lost at once", hole(0.4)),
    Perturbation("0.1 % of rates are spikes", gyro_spikes),
    Perturbation("accelerometer hangs for 0.3 s", hangs(slice(0, 3), 0.3)),
    Perturbation("gyroscope hangs for 0.3 s", hangs(slice(3, 6), 0.3)),
    Perturbation("an axis of it hangs for 2 s", hangs(slice(4, 5), 2.0)),
    Perturbation("stamps late by half a sample", late_stamps),
    Perturbation("100 Hz, filtered", slower(100.0, filtered=True)),
    Perturbation("66 Hz, filtered", slower(66.0, filtered=True)),
    Perturbation("66 Hz, unfiltered", slower(66.0, filtered=False)),
    Perturbation("gyroscope scale alike, 1 % off", gyro_scale_of_all_axes(0.01)),
    Perturbation("gyroscope scale alike, 3 % off", gyro_scale_of_all_axes(0.03)),
)


def _only(imu: ImuBatch, kept: NDArray[np.bool_]) -> ImuBatch:
    return ImuBatch(imu.t_ns[kept], imu.accel_mps2[kept], imu.gyro_radps[kept])


def _with(imu: ImuBatch, accel_mps2: Floats, gyro_radps: Floats) -> ImuBatch:
    return ImuBatch(imu.t_ns, accel_mps2, gyro_radps)


def _quietest_std(readings: Floats, rate_hz: float) -> Floats:
    """Return the noise (3,) of the quietest half second, by its differences."""
    window = max(2, round(rate_hz / 2.0))
    count = (len(readings) - 1) // window * window
    steps = np.diff(readings, axis=0)[:count].reshape(-1, window, 3)
    stds: Floats = np.std(steps, axis=1) / np.sqrt(2.0)
    quietest: Floats = stds[np.argmin(stds.sum(axis=1))]
    return quietest


def _evenly(imu: ImuBatch, rate_hz: float) -> ImuBatch:
    """Return the samples at even times; repeated ones would count twice in a mean."""
    new = np.r_[True, np.diff(imu.t_ns) > 0]
    t_s = imu.t_ns[new] * 1e-9
    even_s = np.arange(t_s[0], t_s[-1], 1.0 / rate_hz)

    def at(readings: Floats) -> Floats:
        axes = [np.interp(even_s, t_s, readings[new, axis]) for axis in range(3)]
        return np.column_stack(axes)

    return ImuBatch(np.rint(1e9 * even_s).astype(np.int64), at(imu.accel_mps2), at(imu.gyro_radps))
