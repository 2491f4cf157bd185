"""Satellite fixes that are kept with a unit's own path."""

from __future__ import annotations

import numpy as np
import pytest

from base_station.fusion.interface import Estimate, PlaceFix
from base_station.fusion.odometry.path_history import PathHistory
from base_station.fusion.odometry.points import FIX_ROW
from base_station.fusion.odometry.rigid_transform import RigidTransform2D
from shared.clock import NS_PER_S
from shared.quality import Quality
from tests.rig.published_path import at, insert_late, walked


def taken(history: PathHistory, t_s: float) -> None:
    """A fix whose place encodes its time."""
    history.fix(PlaceFix(0, t_s, 0.0, 0.0, 3.0, None), round(t_s * NS_PER_S))


def kept_s(history: PathHistory) -> list[float]:
    arrays = history.arrays()
    times_s: list[float] = (arrays.fix_t_ns / NS_PER_S).tolist()
    assert arrays.fix_m[:, 0].tolist() == times_s
    return times_s


def test_nearby_fixes_are_one() -> None:
    history = walked(10)
    for fifth in range(50):
        taken(history, fifth / 5)
    assert kept_s(history) == [0.0, 2.0, 4.0, 6.0, 8.0]


def test_late_fixes_between_live_ones_are_thinned_like_live_ones() -> None:
    """A journal is read while the receiver goes on."""
    history = walked(10)
    for second in range(600):
        taken(history, 1000.0 + second)
        taken(history, float(second))
    assert history.fixes.packed
    stored = len(history.fixes.packed.rows(FIX_ROW)) + len(history.fixes.loose) // FIX_ROW.itemsize
    assert stored == pytest.approx(600, abs=10), "no more is kept than is of use"
    live = [1000.0 + second for second in range(0, 600, 2)]
    assert kept_s(history) == [*map(float, range(0, 600, 2)), *live]


@pytest.mark.parametrize("late_s", [100.5, 1001.0])
def test_late_fix_beside_a_known_one_is_left_out(late_s: float) -> None:
    """Packed or not."""
    history = walked(10)
    for second in range(0, 1004, 2):
        taken(history, float(second))
    assert history.fixes.packed
    before = kept_s(history)
    taken(history, late_s)
    assert kept_s(history) == before


def test_late_fixes_fill_a_gap_in_any_order() -> None:
    history = walked(10)
    for late_s in (0.0, 2.0, 20.0, 22.0, 18.0, 19.0, 3.0, 4.0, 10.0):
        taken(history, late_s)
    assert kept_s(history) == [0.0, 2.0, 4.0, 10.0, 18.0, 20.0, 22.0]


def test_fixes_before_the_path_do_not_belong_to_its_begin() -> None:
    """A tracker was started late, or a journal brings messages of before the incident."""
    history = PathHistory()
    for second in range(0, 200, 2):
        taken(history, float(second))
    assert len(history.arrays()) == 0
    for second in range(61, 120):
        history.append(at(second, second - 61.0), second * NS_PER_S, jumped=False)
    assert kept_s(history)[0] == 60.0
    insert_late(history, at(31.0, -30.0))
    assert kept_s(history)[0] == 30.0


@pytest.mark.parametrize(("boot_id", "jumped"), [(2, False), (1, True)], ids=["restart", "jump"])
def test_fixes_at_a_break_of_the_path_belong_to_neither_end(boot_id: int, jumped: bool) -> None:
    history = PathHistory()
    for second in range(20):
        history.append(at(second, float(second)), second * NS_PER_S, jumped=False)
    for second in range(0, 60, 2):
        taken(history, second + 1.5)
    for second in range(50, 60):
        is_first = second == 50
        history.append(at(second, 0.0, boot_id), second * NS_PER_S, jumped and is_first)
    near_s = [t_s for t_s in kept_s(history) if 17.0 < t_s < 54.0]
    assert near_s == [17.5, 19.5, 51.5, 53.5]


def test_one_fix_elsewhere_suffices_to_place_its_unit_again() -> None:
    history = walked(20)
    taken(history, 10.0)
    assert history.move_fixes(0.0, 0.0, 2.0)
    assert history.arrays().fix_m.tolist() == [[10.0, 2.0]]


def test_live_estimates_with_moved_fixes_are_dropped() -> None:
    """Both recent and old ones."""
    history = PathHistory()
    taken(history, 1.0)
    for second in range(400):
        history.append(at(second, 1.0 * second), second * NS_PER_S, jumped=False)
        place = 1.0 * second, 0.0, 0.0, 0.5, 0.5, 0.5
        history.set_live_estimate(Estimate(0, *place, 0.0, 0.0, 0.1, Quality.GOOD, "", None), None)
    assert history.own.packed
    assert (history.arrays().shown_std_m == 0.5).all()
    assert history.move_fixes(0.0, 0.0, 2.0)
    assert not history.arrays().shown_std_m.any()


def test_fixes_elsewhere_move_in_the_present_frame() -> None:
    history = walked(20)
    assert not history.move_fixes(0.3, 1.0, 2.0)
    for second in range(0, 800, 2):
        history.fix(PlaceFix(0, 0.1 * second, 5.0, 0.0, 3.0, None), second * NS_PER_S)
    history.reframe(0.4, 3.0, -2.0, 0.0)
    before = history.arrays()
    assert history.fixes.packed
    assert history.move_fixes(-0.7, 10.0, 4.0)
    assert history.is_refixed
    after = history.arrays()
    expected_m = [
        RigidTransform2D(-0.7, 10.0, 4.0).apply(*place_m) for place_m in before.fix_m.tolist()
    ]
    assert after.fix_m == pytest.approx(np.array(expected_m), abs=0.04)
    assert np.array_equal(after.shown_m, before.shown_m)
