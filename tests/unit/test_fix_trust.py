"""What a receiver's fixes show of themselves: how they jump, and whether they are as they claim."""

from __future__ import annotations

import math

import numpy as np
import pytest

from base_station.fusion.fixes.sky import common_m2
from base_station.fusion.fixes.trust import SURPRISE_MOST, FixTrust
from base_station.fusion.path.memory import OwnPlace
from base_station.fusion.port import PlaceFix
from shared.clock import NS_PER_S

STD_M = 2.0
OWN_M2 = STD_M**2 - common_m2(STD_M)


def after_walk(fresh_part: float, turn_rad: float, seconds: int = 600, step_s: int = 1) -> FixTrust:
    """Somebody walks a metre a second; so much of the receiver's variance is new with each fix."""
    rng, trust = np.random.default_rng(3), FixTrust()
    for second in range(0, seconds, step_s):
        along = second * np.array([math.cos(turn_rad), math.sin(turn_rad)])
        north_m, east_m = along + rng.normal(0.0, math.sqrt(fresh_part * OWN_M2), 2)
        fix = PlaceFix(second * NS_PER_S, float(north_m), float(east_m), 0.0, STD_M, None)
        trust.compare_pair(fix, OwnPlace(second * NS_PER_S, float(second), 0.0, float(second)))
    return trust


@pytest.mark.parametrize("turn_rad", [0.0, 2.0])
@pytest.mark.parametrize("fresh_part", [0.15, 0.5, 0.9])
def test_how_much_is_new_with_every_fix_is_learnt_whatever_the_heading(
    fresh_part: float, turn_rad: float
) -> None:
    assert after_walk(fresh_part, turn_rad).fresh_part == pytest.approx(fresh_part, rel=0.35)


def test_a_few_fixes_hardly_tell_and_gaps_nothing() -> None:
    known = FixTrust().fresh_part
    assert after_walk(0.0, 0.0, seconds=4).fresh_part > 0.6 * known
    assert after_walk(0.9, 0.0, step_s=10).fresh_part == known


def surprise_of(worse: float) -> float:
    """On the mean over many fixes, whose errors are so much larger than they claim."""
    rng, trust, seen = np.random.default_rng(1), FixTrust(), []
    for _ in range(3000):
        trust.compare(worse**2 * float(rng.chisquare(2)) / trust.surprise)
        seen.append(trust.surprise)
    return float(np.mean(seen))


def test_fixes_that_are_as_they_claim_leave_little_surprise_and_worse_ones_much() -> None:
    assert surprise_of(1.0) < 1.4
    assert 2.0 < surprise_of(2.0) < SURPRISE_MOST
