"""Two paths of one person are fused: headings, a failing path, and silence."""

from __future__ import annotations

import numpy as np
import pytest

from edge.samples import ImuBatch
from edge.tracker.fused_paths.sensor_rows import SensorRows
from edge.tracker.fused_paths.tracker import FOOT_AND_TRUNK, TWO_FEET, FusedPathsTracker
from edge.tracker.interface import (
    LEFT_FOOT,
    RIGHT_FOOT,
    BodyDimensions,
    Quality,
    StepScale,
    TrackBatch,
    WornSensor,
)
from edge.tracker.track_rows import empty_rows
from tests.rig.exact_strides import walk
from tests.rig.sensors_of_person import track_person


class Scripted:
    """Tracker whose rows walk north, turned and stretched, and turn aside when lost."""

    def __init__(self, turn_rad=0.0, scale=1.0, lost_from_ns=None):
        self._turn_rad, self._scale, self._lost_ns = turn_rad, scale, lost_from_ns
        self._way_m = scale * 1.3 * (((lost_from_ns or 0) * 1e-9) - 2.0)

    def push(self, batch):
        n = len(batch)
        t_s = batch.t_ns * 1e-9
        way_m = self._scale * 1.3 * np.maximum(t_s - 2.0, 0.0)
        lost = np.zeros(n, bool) if self._lost_ns is None else batch.t_ns >= self._lost_ns
        position = np.zeros((n, 3))
        straight_m = way_m if self._lost_ns is None else np.minimum(way_m, self._way_m)
        for way, turn_rad in ((straight_m, 0.0), (way_m - straight_m, 1.0)):
            position[:, 0] += way * np.cos(self._turn_rad + turn_rad)
            position[:, 1] += way * np.sin(self._turn_rad + turn_rad)
        quaternion = np.zeros((n, 4))
        quaternion[:, 0] = 1.0
        return TrackBatch(
            t_ns=batch.t_ns,
            position_n_m=position,
            velocity_n_mps=np.zeros((n, 3)),
            quaternion_nb=quaternion,
            position_cov_m2=np.eye(3) * (1e-4 + 1e-4 * way_m + 25.0 * lost)[:, None, None],
            heading_std_rad=np.full(n, 0.01),
            stationary=np.zeros(n, bool),
            past_shift_n_m=np.zeros((n, 2)),
            past_turn_rad=np.zeros(n),
            distance_m=way_m,
            steps=(np.maximum(t_s - 2.0, 0.0)).astype(np.int64),
            quality=np.where(lost, Quality.LOST, Quality.GOOD).astype(np.uint8),
            reasons=np.zeros(n, np.uint32),
            magnetic_north_rad=np.zeros(n),
            magnetic_north_std_rad=np.full(n, np.inf),
        )

    path_noise = None

    def set_earth_field(self, field, t_ns):
        raise AssertionError("not used here")

    def finish(self):
        return empty_rows()


FEET = walk(strides=40)  # of which only the times count


def fused(left, right, **samples):
    scripted = {LEFT_FOOT: left, RIGHT_FOOT: right}
    tracker = FusedPathsTracker(
        {place: WornSensor(FEET.description, place) for place in scripted},
        BodyDimensions(),
        TWO_FEET,
        lambda place: lambda _: scripted[place],
    )
    return track_person(tracker, {LEFT_FOOT: FEET.imu, RIGHT_FOOT: FEET.imu} | samples)


def away_m(rows):
    return float(np.hypot(*(rows.position_n_m[-1] - rows.position_n_m[0])[:2]))


LENGTH_M = 1.3 * (FEET.imu.t_ns[-1] * 1e-9 - 2.0)


def test_frames_that_are_turned_against_each_other_make_one_way():
    assert away_m(fused(Scripted(), Scripted(2.5))) == pytest.approx(LENGTH_M, rel=0.01)


def test_the_better_one_counts_where_one_fails():
    for failing in (0, 1):
        feet = [Scripted(), Scripted()]
        feet[failing] = Scripted(lost_from_ns=30_000_000_000)
        rows = fused(*feet)
        off_m = rows.position_n_m[-1, :2] - (LENGTH_M, 0.0)
        assert np.hypot(*off_m) < 1.0
        assert rows.quality[-1] == Quality.GOOD


def test_lengths_that_differ_meet_between_the_two():
    rows = fused(Scripted(scale=0.99), Scripted(scale=1.01))
    assert away_m(rows) == pytest.approx(LENGTH_M, rel=0.005)


def test_correction_by_the_comparison_is_no_movement():
    rows = fused(Scripted(), Scripted(lost_from_ns=30_000_000_000))
    moved_m = np.diff(rows.position_n_m[:, :2] - rows.past_shift_n_m, axis=0)
    assert np.hypot(*moved_m.T).max() < 0.05
    assert np.abs(rows.past_shift_n_m[-1]).max() > 0.0


def test_a_foot_that_was_silent_comes_back_and_no_row_is_missing_meanwhile():
    imu = FEET.imu
    silent = (imu.t_ns > 20_000_000_000) & (imu.t_ns < 26_000_000_000)
    left = ImuBatch(imu.t_ns[~silent], imu.accel_mps2[~silent], imu.gyro_radps[~silent])
    rows = fused(Scripted(), Scripted(2.5), **{LEFT_FOOT: left})
    assert np.diff(rows.t_ns).max() < 0.4e9
    assert away_m(rows) == pytest.approx(LENGTH_M, rel=0.02)
    during = (rows.t_ns > 21_000_000_000) & (rows.t_ns < 25_000_000_000)
    assert np.all(rows.quality[during] == Quality.DEGRADED)
    assert rows.quality[-1] == Quality.GOOD


def test_rows_held_back_over_a_silence_are_left_out():
    class Holding(Scripted):
        """Gives the rows of a batch with the next one."""

        def __init__(self):
            super().__init__()
            self._held = empty_rows()

        def push(self, batch):
            released, self._held = self._held, super().push(batch)
            return released

    rows = SensorRows(Holding(), 0.35)
    for first in (0, 100):
        rows.push(FEET.imu.part(slice(first, first + 100)))
    rows.push(FEET.imu.part(slice(400, 500)))
    taken = rows.take(2**62)
    assert np.array_equal(taken.t_ns, FEET.imu.t_ns[:100])


class ScriptedTrunk(Scripted):
    """Trunk whose steps are taken for too short, by the scale of a person where one is known."""

    def __init__(self, scale):
        super().__init__(scale=scale)
        self.start = StepScale(1.0, 0.08)

    def set_step_scale(self, scale):
        self.start = scale
        self._scale *= scale.factor
        self._way_m *= scale.factor


def beside_a_foot(trunk, known=None):
    scripted = {LEFT_FOOT: Scripted(), "chest": trunk}
    tracker = FusedPathsTracker(
        {place: WornSensor(FEET.description, place) for place in scripted},
        BodyDimensions(step_scales={} if known is None else {"chest": known}),
        FOOT_AND_TRUNK,
        lambda place: lambda _: scripted[place],
    )
    track_person(tracker, {LEFT_FOOT: FEET.imu, "chest": FEET.imu})
    return tracker


def test_a_foot_shows_how_long_the_steps_of_the_trunk_are():
    tracker = beside_a_foot(ScriptedTrunk(1.0 / 1.15))
    assert tracker.scaled_place is None
    scale = tracker.walked_step_scales["chest"]
    assert scale.factor == pytest.approx(1.15, abs=0.03)
    assert abs(scale.factor - 1.15) < 3.0 * scale.std


def test_a_trunk_starts_with_the_steps_of_its_wearer_and_shows_the_same():
    trunk = ScriptedTrunk(1.0 / 1.15)
    tracker = beside_a_foot(trunk, StepScale(1.1, 0.05))
    assert trunk.start == StepScale(1.1, 0.05)
    scale = tracker.walked_step_scales["chest"]
    assert scale.factor == pytest.approx(1.15, abs=0.03), "by this walk, without what was known"


def test_two_feet_show_nothing_of_steps():
    scripted = {LEFT_FOOT: Scripted(), RIGHT_FOOT: Scripted()}
    tracker = FusedPathsTracker(
        {place: WornSensor(FEET.description, place) for place in scripted},
        BodyDimensions(),
        TWO_FEET,
        lambda place: lambda _: scripted[place],
    )
    track_person(tracker, {LEFT_FOOT: FEET.imu, RIGHT_FOOT: FEET.imu})
    assert tracker.walked_step_scales == {}
