"""Stillness, posture and falls from samples alone."""

from __future__ import annotations

import numpy as np
import pytest

from edge.activity import ActivityMonitor
from edge.body_motion import BodyMotion
from edge.falls import FallDetector
from edge.samples import ImuBatch
from edge.sources import open_source
from edge.sources.recording import RecordingSource
from edge.tracker import make_tracker
from edge.tracker.rows import empty_rows
from shared.clock import NS_PER_S
from shared.messages import Activity

RATE_HZ = 100


def samples(duration_s: float, start_s: float = 0.0, force=(0.0, 0.0, 9.81), shake=0.0):
    n = round(duration_s * RATE_HZ)
    t_ns = np.arange(n) * (NS_PER_S // RATE_HZ) + round(start_s * NS_PER_S)
    noise = np.random.default_rng(1).normal(0.0, 1.0, (n, 6))
    accel = np.array(force) + (0.05 + shake) * noise[:, :3]
    return ImuBatch(t_ns, accel, (0.01 + 0.1 * shake) * noise[:, 3:])


def test_noise_is_no_motion_and_motion_starts_the_count_again():
    motion = BodyMotion()
    motion.push(samples(10.5))
    assert motion.motionless_s == pytest.approx(10.0)
    motion.push(samples(1.0, 10.5, shake=1.0))
    motion.push(samples(0.6, 11.5))
    assert motion.motionless_s <= 0.5


def test_a_foot_that_is_turned_slowly_moves():
    motion = BodyMotion()
    for second in range(10):
        tilt = 0.3 * second
        motion.push(samples(1.0, second, (0.0, 9.81 * np.sin(tilt), 9.81 * np.cos(tilt))))
    assert motion.motionless_s <= 1.0


def test_samples_that_say_nothing_count_neither_way():
    motion = BodyMotion()
    motion.push(samples(5.5))
    before_s = motion.motionless_s
    silent = samples(5.0, 5.5)
    motion.push(ImuBatch(silent.t_ns, np.full((500, 3), np.nan), silent.gyro_radps))
    motion.push(samples(0.01, 10.5))
    assert motion.motionless_s == pytest.approx(before_s + 0.5)


@pytest.mark.parametrize(
    ("weightless_s", "after_force", "after_shake", "falls"),
    [
        (0.4, (9.81, 0.0, 0.0), 0.0, 1),  # down, and stays down
        (0.4, (0.0, 0.0, 9.81), 3.0, 0),  # a jump: walks on
        (0.1, (9.81, 0.0, 0.0), 0.0, 0),  # a step
    ],
)
def test_a_fall_is_a_drop_a_blow_and_nobody_who_walks_on(
    weightless_s, after_force, after_shake, falls
):
    monitor = ActivityMonitor()
    pieces = (
        samples(2.0, 0.0, shake=1.0),
        samples(weightless_s, 2.0, (0.0, 0.0, 0.5)),
        samples(0.05, 2.0 + weightless_s, (0.0, 0.0, 60.0)),
    )
    told = sum(monitor.push(piece, empty_rows()) for piece in pieces)
    end_s = 2.05 + weightless_s
    assert (monitor.activity(0) is Activity.FALLING) == (weightless_s > 0.25)
    told += monitor.push(samples(12.0, end_s, after_force, after_shake), empty_rows())
    assert told == falls
    assert monitor.activity(0) is not Activity.FALLING


def test_a_blow_without_a_drop_is_no_fall():
    falls = FallDetector()
    falls.push(samples(0.05, 0.0, (0.0, 0.0, 80.0)))
    assert not falls.falling


def activities(source, until_s: float) -> tuple[list[Activity], int]:
    """Each second's activity, and the falls told."""
    tracker = make_tracker("eskf", source.description)
    monitor = ActivityMonitor()
    each: list[Activity] = []
    falls = 0
    for batch in source.batches():
        t_ns = int(batch.imu.t_ns[-1])
        if t_ns > until_s * NS_PER_S:
            break
        falls += monitor.push(batch.imu, tracker.push(batch.imu))
        if t_ns // NS_PER_S > len(each):
            each.append(monitor.activity(t_ns))
    return each, falls


def test_a_simulated_collapse_is_a_fall_and_then_lying():
    each, falls = activities(open_source("simulated:goes-down"), 60.0)
    assert falls == 1
    assert Activity.WALKING in each[:20]
    assert set(each[30:]) == {Activity.LYING}


def test_a_simulated_search_has_no_falls_and_nobody_lies():
    each, falls = activities(open_source("simulated:search-ground-floor"), 90.0)
    assert falls == 0
    assert set(each) <= {Activity.UNKNOWN, Activity.STILL, Activity.WALKING}


def test_recorded_walks_hold_walking_and_no_falls(walks):
    folders = sorted(path.parent for path in walks.glob("*/*/imu.csv.gz"))[::6]
    assert folders
    for folder in folders:
        each, falls = activities(RecordingSource(folder), 60.0)
        assert falls == 0, folder
        assert Activity.LYING not in each, folder
        walked = sum(each.count(kind) for kind in (Activity.WALKING, Activity.RUNNING))
        assert walked > 0.5 * len(each), folder
