"""Contract of every fuser."""

from __future__ import annotations

import math
import re

import msgspec
import numpy as np
import pytest

from base_station.fusion import FUSERS
from base_station.fusion.building_model.building import LearntBuilding
from base_station.fusion.interface import Estimate, Fuser, FuserKind, Start
from shared.clock import NS_PER_S
from shared.geo import rotate
from shared.messages import Position
from shared.quality import Quality
from tests.bench.fusion.simulated_walks import Receiver, Walk
from tests.rig.message_factory import mono_ns

CHI2_2_95 = 5.991


@pytest.fixture(params=FUSERS, ids=lambda kind: kind.name)
def kind(request: pytest.FixtureRequest) -> FuserKind:
    found: FuserKind = request.param
    return found


@pytest.fixture
def walk() -> Walk:
    return Walk.wander(np.random.default_rng(1), 60.0)


def go(fuser: Fuser, walk: Walk, receiver: Receiver, begin: int, end: int) -> list[Estimate]:
    estimates = []
    for index in range(begin, end):
        fuser.predict(walk.position(index))
        if index % 5 == 0:
            fuser.update_gnss(receiver.fix(float(walk.t_s[index]), walk.truth_m[index]))
        estimate = fuser.estimate()
        assert estimate is not None
        estimates.append(estimate)
    return estimates


def receiver() -> Receiver:
    return Receiver(np.random.default_rng(2))


def test_fuser_names_are_those_of_the_log_and_unique() -> None:
    names = [kind.name for kind in FUSERS]
    assert len(set(names)) == len(names)
    assert all(re.fullmatch(r"[a-z]+(-[a-z]+)*", name) for name in names)


def test_fuser_has_no_estimate_before_the_first_input(kind: FuserKind) -> None:
    assert kind.new().estimate() is None


def test_same_calls_give_the_same_estimates(kind: FuserKind, walk: Walk) -> None:
    one = go(kind.new(), walk, receiver(), 0, len(walk))
    assert go(kind.new(), walk, receiver(), 0, len(walk)) == one


def test_unknown_building_moves_no_estimate(kind: FuserKind, walk: Walk) -> None:
    """Outside, with fixes, no building is learnt either."""
    listening, source, plain = kind.new(), receiver(), go(kind.new(), walk, receiver(), 0, 300)
    assert listening.match_building(LearntBuilding()) == LearntBuilding()
    for index in range(300):
        estimates = go(listening, walk, source, index, index + 1)
        assert listening.match_building(LearntBuilding()) == LearntBuilding()
        assert estimates == [plain[index]]


def test_restored_fuser_continues_with_identical_numbers(kind: FuserKind, walk: Walk) -> None:
    straight, source = kind.new(), receiver()
    first = kind.new()
    go(first, walk, receiver(), 0, 150)
    go(straight, walk, source, 0, 150)
    second = kind.restore(first.save())
    again = receiver()
    for index in range(0, 150, 5):
        again.fix(float(walk.t_s[index]), walk.truth_m[index])
    assert go(second, walk, again, 150, 300) == go(straight, walk, source, 150, 300)
    assert second.save() == straight.save()


def test_numbers_are_finite_and_uncertainties_possible(kind: FuserKind, walk: Walk) -> None:
    for estimate in go(kind.new(), walk, receiver(), 0, len(walk)):
        numbers = [v for v in msgspec.structs.asdict(estimate).values() if isinstance(v, float)]
        assert all(map(math.isfinite, numbers))
        assert min(estimate.std_north_m, estimate.std_east_m, estimate.std_down_m) >= 0.0
        assert -1.0 <= estimate.correlation_ne <= 1.0
        assert 0.0 <= estimate.heading_rad < 2.0 * math.pi
        assert (estimate.quality is Quality.GOOD) == (estimate.quality_reason == "")


def test_moved_frame_moves_everything_and_changes_nothing_else(kind: FuserKind, walk: Walk) -> None:
    plain, moved = kind.new(), kind.new()
    go(plain, walk, receiver(), 0, 200)
    go(moved, walk, receiver(), 0, 200)
    moved.reframe(0.7, 100.0, -20.0, 3.0)
    before, after = plain.estimate(), moved.estimate()
    assert before is not None
    assert after is not None
    north_m, east_m = rotate(before.north_m, before.east_m, 0.7)
    assert (after.north_m, after.east_m) == pytest.approx((north_m + 100.0, east_m - 20.0))
    assert after.down_m == pytest.approx(before.down_m + 3.0)
    assert after.heading_rad == pytest.approx((before.heading_rad + 0.7) % (2.0 * math.pi))
    spread = before.std_north_m**2 + before.std_east_m**2
    assert after.std_north_m**2 + after.std_east_m**2 == pytest.approx(spread)


def test_start_places_the_way_walked_so_far(kind: FuserKind, walk: Walk) -> None:
    fuser = kind.new()
    for index in range(50):
        fuser.predict(walk.position(index))
    fuser.start(Start(10.0, -5.0, -3.0, 1.2, 0.1, 0.0))
    estimate = fuser.estimate()
    assert estimate is not None
    own_north_m, own_east_m = walk.own_m[49]
    north_m, east_m = rotate(own_north_m, own_east_m, 1.2)
    assert (estimate.north_m, estimate.east_m) == pytest.approx((north_m + 10.0, east_m - 5.0))
    assert estimate.down_m == pytest.approx(-3.0)


def test_path_that_jumps_is_not_followed(kind: FuserKind, walk: Walk) -> None:
    fuser = kind.new()
    go(fuser, walk, receiver(), 0, 200)
    before = fuser.estimate()
    walk.own_m[200:] += 500.0
    reason = fuser.predict(walk.position(200))
    after = fuser.estimate()
    assert "jumped" in reason
    assert before is not None
    assert after is not None
    assert math.dist((before.north_m, before.east_m), (after.north_m, after.east_m)) < 1.0


def test_latest_input_is_used_though_the_clock_was_ahead_before(
    kind: FuserKind, walk: Walk
) -> None:
    fuser = kind.new()
    go(fuser, walk, receiver(), 0, 100)
    ahead = walk.position(100)
    header = msgspec.structs.replace(
        ahead.header, t_mono_ns=ahead.header.t_mono_ns + 86_400 * NS_PER_S
    )
    assert not fuser.predict(msgspec.structs.replace(ahead, header=header))
    assert not fuser.predict(walk.position(101))
    go(fuser, walk, receiver(), 102, 200)
    estimate = fuser.estimate()
    assert estimate is not None
    assert math.dist((estimate.north_m, estimate.east_m), walk.truth_m[199]) < 10.0


def begun_anew(kind: FuserKind, behind_s: float) -> list[Estimate]:
    """Inputs of a unit whose program restarts after a minute with a clock that is far behind; no
    fixes for ten seconds around that and after the second minute.
    """
    fuser, source, restart = kind.new(), receiver(), 300
    walk = Walk.wander(np.random.default_rng(1), 180.0)
    walk.own_m[restart:] -= walk.own_m[restart - 1]
    estimates = []
    for index in range(len(walk)):
        t_s = float(walk.t_s[index])
        t_mono_ns = mono_ns(t_s - behind_s if index >= restart else t_s)
        position = walk.position(index, boot_id=1 if index < restart else 2)
        header = msgspec.structs.replace(position.header, t_mono_ns=t_mono_ns)
        fuser.predict(msgspec.structs.replace(position, header=header))
        if index % 5 == 0 and index < 600 and abs(index - restart) > 50:
            fix = source.fix(t_s, walk.truth_m[index])
            assert fuser.update_gnss(msgspec.structs.replace(fix, t_mono_ns=t_mono_ns)).accepted
        estimate = fuser.estimate()
        assert estimate is not None
        assert estimate.t_mono_ns == t_mono_ns
        estimates.append(estimate)
    return estimates


def test_ages_and_errors_of_fixes_are_right_though_the_units_clock_restarted(
    kind: FuserKind,
) -> None:
    """With another battery the clock of its machine begins at zero."""
    usual, anew = begun_anew(kind, 0.0), begun_anew(kind, 900.0)
    for one, other in zip(usual, anew, strict=True):
        assert other.since_gps_s == pytest.approx(one.since_gps_s, abs=0.3)
        std_m = math.hypot(one.std_north_m, one.std_east_m)
        assert math.hypot(other.std_north_m, other.std_east_m) == pytest.approx(std_m, rel=0.05)
    assert anew[-1].since_gps_s is not None
    assert anew[-1].since_gps_s > 60.0


def test_older_position_is_refused(kind: FuserKind, walk: Walk) -> None:
    fuser = kind.new()
    go(fuser, walk, receiver(), 0, 100)
    before = fuser.save()
    assert fuser.predict(walk.position(50))
    assert fuser.save() == before


def test_receiver_without_tracker_is_followed(kind: FuserKind, walk: Walk) -> None:
    fuser, source = kind.new(), receiver()
    for index in range(0, len(walk), 5):
        fuser.update_gnss(source.fix(float(walk.t_s[index]), walk.truth_m[index]))
    estimate = fuser.estimate()
    assert estimate is not None
    assert math.dist((estimate.north_m, estimate.east_m), walk.truth_m[-1]) < 15.0


def test_estimate_at_the_present_time_is_the_present_estimate(kind: FuserKind, walk: Walk) -> None:
    fuser = kind.new()
    present = go(fuser, walk, receiver(), 0, len(walk))[-1]
    recalled = fuser.estimate_at(walk.position(len(walk) - 1))
    assert recalled is not None
    assert recalled.north_m == pytest.approx(present.north_m)
    assert recalled.east_m == pytest.approx(present.east_m)
    assert recalled.std_north_m == pytest.approx(present.std_north_m)


@pytest.mark.slow
def test_estimates_of_the_past_lie_near_the_true_path(kind: FuserKind) -> None:
    inside = total = 0
    for seed in range(20):
        rng = np.random.default_rng(seed)
        walk = Walk.wander(rng, 120.0)
        fuser = kind.new()
        go(fuser, walk, Receiver(rng), 0, len(walk))
        before = fuser.save()
        for index in range(len(walk) - 300, len(walk), 20):
            recalled = fuser.estimate_at(walk.position(index))
            assert recalled is not None
            assert recalled.t_mono_ns == walk.position(index).header.t_mono_ns
            error_m = np.array([recalled.north_m, recalled.east_m]) - walk.truth_m[index]
            product = recalled.correlation_ne * recalled.std_north_m * recalled.std_east_m
            covariance = np.array(
                [[recalled.std_north_m**2, product], [product, recalled.std_east_m**2]]
            )
            inside += float(error_m @ np.linalg.solve(covariance, error_m)) < CHI2_2_95
            total += 1
        assert fuser.save() == before
    assert inside / total > 0.85


def restarted(position: Position) -> Position:
    """Inputs of the next run of the unit's program."""
    header = msgspec.structs.replace(position.header, boot_id=position.header.boot_id + 1)
    return msgspec.structs.replace(position, header=header)


def test_estimate_of_the_run_before_is_unchanged_after_its_end(kind: FuserKind, walk: Walk) -> None:
    fuser = kind.new()
    go(fuser, walk, receiver(), 0, 100)
    earlier, later = walk.position(90), walk.position(110)
    before = fuser.estimate_at(earlier)
    assert before is not None
    fuser.predict(restarted(walk.position(0)), 30.0)
    fuser.update_gnss(receiver().fix(float(walk.t_s[130]), walk.truth_m[130] + 50.0))
    assert fuser.estimate_at(earlier) == before
    fuser = kind.restore(fuser.save())
    assert fuser.estimate_at(earlier) == before
    behind = fuser.estimate_at(later)
    assert behind is not None, "it was not heard before the run was over"
    assert math.dist((behind.north_m, behind.east_m), walk.truth_m[110]) < 10.0
    assert behind.std_north_m > before.std_north_m
    fuser.reframe(math.pi / 2, 100.0, 0.0, 3.0)
    moved = fuser.estimate_at(earlier)
    assert moved is not None
    place = moved.north_m - 100.0, moved.east_m, moved.down_m - 3.0
    assert place == pytest.approx((-before.east_m, before.north_m, before.down_m))
    fuser.predict(restarted(restarted(walk.position(0))), 30.0)
    assert fuser.estimate_at(earlier) is None, "of the one before that nothing is known any more"
    assert fuser.estimate_at(restarted(walk.position(1))) is not None


def test_other_run_of_the_unit_has_no_estimate(kind: FuserKind, walk: Walk) -> None:
    fuser = kind.new()
    go(fuser, walk, receiver(), 0, 50)
    earlier = walk.position(10)
    header = msgspec.structs.replace(earlier.header, boot_id=earlier.header.boot_id + 1)
    assert fuser.estimate_at(msgspec.structs.replace(earlier, header=header)) is None
