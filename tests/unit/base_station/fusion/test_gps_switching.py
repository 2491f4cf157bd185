"""The documents' rule on bad input, compared with the default fuser, and its stated uncertainty."""

from __future__ import annotations

import math

import msgspec
import numpy as np
import pytest

from base_station.fusion.gps_inertial import GpsInertial
from base_station.fusion.gps_switching import GpsSwitching
from base_station.fusion.interface import CompassHeading, Fuser, FuserKind, PlaceFix, Posterior
from shared.geo import rotate, wrap_pi
from tests.bench.fusion.simulated_walks import Receiver, Scores, Walk, run, walks
from tests.rig.message_factory import mono_ns

OURS, RULE = GpsInertial(), GpsSwitching()


def off_m(fuser: Fuser, walk: Walk, index: int) -> float:
    estimate = fuser.estimate()
    assert estimate is not None
    return math.dist((estimate.north_m, estimate.east_m), walk.truth_m[index])


def walked(kind: FuserKind, walk: Walk, end: int) -> Fuser:
    """A walk with a fix a second."""
    fuser, receiver = kind.new(), Receiver(np.random.default_rng(2))
    for index in range(end):
        fuser.predict(walk.position(index))
        if index % 5 == 0:
            fuser.update_gnss(receiver.fix(float(walk.t_s[index]), walk.truth_m[index]))
    return fuser


@pytest.fixture(scope="module")
def walk() -> Walk:
    return Walk.wander(np.random.default_rng(1), 120.0)


def fix_at(walk: Walk, index: int, off_north_m: float, std_m: float = 3.0) -> PlaceFix:
    north_m, east_m = walk.truth_m[index].tolist()
    t_ns = mono_ns(float(walk.t_s[index]))
    return PlaceFix(t_ns, north_m + off_north_m, east_m, 0.0, std_m, None)


@pytest.mark.parametrize(("kind", "follows"), [(RULE, True), (OURS, False)])
def test_outlier_moves_the_wearer_by_the_rule_alone(
    kind: FuserKind, walk: Walk, follows: bool
) -> None:
    fuser = walked(kind, walk, 400)
    assert fuser.update_gnss(fix_at(walk, 399, 200.0)).accepted is follows
    assert (off_m(fuser, walk, 399) > 190.0) is follows
    fuser.update_gnss(fix_at(walk, 399, 0.0))
    assert off_m(fuser, walk, 399) < 10.0, "the next good fix takes it back"


def test_newest_fix_is_the_place_and_the_path_continues_from_there(walk: Walk) -> None:
    fuser = walked(RULE, walk, 400)
    fix = fix_at(walk, 399, 7.0, std_m=4.0)
    assert fuser.update_gnss(fix).accepted
    at_fix = fuser.estimate()
    assert at_fix is not None
    assert (at_fix.north_m, at_fix.east_m) == pytest.approx((fix.north_m, fix.east_m))
    assert at_fix.std_north_m == at_fix.std_east_m == pytest.approx(4.0)
    assert not fuser.update_gnss(fix_at(walk, 390, 0.0)).accepted, "an older one tells nothing new"
    for index in range(400, 450):
        fuser.predict(walk.position(index))
    later = fuser.estimate()
    assert later is not None
    turn_rad = later.heading_rad - walk.position(449).heading_rad
    own_north_m, own_east_m = (walk.own_m[449] - walk.own_m[399]).tolist()
    walked_m = rotate(own_north_m, own_east_m, turn_rad)
    assert later.north_m - fix.north_m == pytest.approx(walked_m[0])
    assert later.east_m - fix.east_m == pytest.approx(walked_m[1])
    assert math.hypot(later.std_north_m, later.std_east_m) > math.hypot(4.0, 4.0)


def test_course_of_fixes_turns_the_path_and_a_surer_compass_has_precedence(walk: Walk) -> None:
    by_course = walked(RULE, walk, 400).estimate()
    assert by_course is not None
    own_rad = walk.position(399).heading_rad
    error_rad = wrap_pi(by_course.heading_rad - own_rad - walk.turn_rad)
    assert abs(error_rad) < 3.0 * by_course.heading_std_rad < 1.0
    compass = walked(RULE, walk, 5)
    compass.update_heading(CompassHeading(walk.turn_rad + 0.02, 0.02))
    compass.update_heading(CompassHeading(walk.turn_rad + 1.0, 0.5))
    estimate = compass.estimate()
    assert estimate is not None
    assert wrap_pi(estimate.heading_rad - walk.turn_rad) == pytest.approx(0.02)


def test_stated_region_holds_with_fixes_and_minutes_after() -> None:
    """Three minutes without a fix, by a heading from the course of fixes alone."""
    scores: list[Scores] = [
        run(RULE.new(), one, receiver, (0.0, 120.0)) for one, receiver in walks(300.0)
    ]
    with_fixes = np.concatenate([one.normalised2[:600] for one in scores])
    after = np.concatenate([one.normalised2[600:] for one in scores])
    assert 0.90 < np.mean(with_fixes < 5.991) < 0.99
    assert 0.90 < np.mean(after < 5.991) < 0.99


def test_solved_past_is_continued(walk: Walk) -> None:
    fuser = walked(RULE, walk, 400)
    covariance = np.diag([0.4, 0.9, 1e-4, 1e-4, 1e-8])
    covariance[0, 1] = covariance[1, 0] = 0.3
    mean = [10.0, 20.0, math.cos(2.0), math.sin(2.0), 0.0]
    fuser.set_posterior(Posterior(mean, covariance.tolist(), 1.0, 0.5))
    estimate = fuser.estimate()
    assert estimate is not None
    assert (estimate.north_m, estimate.east_m) == pytest.approx((10.0, 20.0))
    assert estimate.std_north_m**2 == pytest.approx(0.4)
    assert estimate.correlation_ne == pytest.approx(0.3 / math.sqrt(0.4 * 0.9))
    assert estimate.heading_std_rad == pytest.approx(0.01)
    assert msgspec.structs.replace(estimate, t_mono_ns=0).heading_rad == pytest.approx(
        (2.0 + walk.position(399).heading_rad) % (2.0 * math.pi)
    )
