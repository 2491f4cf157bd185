"""Late fixes and positions, against simulated walks with known truth."""

from __future__ import annotations

import math

import numpy as np

from base_station.fusion.interface import FuserKind
from tests.bench.fusion.simulated_walks import SEEDS, Receiver, Scores, Walk, run, walks


def test_a_late_fix_corrects_as_if_it_had_come_in_time(kind: FuserKind) -> None:
    for walk, receiver in walks(120.0)[:10]:
        punctual, late = kind.new(), kind.new()
        waiting = []
        for index in range(len(walk)):
            for fuser in (punctual, late):
                fuser.predict(walk.position(index))
            if index % 5 == 0:
                fix = receiver.fix(float(walk.t_s[index]), walk.truth_m[index])
                punctual.update_gnss(fix)
                waiting.append(fix)
            if len(waiting) > 8:
                late.update_gnss(waiting.pop(0))
        for fix in waiting:
            late.update_gnss(fix)
        one, other = punctual.estimate(), late.estimate()
        assert one is not None
        assert other is not None
        apart_m = math.dist((one.north_m, one.east_m), (other.north_m, other.east_m))
        assert apart_m < 0.5 * math.hypot(one.std_north_m, one.std_east_m)


def test_fix_older_than_the_path_is_rejected_with_a_reason(kind: FuserKind) -> None:
    walk = Walk.wander(np.random.default_rng(0), 300.0)
    fuser, receiver = kind.new(), Receiver(np.random.default_rng(1))
    old = receiver.fix(-60.0, walk.truth_m[5])
    run(fuser, walk, receiver, (100.0, 200.0))
    verdict = fuser.update_gnss(old)
    assert not verdict.accepted
    assert verdict.reason == "too old"


def test_backfilled_fixes_are_applied_at_their_measurement_time(kind: FuserKind) -> None:
    """Two minutes of walk and fixes are only heard of when the unit is inside; then the fixes
    tell where it is now, as far as its own path is right, and no better than that.
    """
    without, filled, normalised2 = [], [], []
    for walk, receiver in walks(240.0):
        fuser = kind.new()
        silent = range(100, 700)
        fixes = []
        for index in range(len(walk)):
            t_s = float(walk.t_s[index])
            fix = receiver.fix(t_s, walk.truth_m[index]) if index % 5 == 0 else None
            if index in silent:
                fixes += [] if fix is None else [fix]
                continue
            fuser.predict(walk.position(index))
            if fix is not None and index < 40:
                fuser.update_gnss(fix)
        before = fuser.estimate()
        assert before is not None
        without.append(math.dist((before.north_m, before.east_m), walk.truth_m[-1]))
        for index in silent:
            fuser.insert_late_position(walk.position(index))
        taken = [fuser.update_gnss(fix).accepted for fix in fixes]
        scores = Scores()
        scores.note(fuser, walk.truth_m[-1])
        filled += scores.error_m
        normalised2 += scores.normalised2
        assert np.mean(taken) > 0.5
    assert np.mean(filled) < 0.5 * np.mean(without)
    assert np.mean(np.array(normalised2) < 5.991) > 0.8


def test_late_fixes_of_a_gap_correct_the_current_position(kind: FuserKind) -> None:
    """The fixes of a gap come after newer ones."""
    better = 0
    for walk, receiver in walks(200.0):
        fuser = kind.new()
        kept = []
        for index in range(len(walk)):
            t_s = float(walk.t_s[index])
            fuser.predict(walk.position(index))
            if index % 5 == 0 and t_s < 150.0:
                fix = receiver.fix(t_s, walk.truth_m[index])
                if 30.0 < t_s < 140.0:
                    kept.append(fix)
                else:
                    fuser.update_gnss(fix)
        before = fuser.estimate()
        assert before is not None
        assert all(fuser.update_gnss(fix).accepted for fix in kept[::10])
        after = fuser.estimate()
        assert after is not None
        assert after.std_north_m + after.std_east_m < before.std_north_m + before.std_east_m
        off_m = [math.dist((one.north_m, one.east_m), walk.truth_m[-1]) for one in (before, after)]
        better += off_m[1] < off_m[0]
    assert better > len(SEEDS) / 2
