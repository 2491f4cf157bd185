"""Stillness, posture and falls from samples alone."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from edge.activity.body_motion import BodyMotion
from edge.activity.falls import FallDetector
from edge.activity.monitor import ActivityMonitor
from edge.activity.strides import StrideCutter
from edge.samples import ImuBatch
from edge.simulation.factory import open_simulation
from edge.sources.recording import RecordedTruth, RecordingSource, read_truth
from edge.sources.registry import open_source
from edge.sources.simulated import SimulatedSource
from edge.tracker.registry import make_tracker
from edge.tracker.track_rows import empty_rows
from shared.clock import NS_PER_S
from shared.messages import Activity
from tests.bench.tracker.activity_scoring import ActivityScore, recorded_label, score_activity

RATE_HZ = 100


def samples(duration_s: float, start_s: float = 0.0, force=(0.0, 0.0, 9.81), shake=0.0):
    n = round(duration_s * RATE_HZ)
    t_ns = np.arange(n) * (NS_PER_S // RATE_HZ) + round(start_s * NS_PER_S)
    noise = np.random.default_rng(1).normal(0.0, 1.0, (n, 6))
    accel = np.array(force) + (0.05 + shake) * noise[:, :3]
    return ImuBatch(t_ns, accel, (0.01 + 0.1 * shake) * noise[:, 3:])


def test_noise_is_no_motion_and_motion_restarts_the_count():
    motion = BodyMotion()
    motion.push(samples(10.5))
    assert motion.motionless_s == pytest.approx(10.0)
    motion.push(samples(1.0, 10.5, shake=1.0))
    motion.push(samples(0.6, 11.5))
    assert motion.motionless_s <= 0.5


@pytest.mark.parametrize("column", range(6))
@pytest.mark.parametrize("times", [0.6, 1.6])
def test_each_axis_alone_distinguishes_motion_from_noise(column, times):
    """0.4 m/s2 or 0.12 rad/s: more than any sensor's noise, less than any step."""
    imu = samples(5.5)
    felt = np.zeros((len(imu), 6))
    amplitude = times * (0.4 if column < 3 else 0.12)
    felt[:, column] = amplitude * np.where(np.arange(len(imu)) % 2, 1.0, -1.0)
    motion = BodyMotion()
    motion.push(replace(imu, accel_mps2=felt[:, :3] + [0.0, 0.0, 9.81], gyro_radps=felt[:, 3:]))
    assert motion.motionless_s == (5.0 if times < 1.0 else 0.0)


@pytest.mark.parametrize("axis", range(3))
def test_quickest_instant_of_half_a_second_counts_about_any_axis(axis):
    imu = samples(0.6)
    imu.gyro_radps[20, axis] = -3.0
    (window,) = BodyMotion().push(imu)
    assert window.peak_rate_radps == pytest.approx(3.0, abs=0.05)


def test_slowly_turned_foot_moves():
    motion = BodyMotion()
    for second in range(10):
        tilt = 0.3 * second
        motion.push(samples(1.0, second, (0.0, 9.81 * np.sin(tilt), 9.81 * np.cos(tilt))))
    assert motion.motionless_s <= 1.0


def test_missing_values_count_neither_way():
    motion = BodyMotion()
    motion.push(samples(5.5))
    before_s = motion.motionless_s
    silent = samples(5.0, 5.5)
    motion.push(ImuBatch(silent.t_ns, np.full((500, 3), np.nan), silent.gyro_radps))
    motion.push(samples(0.01, 10.5))
    assert motion.motionless_s == pytest.approx(before_s + 0.5)


def test_failed_gyroscope_does_not_hide_stillness():
    motion = BodyMotion()
    pieces = samples(5.5), samples(5.0, 5.5), samples(1.0, 10.5, shake=1.0), samples(0.6, 11.5)
    motionless_s = []
    for piece in pieces:
        motion.push(replace(piece, gyro_radps=np.full((len(piece), 3), np.nan)))
        motionless_s.append(motion.motionless_s)
    assert motionless_s == [5.0, 10.0, 0.0, 0.5]


def test_fall_that_breaks_the_gyroscope_is_found():
    monitor = ActivityMonitor()
    monitor.push(samples(2.0, shake=1.0), empty_rows())
    monitor.push(samples(0.4, 2.0, (0.0, 0.0, 0.5)), empty_rows())
    after = np.concatenate(
        (samples(0.05, 2.4, (0.0, 0.0, 60.0)).accel_mps2, samples(6.0).accel_mps2)
    )
    imu = ImuBatch(samples(6.05, 2.4).t_ns, after, np.full((605, 3), np.nan))
    assert monitor.push(imu, empty_rows()) == 1


@pytest.mark.parametrize(
    ("weightless_s", "after_force", "after_shake", "falls"),
    [
        (0.4, (9.81, 0.0, 0.0), 0.0, 1),  # down, and stays down
        (0.4, (0.0, 0.0, 9.81), 3.0, 0),  # a jump: walks on
        (0.1, (9.81, 0.0, 0.0), 0.0, 0),  # a step
    ],
)
def test_fall_is_a_drop_a_blow_and_no_walking(weightless_s, after_force, after_shake, falls):
    monitor = ActivityMonitor()
    pieces = (
        samples(2.0, 0.0, shake=1.0),
        samples(weightless_s, 2.0, (0.0, 0.0, 0.5)),
        samples(0.05, 2.0 + weightless_s, (0.0, 0.0, 60.0)),
    )
    reported = sum(monitor.push(piece, empty_rows()) for piece in pieces)
    end_s = 2.05 + weightless_s
    assert (monitor.activity(0) is Activity.FALLING) == (weightless_s > 0.25)
    reported += monitor.push(samples(12.0, end_s, after_force, after_shake), empty_rows())
    assert reported == falls
    assert monitor.activity(0) is not Activity.FALLING


@pytest.mark.slow
@pytest.mark.parametrize("batch_rows", [1, 5, 10, 50, 100])
@pytest.mark.parametrize(
    ("before_shake", "after_shake", "falls"),
    [
        (1.0, 0.0, 1),  # walks, falls, and stays down
        (0.0, 3.0, 0),  # stands, jumps down, and walks on
    ],
)
def test_fall_is_reported_at_any_instant_and_in_any_batching(
    batch_rows, before_shake, after_shake, falls
):
    for after_rows in range(0, 50, 3):
        struck_s = 3.3 + after_rows / RATE_HZ
        pieces = (
            samples(struck_s - 0.3, 0.0, shake=before_shake),
            samples(0.3, struck_s - 0.3, (0.0, 0.0, 0.5)),
            samples(0.05, struck_s, (0.0, 0.0, 60.0)),
            samples(5.0, struck_s + 0.05, shake=after_shake),
        )
        imu = ImuBatch(
            np.concatenate([piece.t_ns for piece in pieces]),
            np.vstack([piece.accel_mps2 for piece in pieces]),
            np.vstack([piece.gyro_radps for piece in pieces]),
        )
        monitor = ActivityMonitor()
        starts = range(0, len(imu), batch_rows)
        parts = (imu.part(slice(start, start + batch_rows)) for start in starts)
        assert sum(monitor.push(part, empty_rows()) for part in parts) == falls, struck_s


@pytest.mark.parametrize("next_s", [3.0, 9.0, 600.0, -100.0])
@pytest.mark.parametrize(("after_shake", "falls"), [(0.0, 1), (3.0, 0)])
def test_lying_after_a_gap_behind_the_blow_is_a_fall(next_s, after_shake, falls):
    """The blow cut the line; no sample shows that the wearer got up meanwhile."""
    monitor = ActivityMonitor()
    pieces = (
        samples(2.0, shake=1.0),
        samples(0.4, 2.0, (0.0, 0.0, 0.5)),
        samples(0.05, 2.4, (0.0, 0.0, 60.0)),
        samples(12.0, next_s, (9.81, 0.0, 0.0), after_shake),
    )
    assert sum(monitor.push(piece, empty_rows()) for piece in pieces) == falls
    assert monitor.activity(round((next_s + 12.0) * NS_PER_S)) is not Activity.FALLING


def test_blow_without_a_drop_is_no_fall():
    falls = FallDetector()
    falls.push(samples(0.05, 0.0, (0.0, 0.0, 80.0)))
    assert not falls.falling


def pushed(monitor: ActivityMonitor, *pieces: ImuBatch) -> Activity:
    """State at the end of the samples."""
    for piece in pieces:
        monitor.push(piece, empty_rows())
    return monitor.activity(int(pieces[-1].t_ns[-1]))


def test_activity_is_unknown_after_the_sensor_stopped():
    """It broke in mid walk; other messages of the unit continue."""
    monitor = ActivityMonitor()
    assert pushed(monitor, samples(5.0, shake=1.0)) is Activity.WALKING
    assert monitor.activity(6 * NS_PER_S) is Activity.WALKING
    assert monitor.activity(10 * NS_PER_S) is Activity.UNKNOWN
    silent = samples(5.0, 5.0)
    silent.accel_mps2[:] = np.nan
    assert pushed(monitor, silent) is Activity.UNKNOWN
    assert pushed(monitor, samples(2.0, 10.0)) is Activity.STILL


def test_short_motion_after_a_gap_is_no_walking():
    monitor = ActivityMonitor()
    pieces = samples(3.0), samples(0.5, 60.0, shake=1.0), samples(0.1, 60.5)
    assert pushed(monitor, *pieces) is Activity.STILL


def test_collapse_is_reported_though_samples_were_lost_behind_it():
    monitor = ActivityMonitor()
    going_down = replace(samples(1.0, 3.0, (9.0, 0.0, 4.0), shake=1.0))
    going_down.gyro_radps[:, 1] += 3.0
    pieces = samples(3.0), going_down, samples(1.2, 4.0, (9.81, 0.0, 0.0))
    falls = sum(monitor.push(piece, empty_rows()) for piece in pieces)
    falls += monitor.push(samples(5.0, 9.0, (9.81, 0.0, 0.0)), empty_rows())
    assert falls == 1


def test_the_cadence_is_of_the_last_strides_also_where_the_clock_was_set_back():
    monitor = ActivityMonitor()
    monitor.push(samples(12.5, 100.0, shake=1.0), empty_rows())
    slow = footsteps([(float(t), 2.0 * t, 0.0, t % 2 == 0) for t in range(100, 113)])
    monitor.push(samples(0.0), slow)
    assert monitor.cadence_hz(112 * NS_PER_S) == pytest.approx(1.0)
    monitor.push(samples(3.0, shake=1.0), empty_rows())
    quick = footsteps([(t / 2, t / 2, 0.0, t % 2 == 0) for t in range(7)])
    monitor.push(samples(0.0), quick)
    assert monitor.cadence_hz(3 * NS_PER_S) == pytest.approx(2.0, rel=0.2)


@pytest.mark.parametrize(("after_s", "runs"), [(2.4, True), (2.6, False)])
def test_end_of_the_last_stride_lasts_two_and_a_half_seconds(after_s, runs):
    """The foot still moves: its activity follows from footfalls that have not come yet."""
    monitor = ActivityMonitor()
    strides = footsteps([(float(t), 3.0 * t, 0.0, t % 2 == 0) for t in range(13)])
    monitor.push(samples(20.0, force=(0.0, 0.0, -9.81), shake=1.0), strides)
    t_ns = round((12.0 + after_s) * NS_PER_S)
    assert monitor.activity(t_ns) is (Activity.RUNNING if runs else Activity.WALKING)
    assert (monitor.cadence_hz(t_ns) > 0.0) is runs


def during(simulation, kind: Activity, after_s: float = 2.5) -> Counter[Activity]:
    """States of the unit from ``after_s`` into each period in which the wearer does ``kind``."""
    score = ActivityScore()

    def label(t_s: float) -> Activity | None:
        done = simulation.activity(t_s)
        same = simulation.activity(max(t_s - after_s, 0.0)) is done
        return kind if done is kind and same else None

    score_activity(simulation.batches(), simulation.description, label, 600.0, score)
    stated = Counter[Activity]()
    for (_, answer), count in score.every.counts.items():
        stated[answer] += count
    return stated


@pytest.mark.slow
@pytest.mark.parametrize(
    ("scenario", "kind", "share"),
    [
        ("gaits?seed=31", Activity.RUNNING, 0.95),
        ("gaits?seed=32", Activity.CRAWLING, 0.85),
        ("gaits?seed=32", Activity.LYING, 0.7),  # the rest is getting up
        ("stairs?seed=33", Activity.STAIRS_UP, 0.95),
        ("stairs?seed=34", Activity.STAIRS_DOWN, 0.95),
        ("stairs?seed=34", Activity.WALKING, 0.95),
    ],
)
def test_simulated_activity_is_recognised(scenario, kind, share):
    stated = during(open_simulation(scenario), kind)
    assert stated[kind] > share * stated.total() > 0


@pytest.mark.slow
def test_lying_down_and_kneeling_are_no_falls():
    _, falls = activities(open_source("simulated:gaits?seed=35"), 600.0)
    assert falls == 0


def footsteps(rows: list[tuple[float, float, float, bool]]):
    """Rows of a tracker at given times: (time, north, height, standing)."""
    n = len(rows)
    t_s, north_m, height_m, standing = (np.array(column) for column in zip(*rows, strict=True))
    zero = np.zeros(n)
    return replace(
        empty_rows(),
        t_ns=np.rint(t_s * NS_PER_S).astype(np.int64),
        position_n_m=np.column_stack((north_m, zero, -height_m)),
        quaternion_nb=np.tile([1.0, 0.0, 0.0, 0.0], (n, 1)),
        stationary=standing.astype(bool),
        steps=np.zeros(n, np.int64),
    )


def test_stride_lasts_from_lift_off_to_the_next_footfall():
    rows = footsteps([(0.0, 0, 0, True), (0.5, 0, 0, True), (0.8, 0.7, 0.2, False)])
    cutter = StrideCutter()
    assert cutter.push(rows) == []
    (stride,) = cutter.push(footsteps([(1.1, 1.2, 0.1, True)]))
    assert (stride.length_m, stride.rise_m) == pytest.approx((1.2, 0.1))
    assert stride.period_s == pytest.approx(0.6 / 0.75)
    assert stride.up_b.tolist() == [0.0, 0.0, -1.0]


def test_footfall_in_mid_swing_is_none():
    rows = footsteps(
        [
            (0.0, 0, 0, True),
            (0.2, 0.3, 0.1, False),
            (0.3, 0.5, 0.2, True),
            (0.32, 0.6, 0.2, False),
            (0.8, 1.4, 0.0, True),
        ]
    )
    (stride,) = StrideCutter().push(rows)
    assert (stride.length_m, stride.rise_m) == pytest.approx((1.4, 0.0))


def climbing(rise_m: float, n: int = 12):
    """A tracker's rows on stairs, a stride a second with half of it standing."""
    rows = [(0.0, 0.0, 0.0, True)]
    for k in range(1, n):
        rows += [(k - 0.5, 0.3 * k - 0.3, rise_m * (k - 1), True)]
        rows += [(k - 0.3, 0.3 * k - 0.1, rise_m * (k - 0.5), False)]
        rows += [(float(k), 0.3 * k, rise_m * k, True)]
    return footsteps(rows)


@pytest.mark.parametrize(
    ("rise_m", "pa_per_s", "reported"),
    [
        (0.34, None, Activity.STAIRS_UP),
        (0.34, -4.0, Activity.STAIRS_UP),
        (0.34, 0.0, Activity.WALKING),  # the pressure is constant: the tracker is wrong
        (0.34, 4.0, Activity.WALKING),
        (-0.34, 4.0, Activity.STAIRS_DOWN),
        (-0.34, 0.0, Activity.WALKING),
    ],
)
def test_barometer_counts_on_stairs(rise_m, pa_per_s, reported):
    monitor = ActivityMonitor()
    imu = samples(12.5, shake=1.0)
    if pa_per_s is not None:
        imu = replace(imu, pressure_pa=101_000.0 + pa_per_s * imu.t_ns / NS_PER_S)
    monitor.push(imu, empty_rows())
    monitor.push(imu.part(slice(0, 0)), climbing(rise_m))
    assert monitor.activity(int(imu.t_ns[-1])) is reported


def as_it_is(imu: ImuBatch) -> ImuBatch:
    return imu


def a_fifth_missed(imu: ImuBatch) -> ImuBatch:
    missed = np.random.default_rng(int(imu.t_ns[0])).random(len(imu)) < 0.2
    return replace(imu, accel_mps2=np.where(missed[:, None], np.nan, imu.accel_mps2))


def a_tenth_twice(imu: ImuBatch) -> ImuBatch:
    twice = np.random.default_rng(int(imu.t_ns[0])).random(len(imu)) < 0.1
    rows = np.repeat(np.arange(len(imu)), 1 + twice)
    return ImuBatch(imu.t_ns[rows], imu.accel_mps2[rows], imu.gyro_radps[rows])


def activities(source, until_s: float, spoilt=as_it_is) -> tuple[list[Activity], int]:
    """Activity of each second, and the reported falls."""
    tracker = make_tracker("eskf", source.description)
    monitor = ActivityMonitor()
    each: list[Activity] = []
    falls = 0
    for batch in source.batches():
        t_ns = int(batch.imu.t_ns[-1])
        if t_ns > until_s * NS_PER_S:
            break
        imu = spoilt(batch.imu)
        falls += monitor.push(imu, tracker.push(imu))
        if t_ns // NS_PER_S > len(each):
            each.append(monitor.activity(t_ns))
    return each, falls


@pytest.mark.slow
@pytest.mark.parametrize("spoilt", [as_it_is, a_fifth_missed, a_tenth_twice])
def test_a_simulated_collapse_is_a_fall_and_then_lying(spoilt):
    each, falls = activities(open_source("simulated:goes-down"), 60.0, spoilt)
    assert falls == 1
    assert Activity.WALKING in each[:20]
    assert set(each[30:]) == {Activity.LYING}


@pytest.mark.slow
def test_simulated_search_has_no_falls_and_no_lying():
    each, falls = activities(open_source("simulated:search-ground-floor"), 90.0)
    assert falls == 0
    assert set(each) <= {Activity.UNKNOWN, Activity.STILL, Activity.WALKING}


@pytest.mark.slow
def test_recorded_walks_hold_walking_and_no_falls(walks):
    folders = sorted(path.parent for path in walks.glob("*/*/imu.csv.gz"))[::6]
    assert folders
    for folder in folders:
        each, falls = activities(RecordingSource(folder), 60.0)
        assert falls == 0, folder
        assert Activity.LYING not in each, folder
        walked = sum(each.count(kind) for kind in (Activity.WALKING, Activity.RUNNING))
        assert walked > 0.5 * len(each), folder


@pytest.mark.parametrize(
    ("speed_mps", "kind"),
    [(0.0, Activity.STILL), (1.3, Activity.WALKING), (2.0, None), (3.0, Activity.RUNNING)],
)
def test_reference_labels_by_its_speed_or_not_at_all(speed_mps, kind):
    t_s = np.arange(0.0, 10.0, 0.05)
    truth = RecordedTruth(t_s, np.column_stack((speed_mps * t_s, 0.0 * t_s, 0.0 * t_s)))
    label = recorded_label(truth, sampled=True)
    assert label(5.0) is kind
    assert label(0.5) is None
    strides = RecordedTruth(t_s[::20], truth.position_n_m[::20])
    expected = None if kind is Activity.STILL else kind
    assert recorded_label(strides, sampled=False)(5.0) is expected


def steps_counted(source) -> int:
    tracker = make_tracker("eskf", source.description)
    monitor = ActivityMonitor()
    for batch in source.batches():
        monitor.push(batch.imu, tracker.push(batch.imu))
    monitor.push(samples(0.0), tracker.finish())
    return monitor.steps


@pytest.mark.slow
@pytest.mark.parametrize("scenario", ["stairs?seed=71", "rectangle?seed=72"])
def test_every_step_counts_also_on_the_spot(scenario):
    source = open_source(f"simulated:{scenario}")
    assert isinstance(source, SimulatedSource)
    taken = 2 * len(source.simulation.plan.footfall_s)
    assert abs(steps_counted(source) - taken) <= 2


@pytest.mark.slow
def test_recorded_footprints_are_counted(walks):
    folders = sorted(path.parent for path in walks.glob("footprints/*/truth.csv"))[::4]
    assert folders
    for folder in folders:
        truth = read_truth(folder)
        assert truth is not None
        taken = 2 * (len(truth.t_s) - 1)
        assert abs(steps_counted(RecordingSource(folder)) - taken) <= 2, folder
