"""Receiver model learnt from fixes: their jumps, and their errors relative to their stated
accuracy.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import msgspec
import numpy as np
import pytest

from base_station.fusion.fuser_memory import FuserMemory
from base_station.fusion.gnss.common_mode_error import common_m2
from base_station.fusion.gnss.receiver_model import (
    MAX_INFLATION,
    MIN_WHITE_PART,
    WHITE_MEMORY_PAIRS,
    WHITE_PART,
    ReceiverModel,
)
from base_station.fusion.gps_inertial import GpsInertial, GpsInertialFuser
from base_station.fusion.interface import PlaceFix, Start
from base_station.fusion.odometry.recent_path import PathPoint
from base_station.fusion.parameters import Parameters
from shared.clock import NS_PER_S
from shared.messages import Header
from tests.rig import message_factory

STD_M = 2.0
OWN_M2 = STD_M**2 - common_m2(STD_M)


def after_walk(
    white_part: float,
    turn_rad: float,
    seconds: int = 600,
    step_s: int = 1,
    trust: ReceiverModel | None = None,
) -> ReceiverModel:
    """Model after a walk at a metre a second; ``share`` of the receiver's variance is new with each
    fix.
    """
    rng, trust = np.random.default_rng(3), trust or ReceiverModel()
    for second in range(0, seconds, step_s):
        along = second * np.array([math.cos(turn_rad), math.sin(turn_rad)])
        north_m, east_m = along + rng.normal(0.0, math.sqrt(white_part * OWN_M2), 2)
        fix = PlaceFix(second * NS_PER_S, float(north_m), float(east_m), 0.0, STD_M, None)
        place = PathPoint(second * NS_PER_S, 0.6 * second, 0.8 * second, float(second))
        trust.update_white_part(fix, place)
    return trust


@pytest.mark.parametrize("turn_rad", [0.0, 2.0])
@pytest.mark.parametrize("white_part", [0.15, 0.5, 0.9])
def test_share_of_new_error_is_learnt_at_any_heading(white_part: float, turn_rad: float) -> None:
    assert after_walk(white_part, turn_rad).white_part == pytest.approx(white_part, rel=0.35)


@pytest.mark.parametrize(("north_mps", "east_mps"), [(0.0, 0.0), (1.5, 0.0), (0.0, 1.5)])
def test_fast_motion_is_no_jump_of_the_receiver(north_mps: float, east_mps: float) -> None:
    """The way between two fixes is no part of their errors."""
    trust = ReceiverModel()
    for second in range(0, 600, 2):
        place = PathPoint(second * NS_PER_S, north_mps * second, east_mps * second, 0.0)
        fix = fix_at(float(second), north_mps * second, east_mps * second)
        trust.update_white_part(fix, place)
    assert trust.white_sum == pytest.approx(
        ReceiverModel().white_sum * (1.0 - 1.0 / WHITE_MEMORY_PAIRS) ** 299
    )


def test_few_fixes_hardly_change_the_receiver_model_and_gaps_nothing() -> None:
    known = ReceiverModel().white_part
    assert known == WHITE_PART
    assert after_walk(0.0, 0.0, seconds=4).white_part > 0.6 * known
    assert after_walk(0.9, 0.0, step_s=10).white_part == known
    assert after_walk(3.0, 0.0).white_part == 1.0, "never more than all of it"


def test_changed_error_of_a_receiver_is_learnt_again() -> None:
    """After some minutes: it was in the open, and is between houses."""
    trust = after_walk(0.15, 0.0, seconds=1200)
    assert after_walk(0.9, 0.0, seconds=600, trust=trust).white_part > 0.7
    assert after_walk(0.15, 0.0, seconds=600, trust=trust).white_part < 0.3


def test_wall_and_stated_accuracy_make_a_fix_worse() -> None:
    trust = ReceiverModel()
    best = PlaceFix(0, 0.0, 0.0, 0.0, STD_M, None)
    trust.on_accepted(best)
    assert trust.extra_m2(best, 0.0) == pytest.approx(0.0)
    assert trust.extra_m2(best, 4.0) == pytest.approx(4.0**2)
    worse = msgspec.structs.replace(best, horizontal_std_m=5.0)
    common_more_m2 = common_m2(5.0) - common_m2(STD_M)
    excess_m2 = 4.0 * (5.0**2 - STD_M**2 - common_more_m2)
    assert trust.extra_m2(worse, 4.0) == pytest.approx(4.0**2 + excess_m2)


def test_rest_and_return_from_a_long_way_are_no_frozen_receiver() -> None:
    trust, kind = ReceiverModel(), Parameters()
    for second in range(20):
        assert not trust.is_stuck(kind, fix_at(second, 7.0), 500.0)
    assert trust.is_stuck(kind, fix_at(20, 7.0), 500.0 + 1.1 * kind.stuck_m)
    assert not trust.is_stuck(kind, fix_at(21, 7.1), 500.0 + 2.0 * kind.stuck_m)
    twice = trust.is_stuck(kind, fix_at(22, 7.1), 500.0 + 5.0 * kind.stuck_m)
    assert not twice, "it gave it twice"


def test_same_place_five_times_is_a_frozen_receiver() -> None:
    trust, kind = ReceiverModel(), Parameters()
    hangs = [trust.is_stuck(kind, fix_at(second, 7.0), 100.0 * second) for second in range(6)]
    assert hangs == [False] * 4 + [True] * 2


def test_receiver_rejected_once_is_used_with_the_second_fix_that_fits() -> None:
    trust = ReceiverModel()
    trust.on_rejected(Parameters(), fix_at(0, 0.0), (0.0, 0.0))
    assert [trust.on_within_gate() for _ in range(2)] == [False, True]


def test_receiver_rejected_often_must_fit_twice_as_often_before_it_is_used() -> None:
    trust, kind = ReceiverModel(), Parameters()
    assert trust.on_within_gate()
    for _ in range(100):
        trust.on_rejected(kind, fix_at(0, 0.0), (0.0, 0.0))
    unused = 0
    while not trust.on_within_gate():
        unused += 1
    assert unused == kind.max_rejected_count // 2
    assert trust.outliers.kept == []


def surprise_of(worse: float) -> float:
    """Mean over many fixes, whose errors exceed their stated accuracy by this factor."""
    rng, trust, seen = np.random.default_rng(1), ReceiverModel(), []
    for _ in range(3000):
        trust.update_inflation(worse**2 * float(rng.chisquare(2)) / trust.inflation)
        seen.append(trust.inflation)
    return float(np.mean(seen))


def test_inflation_is_small_for_correct_accuracies_and_large_for_worse_errors() -> None:
    assert surprise_of(1.0) < 1.4
    assert 2.0 < surprise_of(2.0) < MAX_INFLATION


def fix_at(second: float, north_m: float, east_m: float = 0.0, std_m: float = STD_M) -> PlaceFix:
    return PlaceFix(message_factory.mono_ns(second), north_m, east_m, 0.0, std_m, None)


def walk(
    fuser: GpsInertialFuser, seconds: Iterable[int], boot_id: int = 1, own_m: float = 0.0
) -> None:
    """North at a metre a second, by an own path that is so far ahead."""
    for second in seconds:
        for fifth in range(5):
            t_s = second + fifth / 5
            header = Header("FF-01", boot_id, 5 * second + fifth, message_factory.mono_ns(t_s))
            way_m = t_s + own_m
            fuser.predict(message_factory.position(header, north_m=way_m, distance_m=way_m))


def walk_with_fixes(
    fuser: GpsInertialFuser, seconds: range, own_m: float = 0.0, std_m: float = STD_M
) -> None:
    rng = np.random.default_rng(seconds.start)
    for second in seconds:
        walk(fuser, [second], own_m=own_m)
        north_m, east_m = rng.normal(0.0, 0.6 * std_m, 2).tolist()
        fuser.update_gnss(fix_at(second + 0.8, second + 0.8 + north_m, east_m, std_m))


def trust_of(fuser: GpsInertialFuser) -> ReceiverModel:
    return msgspec.msgpack.decode(fuser.save(), type=FuserMemory).receiver


def test_accuracy_of_a_rejected_fix_makes_no_good_one_worse() -> None:
    """Inside, a receiver states once a wrong place with an accuracy of a metre."""
    stds_m = []
    for wrong in (False, True):
        fuser = GpsInertial().new()
        walk_with_fixes(fuser, range(60), std_m=3.0)
        walk(fuser, range(60, 120))
        if wrong:
            assert not fuser.update_gnss(fix_at(119.8, 300.0, 200.0, 1.27)).accepted
        walk_with_fixes(fuser, range(120, 140), std_m=3.0)
        estimate = fuser.estimate()
        assert estimate is not None
        stds_m.append(estimate.std_east_m)
    assert stds_m[1] == pytest.approx(stds_m[0], rel=0.05)


def test_best_accuracy_of_used_fixes_is_that_of_the_receiver() -> None:
    """A worse accuracy is due to its surroundings; late or in time."""
    for late_s in (0.0, 30.0):
        fuser = GpsInertial().new()
        walk_with_fixes(fuser, range(60), std_m=3.0)
        assert fuser.update_gnss(fix_at(59.9 - late_s, 59.9 - late_s, 0.0, 1.5)).accepted
        trust = trust_of(fuser)
        assert trust.own_m2(fix_at(60.0, 60.0, 0.0, 3.0)) == 1.5**2 - common_m2(1.5)
        assert trust.extra_m2(fix_at(60.0, 60.0, 0.0, 3.0), 0.0) > 3.0**2


def test_late_fix_corrects_the_present_place() -> None:
    """It weighs less than a present one: its slow error is that of its neighbours."""
    moved_m, known_m = {}, {}
    for late_s in (0.0, 20.0):
        fuser = GpsInertial().new()
        walk_with_fixes(fuser, range(60), std_m=3.0)
        walk(fuser, range(60, 120))
        assert fuser.update_gnss(fix_at(119.0, 119.0, 0.0, 8.0)).accepted
        before = fuser.estimate()
        assert fuser.update_gnss(fix_at(119.9 - late_s, 119.9 - late_s, 3.0, 3.0)).accepted
        after = fuser.estimate()
        assert before is not None
        assert after is not None
        moved_m[late_s] = after.east_m - before.east_m
        known_m[late_s] = after.std_east_m / before.std_east_m
    assert 0.0 < moved_m[20.0] < moved_m[0.0]
    assert known_m[0.0] < known_m[20.0] < 1.0


def test_jumping_path_leaves_the_receiver_model_as_it_is() -> None:
    fuser = GpsInertial().new()
    walk_with_fixes(fuser, range(60))
    before = trust_of(fuser).white_part
    assert before > 2.0 * MIN_WHITE_PART
    walk_with_fixes(fuser, range(60, 65), own_m=500.0)
    assert trust_of(fuser).white_part == pytest.approx(before, rel=0.25)


def test_frozen_receiver_is_detected_over_a_restart_of_the_unit() -> None:
    fuser = GpsInertial().new()
    walk_with_fixes(fuser, range(60))
    hangs_m = 60.5
    verdicts = []
    for second in range(60, 80):
        boot_id, own_m = (1, 0.0) if second < 63 else (2, -63.0)
        walk(fuser, [second], boot_id, own_m)
        verdicts.append(fuser.update_gnss(fix_at(second + 0.8, hangs_m)))
    reasons = [verdict.reason for verdict in verdicts]
    assert reasons[-6:] == ["the receiver is stuck"] * 6


@pytest.mark.parametrize("turn_rad", [-2.0, 0.5])
def test_fixes_draw_the_walk_of_a_run_that_has_just_begun(turn_rad: float) -> None:
    """The fixes rejected before belong to a path with another direction."""
    trust, kind, shape = ReceiverModel(), Parameters(), None
    for second in range(19):
        assert trust.on_rejected(kind, fix_at(second, second), (0.0, float(second))) is None
    trust.forget_path()
    for second in range(30):
        own_m = second * math.cos(turn_rad), -second * math.sin(turn_rad)
        shape = shape or trust.on_rejected(kind, fix_at(20 + second, 20.0 + second), own_m)
    assert shape is not None
    assert shape.turn_rad == pytest.approx(turn_rad)
    assert trust.on_within_gate(), "they were right after all"


@pytest.mark.parametrize(("turned_rad", "is_kept"), [(0.0, True), (1.0, False)])
def test_walk_drawn_elsewhere_supplies_a_heading_that_it_confirms(
    turned_rad: float, is_kept: bool
) -> None:
    """The heading is dropped where the fixes draw another walk."""
    fuser = GpsInertial().new()
    fuser.start(Start(0.0, 0.0, 0.0, 0.0, 0.5, 0.05))
    for second in range(60):
        walk(fuser, [second])
        way_m = second + 0.8
        north_m, east_m = way_m * math.cos(turned_rad), 200.0 + way_m * math.sin(turned_rad)
        verdict = fuser.update_gnss(fix_at(way_m, north_m, east_m))
        if verdict.reason.startswith("contradicts"):
            break
    assert verdict.reason.startswith("contradicts")
    estimate = fuser.estimate()
    assert estimate is not None
    assert (estimate.heading_std_rad < 0.3) is is_kept


@pytest.mark.parametrize(("std_m", "is_assumed"), [(3.0, False), (8.0, True)])
def test_fix_under_the_open_sky_shows_a_start_at_ground_level(
    std_m: float, is_assumed: bool
) -> None:
    fuser = GpsInertial().new()
    walk_with_fixes(fuser, range(5), std_m=std_m)
    estimate = fuser.estimate()
    assert estimate is not None
    assert estimate.since_gps_s is not None
    assert estimate.height_assumed is is_assumed


def test_fixes_worse_than_their_accuracy_make_the_next_one_worse() -> None:
    trust = ReceiverModel()
    best = PlaceFix(0, 0.0, 0.0, 0.0, STD_M, None)
    for _ in range(4):
        trust.update_inflation(9.7)
    assert trust.inflation > 2.0
    assert trust.extra_m2(best, 0.0) == pytest.approx(STD_M**2 * (trust.inflation - 1.0))
