"""Late positions of a unit's own path: into its gaps, and before its beginning."""

from __future__ import annotations

import numpy as np
import pytest

from base_station.fusion.interface import Start
from base_station.fusion.odometry.packed_rows import CHUNK
from base_station.fusion.odometry.path_history import PathHistory
from base_station.fusion.odometry.points import DOUBTFUL, RESTART
from shared.clock import NS_PER_S
from shared.quality import Quality
from tests.rig.published_path import at, insert_late, walked


def test_gap_over_a_break_of_the_path_is_not_filled() -> None:
    """The side of the break is unknown."""
    history = PathHistory()
    for t_s in (0, 1, 2, 22, 23):
        history.append(at(float(t_s), 1.0 * t_s), t_s * NS_PER_S, jumped=t_s == 22)
    before = history.arrays()
    insert_late(history, at(12.0, 12.0))
    assert np.array_equal(history.arrays().t_ns, before.t_ns)


def test_late_positions_never_lie_within_the_run_before() -> None:
    """Their clock is wrong where they would."""
    history = PathHistory()
    for t_s in (0, 10, 20):
        history.append(at(float(t_s), 1.0 * t_s), t_s * NS_PER_S, jumped=False)
    history.append(at(30.0, 0.0, boot_id=2), 30 * NS_PER_S, jumped=False)
    before = history.arrays()
    insert_late(history, at(15.0, 3.0, boot_id=2))
    assert np.array_equal(history.arrays().t_ns, before.t_ns)
    assert history.runs.begin_ns == 30 * NS_PER_S


def test_gap_behind_packed_rows_is_not_filled() -> None:
    history = walked(400)
    del history.own.points[:30]
    before, first_ns = history.arrays(), history.own.points[0].t_ns
    assert history.own.packed
    insert_late(history, at(first_ns / NS_PER_S - 10.0, 0.0))
    assert np.array_equal(history.arrays().t_ns, before.t_ns)


def test_late_positions_of_the_run_before_follow_its_live_ones() -> None:
    """The radio was gone, and the unit's program was restarted meanwhile."""
    history = PathHistory()
    for t_s in (0, 10, 20):
        history.append(at(float(t_s), 1.0 * t_s), t_s * NS_PER_S, jumped=False)
    for t_s in (60, 70, 80):
        history.append(at(float(t_s), t_s - 60.0, boot_id=2), t_s * NS_PER_S, jumped=False)
    for late_s in (45.0, 40.0, 30.0, 15.0, 65.0):  # at the last of them the next run had begun
        insert_late(history, at(late_s, late_s))
    arrays = history.arrays()
    assert (arrays.t_ns / NS_PER_S).tolist() == [0, 10, 15, 20, 30, 40, 45, 60, 70, 80]
    assert arrays.own_m[:, 0].tolist() == [0, 10, 15, 20, 30, 40, 45, 0, 10, 20]
    assert np.flatnonzero(arrays.flags).tolist() == [7], "where the own frame is another one"
    assert arrays.flags[7] == RESTART
    assert arrays.moving_s.tolist() == pytest.approx([0, 10, 5, 5, 10, 10, 5, 0, 10, 10])
    history.append(at(90.0, 0.0, boot_id=3), 90 * NS_PER_S, jumped=False)
    insert_late(history, at(50.0, 50.0))
    assert len(history.arrays()) == 11, "of the one before that nobody knows where it led"


def test_position_later_than_the_path_fills_nothing() -> None:
    """The estimate of its clock has changed meanwhile."""
    history = walked(60)
    before = history.arrays()
    insert_late(history, at(70.0, 70.0))
    assert np.array_equal(history.arrays().t_ns, before.t_ns)


def test_late_positions_fill_a_gap() -> None:
    history = PathHistory()
    for t_s in (0, 1, 2, 22, 23):
        history.append(at(float(t_s), 1.0 * t_s), t_s * NS_PER_S, jumped=False)
    before = history.arrays()
    insert_late(history, at(12.0, 12.0))
    insert_late(history, at(12.5, 12.5))
    insert_late(history, at(17.0, 17.0, quality=Quality.DEGRADED))
    insert_late(history, at(15.0, 15.0, boot_id=9))
    after = history.arrays()
    assert len(after) == len(before) + 2
    row = after.own_m[:, 0].tolist().index(12.0)
    assert after.flags[row : row + 2].tolist() == [0, DOUBTFUL]
    assert after.down_m[row] == -12.0, "as it was estimated for that time"
    assert after.moving_s[row] == pytest.approx(10.0), "half of the way"
    assert after.moving_s.sum() == pytest.approx(before.moving_s.sum())


def test_run_whose_end_came_first_begins_at_its_begin() -> None:
    """An hour of the journal, the newest first, while the wearer walks on."""
    history = PathHistory()
    history.set_start(Start(0.0, 0.0, 0.0, 0.0, 0.5, 0.2))
    received_s = 3600
    for second in range(240):
        history.append(
            at(received_s + second, received_s + second), (received_s + second) * NS_PER_S, False
        )
        for late_s in range(received_s - 15 * second, received_s - 15 * (second + 1), -1):
            insert_late(history, at(late_s, late_s))
    arrays = history.arrays()
    assert history.begin_ns == history.runs.begin_ns == 2 * NS_PER_S
    assert history.start.begin_ns == history.begin_ns, "nobody had been heard when that was said"
    assert np.diff(arrays.t_ns).max() <= 2 * NS_PER_S
    assert (np.diff(arrays.t_ns) > 0).all()
    assert arrays.moving_s.sum() == pytest.approx(3600 + 239 - 2)
    for second in range(400):
        history.append(at(3840 + second, 3840 + second), (3840 + second) * NS_PER_S, False)
    assert len(history.own.points) <= 2 * CHUNK, "packed once nothing comes late any more"


def test_run_that_came_late_begins_after_the_one_before() -> None:
    history = PathHistory()
    history.append(at(0.0, 5.0), 0, jumped=False)
    history.append(at(60.0, 30.0, boot_id=2), 60 * NS_PER_S, jumped=False)
    history.append(at(61.0, 31.0, boot_id=2), 61 * NS_PER_S, jumped=False)
    history.set_start(Start(1.0, 2.0, 0.0, 0.1, 0.5, 0.2))
    for late_s in (50.0, 40.0, 45.0):
        insert_late(history, at(late_s, late_s - 30.0, boot_id=2))
    arrays = history.arrays()
    assert arrays.own_m[:, 0].tolist() == [5.0, 10.0, 15.0, 20.0, 30.0, 31.0]
    assert np.flatnonzero(arrays.flags & RESTART).tolist() == [1]
    assert history.start.begin_ns == 40 * NS_PER_S


def test_positions_before_an_incident_are_not_brought_back() -> None:
    history = PathHistory()
    history.append(at(60.0, 60.0), 60 * NS_PER_S, jumped=False)
    history.begin_incident(60 * NS_PER_S, 30 * NS_PER_S)
    insert_late(history, at(20.0, 20.0))
    assert history.begin_ns == 60 * NS_PER_S
    insert_late(history, at(40.0, 40.0))
    assert history.begin_ns == 40 * NS_PER_S
