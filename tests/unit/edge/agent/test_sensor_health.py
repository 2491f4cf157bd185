"""Faults of the inertial sensor that last are told once, however its samples are cut up."""

from __future__ import annotations

import re

import numpy as np
import pytest

from edge.agent.sensor_health import SensorHealth
from edge.samples import ImuBatch
from shared.clock import NS_PER_S
from tests.rig.stepped_sensor_health import SteppedSensorHealth

RATE_HZ = 100


def samples(seconds: float, *, spoilt: str = "", from_s: float = 0.0) -> ImuBatch:
    count = round(seconds * RATE_HZ)
    rows = np.random.default_rng(3).normal(size=(count, 6))
    if spoilt == "stuck":
        rows[:] = 1.0
    elif spoilt == "unusable":
        rows[:] = np.nan
    t_ns = round(from_s * NS_PER_S) + np.arange(count) * (NS_PER_S // RATE_HZ)
    return ImuBatch(t_ns, rows[:, :3], rows[:, 3:])


def reported(health: SensorHealth, imu: ImuBatch, at_once: int = 7) -> list[str]:
    parts = [imu.part(slice(row, row + at_once)) for row in range(0, len(imu), at_once)]
    return [fault for part in parts for fault in health.push(part)]


@pytest.mark.parametrize(
    ("spoilt", "word", "lasts_s"), [("stuck", "repeated", 1.02), ("unusable", "no usable", 1.01)]
)
def test_fault_of_a_second_is_reported_once_and_again_when_it_recurs(
    spoilt: str, word: str, lasts_s: float
) -> None:
    health = SensorHealth()
    assert reported(health, samples(2.0)) == []
    assert reported(health, samples(lasts_s - 0.01, spoilt=spoilt, from_s=2.0)) == []
    assert reported(health, samples(1.0, from_s=3.5)) == []
    (fault,) = reported(health, samples(5.0, spoilt=spoilt, from_s=4.5))
    assert word in fault
    assert reported(health, samples(1.0, from_s=9.5)) == []
    assert len(reported(health, samples(lasts_s, spoilt=spoilt, from_s=10.5))) == 1


@pytest.mark.parametrize(("spoilt", "word"), [("stuck", "repeated"), ("unusable", "no usable")])
def test_a_sensor_that_never_worked_is_reported(spoilt: str, word: str) -> None:
    (fault,) = reported(SensorHealth(), samples(5.0, spoilt=spoilt))
    assert word in fault


@pytest.mark.parametrize(
    ("next_s", "words"),
    [(1.98, []), (2.1, ["no inertial sample for 1.1 s"]), (0.0, []), (-0.1, ["back by 1.1 s"])],
)
def test_a_hole_in_time_is_reported_and_a_small_one_is_not(next_s: float, words: list[str]) -> None:
    health = SensorHealth()
    reported(health, samples(1.01))
    found = reported(health, samples(0.1, from_s=next_s))
    assert len(found) == len(words)
    assert all(word in fault for word, fault in zip(words, found, strict=True))


@pytest.mark.parametrize(
    ("hung", "sensor"),
    [
        (slice(0, 3), "accelerometer"),
        (slice(3, 6), "gyroscope"),
        (slice(1, 2), "accelerometer"),
        (slice(5, 6), "gyroscope"),
    ],
)
def test_sensor_stuck_during_motion_is_reported_once(hung: slice, sensor: str) -> None:
    rows = moving()
    rows[150:, hung] = 1.0
    rows[200] = np.nan  # one that was lost begins anew
    (fault,) = reported(SensorHealth(), imu_of(rows))
    assert fault.startswith(f"the {sensor} has repeated")
    rows[320:] = moving()[320:]
    rows[370:, hung] = 0.0
    assert len(reported(SensorHealth(), imu_of(rows))) == 2


@pytest.mark.parametrize("hung", [slice(0, 3), slice(3, 6), slice(1, 2), slice(5, 6)])
def test_a_coarse_sensor_that_lies_still_repeats_itself_and_is_well(hung: slice) -> None:
    rows = 0.1 * np.random.default_rng(3).normal(size=(60 * RATE_HZ, 6))
    rows[:, hung] = 1.0
    assert reported(SensorHealth(), imu_of(rows)) == []


@pytest.mark.parametrize("hung", [slice(0, 3), slice(3, 6)])
def test_motion_during_a_gap_is_unknown(hung: slice) -> None:
    """It lies as it did before, on a coarse sensor, and was turned while nobody saw it."""
    rows = 0.1 * np.random.default_rng(3).normal(size=(4 * RATE_HZ, 6))
    rows[:, hung] = 1.0
    turned = slice(200, 205)
    rows[turned, slice(3, 6) if hung.start == 0 else slice(0, 3)] += 5.0
    imu = imu_of(rows)
    imu.t_ns[turned.start :] += 3 * NS_PER_S
    (hole,) = reported(SensorHealth(), imu)
    assert hole.startswith("no inertial sample for 3.0 s")


def test_an_axis_in_which_nothing_was_made_to_move_is_well() -> None:
    rows = moving()
    rows[:, (1, 5)] = 0.0  # a walk in a plane
    rows[100] = np.nan  # a sample that was missed shows nothing either
    assert reported(SensorHealth(), imu_of(rows)) == []


def test_whole_batches_show_the_same_faults_as_sample_by_sample() -> None:
    seen = set[str]()
    for seed in range(40):
        rng = np.random.default_rng(seed)
        imu = spoilt_at_random(rng)
        health, stepped = SensorHealth(), SteppedSensorHealth()
        begin = 0
        while begin < len(imu):
            end = begin + int(rng.choice([1, 4, 7, 100, 400]))
            part = imu.part(slice(begin, end))
            faults = stepped.push(part)
            assert health.push(part) == faults, (seed, begin)
            begin = end
            seen |= {re.sub(r"[0-9.]+ s", "", fault) for fault in faults}
    assert len(seen) == 6


def spoilt_at_random(rng: np.random.Generator) -> ImuBatch:
    """Half a minute with lasting faults of every kind, one upon the other."""
    rows = moving_for(30.0, rng)
    t_ns = np.arange(len(rows)) * (NS_PER_S // RATE_HZ)
    if rng.random() < 0.3:
        rows[: rng.integers(1, 1000), rng.integers(6)] = 0.0  # an axis that starts later
    for _ in range(rng.integers(1, 25)):
        first = int(rng.integers(len(rows)))
        until = first + int(rng.choice([1, 20, 99, 100, 101, 102, 250, 700]))
        axes = [slice(0, 6), slice(0, 3), slice(3, 6), slice(1, 2), slice(5, 6)][rng.integers(5)]
        match rng.integers(5):
            case 0:
                rows[first:until, axes] = rng.choice([0.0, 1.0, 1e300])
            case 1:
                rows[first:until, axes] = rng.choice([np.nan, np.inf, -np.inf])
            case 2:
                rows[first:until] *= 0.01  # at rest
            case 3:
                t_ns[first:] += round(rng.choice([0.05, 0.2, 0.99, 1.5, 3.0]) * NS_PER_S)
            case 4:
                t_ns[first:] -= round(rng.choice([0.05, 0.99, 1.5]) * NS_PER_S)
    return ImuBatch(t_ns, rows[:, :3], rows[:, 3:])


def moving_for(seconds: float, rng: np.random.Generator) -> np.ndarray:
    spread = np.array([5.0, 5.0, 5.0, 2.0, 2.0, 2.0])
    return spread * rng.normal(size=(round(seconds * RATE_HZ), 6))


def moving() -> np.ndarray:
    """Accelerations and rates of 5 s."""
    return moving_for(5.0, np.random.default_rng(3))


def imu_of(rows: np.ndarray) -> ImuBatch:
    t_ns = np.arange(len(rows)) * (NS_PER_S // RATE_HZ)
    return ImuBatch(t_ns, rows[:, :3], rows[:, 3:])
