"""A path in an incident frame that is moved, or in which the path turns out to lie elsewhere."""

from __future__ import annotations

import math

import msgspec
import numpy as np
import pytest

from base_station.fusion.interface import Estimate, PlaceFix, Start
from base_station.fusion.odometry.path_history import PathHistory
from base_station.fusion.odometry.rigid_transform import RigidTransform2D
from base_station.fusion.odometry.start_correction import StartCorrection
from shared.clock import NS_PER_S
from shared.quality import Quality
from tests.rig.published_path import at, walked


def test_moved_frame_moves_values_of_the_frame_only() -> None:
    history = walked(300)
    history.fix(PlaceFix(0, 10.0, 0.0, 0.0, 3.0, None), NS_PER_S)
    history.set_start(Start(10.0, 0.0, 1.0, 0.0, 0.5, 0.2))
    before = history.arrays()
    history.reframe(math.pi / 2.0, 1.0, 2.0, 3.0)
    after = history.arrays()
    assert np.array_equal(after.own_m, before.own_m)
    assert after.fix_m[0].tolist() == pytest.approx([1.0, 12.0], abs=1e-3)
    assert after.down_m == pytest.approx(before.down_m + 3.0), "packed or not"
    start = history.start.position
    assert start is not None
    assert (start.north_m, start.east_m, start.down_m) == pytest.approx((1.0, 12.0, 4.0))
    assert start.heading_rad == pytest.approx(math.pi / 2.0)


def test_frame_moved_twice_moves_all_rows_whenever_packed() -> None:
    history, place = PathHistory(), RigidTransform2D()
    moves = {
        400: RigidTransform2D(0.5, 10.0, -4.0, 3.0),
        800: RigidTransform2D(-0.2, 1.0, 2.0, -5.0),
    }
    for second in range(1200):
        if second in moves:
            history.reframe(*msgspec.structs.astuple(moves[second]))
            place = place.followed_by(moves[second])
        history.append(at(float(second), float(second)), second * NS_PER_S, jumped=False)
        north_m, east_m = place.apply(float(second), 5.0)
        stds_m = 1.0, 1.0, 1.0
        shown = Estimate(
            0, north_m, east_m, place.down_m, *stds_m, 0.0, 0.0, 0.1, Quality.GOOD, "", None
        )
        history.set_live_estimate(shown, None)
    assert len(history.own.packed.chunks) > 4
    arrays = history.arrays()
    north_m, east_m = moves[800].apply(*moves[400].apply(1000.0, 5.0))
    row = int(np.searchsorted(arrays.t_ns, 1000 * NS_PER_S))
    assert arrays.shown_m[row].tolist() == pytest.approx([north_m, east_m], abs=0.05)
    expected_m = [place.apply(own_north_m, 5.0) for own_north_m in arrays.own_m[:, 0].tolist()]
    assert arrays.shown_m == pytest.approx(np.array(expected_m), abs=0.05)
    assert arrays.down_m == pytest.approx(-2.0, abs=0.02)


@pytest.mark.parametrize("seconds", [20, 800], ids=["as it is", "packed"])
def test_corrected_run_is_shown_at_its_place_and_the_earlier_path_stays(seconds: int) -> None:
    """In a frame that has moved since."""
    history = walked(seconds, east_mps=0.5)
    history.reframe(0.4, 3.0, -2.0, 1.5)
    before = history.arrays()
    begin_ns = int(before.t_ns[10])
    assert bool(history.own.packed) is (seconds == 800)
    history.apply_start_correction(StartCorrection(begin_ns, 50.0, -20.0, 0.6, 0.8, 2.5))
    after = history.arrays()
    run = before.t_ns >= begin_ns
    own_m = before.own_m[run]
    assert np.array_equal(after.shown_m[~run], before.shown_m[~run])
    assert np.array_equal(after.down_m[~run], before.down_m[~run])
    north_m = 50.0 + 0.6 * own_m[:, 0] - 0.8 * own_m[:, 1]
    east_m = -20.0 + 0.8 * own_m[:, 0] + 0.6 * own_m[:, 1]
    assert after.shown_m[run] == pytest.approx(np.column_stack((north_m, east_m)), abs=0.03)
    assert after.down_m[run] == pytest.approx(before.down_m[run] + 2.5, abs=0.011)
    assert np.array_equal(after.own_m, before.own_m)


def test_undone_correction_restores_the_place() -> None:
    move = RigidTransform2D(0.8, 30.0, -7.0, 2.0)
    assert move.inverse().apply(*move.apply(4.0, 9.0)) == pytest.approx((4.0, 9.0))
    same = msgspec.structs.astuple(move.followed_by(move.inverse()))
    assert same == pytest.approx((0.0,) * 4, abs=1e-9)


def test_anchor_out_of_range_saturates_and_does_not_wrap() -> None:
    history = walked(20)
    for _ in range(3):
        history.reframe(1.0, 1e300, -1e12, 2e6)
    arrays = history.arrays()
    assert arrays.down_m[0] > 2e6
    assert np.isfinite(arrays.shown_m).all()
