"""Scale of a walk's steps by satellite fixes: exact where they are, silent where they are not."""

from __future__ import annotations

import math

import numpy as np
import pytest

from edge.agent.step_scale_by_fixes import StepScaleByFixes
from edge.samples import GpsSample
from edge.tracker.interface import Quality
from shared.clock import NS_PER_S
from shared.geo import Anchor
from tests.rig.straight_tracker import StraightAhead, walk

HERE = Anchor(57.7, 11.97, 30.0, 0.0)
RATE_HZ = 100


def fix(t_s: float, east_m: float, std_m: float = 2.0, fix_type: int = 3) -> GpsSample:
    lat_deg, lon_deg, height_m = HERE.to_geodetic(0.0, east_m, 0.0)
    return GpsSample(
        round(t_s * NS_PER_S), lat_deg, lon_deg, height_m, std_m, 4.0, fix_type, 9, 1.0, 0.0
    )


def measured(true_speed_mps: float, lasts_s: int = 600, noise_m: float = 0.0, **changes):
    """The path goes north at 1 m/s, and the wearer east at the true speed."""
    dice = np.random.default_rng(5)
    scale, tracker = StepScaleByFixes(), StraightAhead()
    for second in range(lasts_s):
        error_m = noise_m * float(dice.standard_normal())
        scale.take_fix(fix(second + 0.5, true_speed_mps * (second + 0.5) + error_m, **changes))
        rows = tracker.push(walk(RATE_HZ, second))
        scale.push(rows, None)
    return scale.scale


def test_scale_is_that_of_the_fixes_whatever_the_heading_of_the_path():
    found = measured(1.15)
    assert found is not None
    assert found.factor == pytest.approx(1.15, abs=0.005)
    assert 0.005 < found.std < 0.03


def test_noise_of_fixes_is_within_the_stated_deviation():
    found = measured(1.15, noise_m=2.0)
    assert found is not None
    assert abs(found.factor - 1.15) < 2.0 * found.std


@pytest.mark.parametrize(
    "changes", [{"std_m": 25.0}, {"std_m": math.nan}, {"std_m": 0.0}, {"fix_type": 0}]
)
def test_poor_fixes_measure_nothing(changes):
    assert measured(1.15, **changes) is None


def test_a_way_that_is_too_short_measures_nothing():
    assert measured(1.15, lasts_s=60) is None


def test_a_ride_is_no_walk():
    assert measured(8.0) is None


def test_a_path_that_is_lost_between_two_fixes_measures_nothing():
    scale, tracker = StepScaleByFixes(), StraightAhead()
    for second in range(200):
        scale.take_fix(fix(second + 0.5, 1.15 * second))
        rows = tracker.push(walk(RATE_HZ, second))
        rows.quality[:] = Quality.LOST if second % 50 == 49 else Quality.GOOD
        scale.push(rows, None)
    assert scale.scale is None
