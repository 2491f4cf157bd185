"""Errors and stated uncertainty of every fuser on simulated walks with known truth."""

from __future__ import annotations

import math

import numpy as np
import pytest

from base_station.fusion.interface import FuserKind, Start
from shared.geo import wrap_pi
from shared.quality import Quality
from tests.bench.fusion.simulated_walks import (
    SEEDS,
    Errors,
    Floats,
    Receiver,
    Scores,
    Walk,
    run,
    walks,
)
from tests.rig.message_factory import mono_ns

ALWAYS, NEVER = (0.0, math.inf), (math.inf, math.inf)


def together(scores: list[Scores], begin_s: float, end_s: float) -> Floats:
    """All normalised squared errors of that time."""
    part = slice(round(begin_s * 5), round(end_s * 5))
    return np.concatenate([score.normalised2[part] for score in scores])


@pytest.mark.parametrize(("fix_std_m", "worst_m"), [(1.5, 25.0), (3.0, 50.0)])
def test_any_initial_heading_is_found_within_a_walk_of_25_m(
    kind: FuserKind, fix_std_m: float, worst_m: float
) -> None:
    """By a receiver as data sheets have it, always; by one of twice its error, mostly."""
    walked_m = []
    errors = []
    for walk, receiver in walks(120.0, fix_std_m):
        fuser = kind.new()
        for index in range(len(walk)):
            fuser.predict(walk.position(index))
            if index % 5 == 0:
                fuser.update_gnss(receiver.fix(float(walk.t_s[index]), walk.truth_m[index]))
            estimate = fuser.estimate()
            assert estimate is not None
            if estimate.heading_std_rad < 0.2:
                walked_m.append(walk.distance_m[index])
                errors.append(wrap_pi(estimate.heading_rad - walk.turn_rad) / 0.2)
                break
    assert len(walked_m) == len(SEEDS)
    assert np.median(walked_m) < 25.0
    assert max(walked_m) < worst_m
    assert np.sqrt(np.mean(np.square(errors))) < 1.5


def test_the_stated_region_holds_the_truth_with_and_without_gps(kind: FuserKind) -> None:
    """Two minutes outside, then three inside."""
    scores = [run(kind.new(), walk, receiver, (0.0, 120.0)) for walk, receiver in walks(300.0)]
    for begin_s, end_s in ((1.0, 30.0), (30.0, 120.0), (120.0, 180.0), (180.0, 300.0)):
        normalised2 = together(scores, begin_s, end_s)
        assert np.mean(normalised2 < 5.991) > 0.9, f"{begin_s} to {end_s} s"
        assert 0.5 < np.mean(normalised2) < 3.0, f"{begin_s} to {end_s} s"


def test_gps_and_path_together_beat_each_alone(kind: FuserKind) -> None:
    fused, fixes, path = [], [], []
    for walk, receiver in walks(200.0):
        fused += run(kind.new(), walk, receiver, ALWAYS).error_m[300:]
        other = Receiver(np.random.default_rng(1))
        for index in range(300, len(walk), 5):
            fix = other.fix(float(walk.t_s[index]), walk.truth_m[index])
            fixes.append(math.dist((fix.north_m, fix.east_m), walk.truth_m[index]))
        north_m, east_m = walk.truth_m[0]
        start = Start(north_m, east_m, 0.0, walk.turn_rad + 0.2, 0.0, 0.2)
        alone = kind.new()
        alone.start(start)
        path += run(alone, walk, receiver, NEVER).error_m[300:]
    assert np.percentile(fused, 95) < 0.8 * np.percentile(fixes, 95)
    assert np.percentile(fused, 95) < 0.5 * np.percentile(path, 95)


def test_without_gps_a_known_start_is_enough(kind: FuserKind) -> None:
    """The same path as with GPS; only nobody corrects it."""
    scores = []
    for walk, receiver in walks(200.0):
        rng = receiver.rng
        begin = walk.truth_m[0] - (walk.truth_m[1] - walk.truth_m[0])
        north_m, east_m = begin + rng.normal(0.0, 0.5, size=2)
        fuser = kind.new()
        heading_rad = walk.turn_rad + rng.normal(0.0, 0.1)
        fuser.start(Start(north_m, east_m, 0.0, heading_rad, 0.5, 0.1))
        scores.append(run(fuser, walk, receiver, NEVER))
    assert all(score.verdicts == [] for score in scores)
    assert np.mean(together(scores, 1.0, 200.0) < 5.991) > 0.9


def test_start_without_heading_has_full_heading_uncertainty(kind: FuserKind) -> None:
    scores = []
    for walk, receiver in walks(60.0):
        fuser = kind.new()
        north_m, east_m = walk.truth_m[0]
        fuser.start(Start(north_m, east_m, 0.0, 0.0, 1.0, math.pi))
        scores.append(run(fuser, walk, receiver, NEVER))
        estimate = fuser.estimate()
        assert estimate is not None
        assert estimate.heading_std_rad == pytest.approx(math.pi)
        assert estimate.quality is not Quality.GOOD
    assert np.mean(together(scores, 1.0, 60.0) < 5.991) > 0.95


def test_position_without_references_is_relative_to_the_units_start(kind: FuserKind) -> None:
    walk = Walk.wander(np.random.default_rng(0), 30.0)
    fuser = kind.new()
    for index in range(len(walk)):
        fuser.predict(walk.position(index))
        estimate = fuser.estimate()
        assert estimate is not None
        assert (estimate.north_m, estimate.east_m) == pytest.approx(tuple(walk.own_m[index]))
    assert estimate is not None
    assert estimate.quality is Quality.DEGRADED
    assert "start" in estimate.quality_reason


def test_standing_still_adds_no_uncertainty(kind: FuserKind) -> None:
    walk = Walk.wander(np.random.default_rng(0), 120.0)
    fuser = kind.new()
    run(fuser, walk, Receiver(np.random.default_rng(1)), (0.0, 120.0))
    before = fuser.estimate()
    last = len(walk) - 1
    for _ in range(3000):
        walk.t_s[last] += 0.2
        fuser.predict(walk.position(last))
    after = fuser.estimate()
    assert before is not None
    assert after is not None
    assert (after.north_m, after.std_north_m) == pytest.approx((before.north_m, before.std_north_m))
    assert after.since_gps_s == pytest.approx(600.0, abs=1.0)


def test_wrong_confident_fixes_indoors_are_rejected(kind: FuserKind) -> None:
    """Two minutes in, the receiver says 40 m further east, wandering about, and is sure of it."""
    for seed in range(10):
        rng = np.random.default_rng(seed)
        walk = Walk.wander(rng, 240.0)
        fuser, receiver = kind.new(), Receiver(rng)
        scores = Scores()
        rubbish = Receiver(rng, Errors(fix_std_m=3.0, slow_part=0.9, slow_s=60.0))
        for index in range(len(walk)):
            t_s = float(walk.t_s[index])
            fuser.predict(walk.position(index))
            if index % 5 == 0:
                if t_s < 120.0:
                    fuser.update_gnss(receiver.fix(t_s, walk.truth_m[index]))
                else:
                    stuck_about = walk.truth_m[600] + np.array([0.0, 40.0])
                    scores.verdicts.append(fuser.update_gnss(rubbish.fix(t_s, stuck_about)))
            scores.note(fuser, walk.truth_m[index])
        refused = np.mean([not verdict.accepted for verdict in scores.verdicts])
        assert refused > 0.5, f"seed {seed}: {refused:.0%} refused"
        assert max(scores.error_m[600:]) < 15.0, f"seed {seed}"


def test_fixes_after_a_stay_indoors_remove_the_error(kind: FuserKind) -> None:
    """Four minutes inside; then fixes again.  At the end all is as if there had been no house."""
    ends = []
    for walk, receiver in walks(400.0)[:8]:
        fuser = kind.new()
        scores = Scores()
        for index in range(len(walk)):
            t_s = float(walk.t_s[index])
            fuser.predict(walk.position(index))
            if index % 5 == 0 and not 60.0 <= t_s < 300.0:
                scores.verdicts.append(fuser.update_gnss(receiver.fix(t_s, walk.truth_m[index])))
            scores.note(fuser, walk.truth_m[index])
        ends += scores.error_m[-150:]
    assert np.percentile(ends, 95) < 7.0


def test_path_with_an_undetected_turn_is_abandoned_for_consistent_fixes(kind: FuserKind) -> None:
    """Three minutes in the own path turns by 150 degrees at once, and says nothing of it."""
    rng = np.random.default_rng(5)
    walk = Walk.wander(rng, 400.0)
    turned = walk.own_m[900:] - walk.own_m[900]
    walk.own_m[900:] = walk.own_m[900] + turned @ _turn(math.radians(150.0)).T
    fuser, receiver = kind.new(), Receiver(rng)
    scores = Scores()
    for index in range(len(walk)):
        t_s = float(walk.t_s[index])
        fuser.predict(walk.position(index))
        if index % 5 == 0:
            scores.verdicts.append(fuser.update_gnss(receiver.fix(t_s, walk.truth_m[index])))
        scores.note(fuser, walk.truth_m[index])
    assert np.mean(scores.error_m[-100:]) < 6.0


def test_stuck_receiver_is_detected(kind: FuserKind) -> None:
    walk = Walk.wander(np.random.default_rng(3), 120.0)
    fuser, receiver = kind.new(), Receiver(np.random.default_rng(1))
    stuck = Receiver(np.random.default_rng(2)).fix(60.0, walk.truth_m[300])
    verdicts = []
    for index in range(len(walk)):
        fuser.predict(walk.position(index))
        if index % 5 == 0:
            t_s = float(walk.t_s[index])
            fix = receiver.fix(t_s, walk.truth_m[index])
            if t_s > 60.0:
                place = (stuck.north_m, stuck.east_m, 0.0)
                fix = type(stuck)(mono_ns(t_s), *place, stuck.horizontal_std_m, None)
            verdicts.append(fuser.update_gnss(fix))
    assert {verdict.reason for verdict in verdicts[-10:]} == {"the receiver is stuck"}


def test_restarted_unit_continues_from_its_last_position(kind: FuserKind) -> None:
    walk = Walk.wander(np.random.default_rng(4), 300.0)
    receiver = Receiver(np.random.default_rng(1))
    fuser = kind.new()
    scores = Scores()
    restart = 750
    for index in range(len(walk)):
        if index == restart:
            walk.own_m[restart:] -= walk.own_m[restart - 1]
            walk.own_m[restart:] = walk.own_m[restart:] @ _turn(2.0).T  # another own north
        t_s = float(walk.t_s[index])
        fuser.predict(walk.position(index, boot_id=1 if index < restart else 2))
        if index % 5 == 0 and t_s < 140.0:
            fuser.update_gnss(receiver.fix(t_s, walk.truth_m[index]))
        if index % 5 == 0 and t_s > 170.0:
            scores.verdicts.append(fuser.update_gnss(receiver.fix(t_s, walk.truth_m[index])))
        scores.note(fuser, walk.truth_m[index])
    assert scores.inside_95 > 0.9
    assert np.mean(scores.error_m[-100:]) < 6.0


def _turn(angle_rad: float) -> Floats:
    cosine, sine = math.cos(angle_rad), math.sin(angle_rad)
    return np.array([[cosine, -sine], [sine, cosine]])
