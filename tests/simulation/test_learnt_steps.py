"""A wearer whose steps are 15 % off: what one walk with fixes shows of them makes the next walk
better after a restart, and nobody else's.
"""

from __future__ import annotations

from contextlib import closing
from functools import cache

import numpy as np
import pytest

from edge.agent.fitted_sensor import FittedSensor
from edge.agent.pipeline import TrackerPipeline, UnitIdentity
from edge.agent.step_scale_keeper import StepScaleKeeper
from edge.samples import GpsSample, SensorBatch
from edge.sources.recording import RecordedTruth
from edge.storage.step_scales import StepScales
from edge.tracker.body.config import TRUNK, BodyConfig
from edge.tracker.body.tracker import BodyTracker
from edge.tracker.choice.one_sensor import OneSensorTracker
from edge.tracker.interface import StepScale
from edge.tracker.track_rows import join_rows
from shared.clock import NS_PER_S, ManualClock
from shared.geo import Anchor
from shared.header_factory import HeaderFactory
from tests.bench.tracker.scoring import score_track
from tests.rig.inertial_walk import InertialWalk, inertial_walk

HERE = Anchor(57.7, 11.97, 30.0, 0.0)
FIX_STD_M = 2.0
LASTS_S = 300
# The tracker takes the steps of the simulated wearer for 0.89 of what they are; here for 0.85.
CONFIG = BodyConfig(place=TRUNK, trunk_scale_m=0.91 * 0.85 / 0.89)


@cache
def walked(seed: int) -> InertialWalk:
    return inertial_walk("track-400m", seed, "chest", lasts_s=LASTS_S)


def fixes(walk: InertialWalk) -> dict[int, GpsSample]:
    """A fix a second, by the second."""
    dice = np.random.default_rng(11)
    found = {}
    for second in range(1, LASTS_S - 1):
        t_s = second + 0.3
        north_m, east_m = (
            float(np.interp(t_s, walk.t_s, walk.truth.position_n_m[:, axis]))
            + FIX_STD_M * float(dice.standard_normal())
            for axis in range(2)
        )
        lat_deg, lon_deg, height_m = HERE.to_geodetic(north_m, east_m, 0.0)
        found[second] = GpsSample(
            round(t_s * NS_PER_S), lat_deg, lon_deg, height_m, FIX_STD_M, 4.0, 3, 9, 1.0, 0.0
        )
    return found


def tracker_for(walk: InertialWalk, keeper: StepScaleKeeper) -> BodyTracker:
    tracker = BodyTracker(walk.description, CONFIG)
    scale = keeper.start_scales.get("chest")
    if scale is not None:
        tracker.set_step_scale(scale)
    return tracker


def walk_with_fixes(walk: InertialWalk, keeper: StepScaleKeeper) -> None:
    """Run the unit's pipeline over a walk outdoors, as the agent does."""
    pipeline = TrackerPipeline(
        UnitIdentity("1.0", "test", "body", (FittedSensor(walk.description),)),
        OneSensorTracker(
            BodyTracker(walk.description, CONFIG), "", "chest", keeper.start_scales.get("chest")
        ),
        HeaderFactory("u1", 7, ManualClock()),
        1.0,
    )
    by_second = fixes(walk)
    for second in range(LASTS_S):
        rows = np.flatnonzero(walk.imu.t_ns // NS_PER_S == second)
        others = (by_second[second],) if second in by_second else ()
        pipeline.step(SensorBatch(walk.imu.part(slice(rows[0], rows[-1] + 1)), others))
    pipeline.finish()
    keeper.take(pipeline.walked_step_scales)


def error_of_length(walk: InertialWalk, keeper: StepScaleKeeper) -> tuple[float, float]:
    """Return the share by which a walk without fixes is off, and the share of it that the stated
    region holds.
    """
    tracker = tracker_for(walk, keeper)
    rows = join_rows([tracker.push(walk.imu), tracker.finish()])
    truth = RecordedTruth(walk.t_s[::200], walk.truth.position_n_m[::200])
    steps_m = np.diff(truth.position_n_m[:, :2], axis=0)
    score = score_track(rows, truth, closed_loop=False)
    assert score.coverage_95_from_start is not None
    ratio = float(rows.distance_m[-1]) / float(np.hypot(*steps_m.T).sum())
    return abs(ratio - 1.0), score.coverage_95_from_start


@pytest.mark.slow
def test_a_walk_with_fixes_makes_the_next_one_better_of_that_wearer_alone(tmp_path):
    def keeper(person: str) -> closing[StepScaleKeeper]:
        return closing(StepScaleKeeper(StepScales(tmp_path / "step_scales.json", person)))

    with keeper("Ada") as first:
        before, held_before = error_of_length(walked(2), first)
        walk_with_fixes(walked(1), first)
    with keeper("Ada") as after_restart:
        after, held = error_of_length(walked(2), after_restart)
        assert after_restart.start_scales["chest"].std < CONFIG.scale_std
    assert before > 0.12
    assert after < 0.5 * before
    assert held_before > 0.9
    assert held > 0.95
    with keeper("Ben") as other:
        assert error_of_length(walked(2), other) == (before, held_before)


@pytest.mark.slow
def test_the_stated_scale_is_that_of_the_start():
    tracker = BodyTracker(walked(1).description, CONFIG)
    assert tracker.path_noise.scale_std == CONFIG.scale_std
    tracker.set_step_scale(StepScale(1.1, 0.05))
    assert tracker.path_noise.scale_std == 0.05
