"""Runs of a unit's program in its path, and which of them belong to an incident."""

from __future__ import annotations

import numpy as np
import pytest

from base_station.fusion.interface import PlaceFix, Start
from base_station.fusion.odometry.path_history import PathHistory
from base_station.fusion.odometry.points import RESTART
from base_station.fusion.odometry.start_correction import StartCorrection
from shared.clock import NS_PER_S
from tests.rig.published_path import at, walked

ODD_NS = 400_001  # of a millisecond: packed times have none


def test_trimmed_path_begins_later() -> None:
    history = walked(400)
    for second in range(0, 400, 2):
        history.fix(PlaceFix(0, 10.0, 0.0, 0.0, 3.0, None), second * NS_PER_S)
    history.begin_incident(400 * NS_PER_S, 200 * NS_PER_S)
    assert history.begin_ns == pytest.approx(200 * NS_PER_S, abs=2 * NS_PER_S)
    assert history.arrays().fix_t_ns.min() >= 200 * NS_PER_S
    history.begin_incident(10**18, 10**18)
    assert history.begin_ns is None
    assert len(history.arrays().fix_t_ns) == 0
    assert len(history.arrays()) == 0


def two_runs(seconds: int) -> PathHistory:
    """Two runs of half a minute, the second from a minute on; a fix every two seconds."""
    history = PathHistory()
    for boot_id, begin_s, lasted_s in ((1, 0, 30), (2, 60, seconds)):
        for second in range(begin_s, begin_s + lasted_s):
            t_ns = second * NS_PER_S + ODD_NS
            history.append(at(float(second), 1.0 * second, boot_id), t_ns, jumped=False)
            history.fix(PlaceFix(0, 10.0, 0.0, 0.0, 3.0, None), t_ns)
    return history


@pytest.mark.parametrize("seconds", [30, 600], ids=["as it is", "packed"])
def test_incident_begins_with_the_run_that_continues_in_it(seconds: int) -> None:
    history = two_runs(seconds)
    history.begin_incident((60 + seconds) * NS_PER_S, 0)
    assert bool(history.own.packed) is (seconds == 600)
    arrays = history.arrays()
    assert arrays.own_m[0, 0] == 60.0, "all of it"
    assert arrays.fix_t_ns[0] == 60 * NS_PER_S
    assert len(history.arrays()) >= seconds - 1


def test_run_ended_before_an_incident_is_no_part_of_its_path() -> None:
    history = two_runs(600)
    history.begin_incident(700 * NS_PER_S, 0)
    assert history.begin_ns is not None
    assert history.append(at(720.0, 0.0, boot_id=3), 720 * NS_PER_S, jumped=False)
    assert history.begin_ns == history.end_ns == 720 * NS_PER_S
    assert not history.fixes
    assert not history.append(at(721.0, 0.0, boot_id=3), 721 * NS_PER_S, jumped=False)
    assert not history.append(at(722.0, 0.0, boot_id=4), 722 * NS_PER_S, jumped=False)
    assert history.begin_ns == 720 * NS_PER_S, "what is of the incident stays"
    assert np.count_nonzero(history.arrays().flags & RESTART) == 1


def test_earlier_part_of_a_continuing_run_stays_when_the_next_begins() -> None:
    """It tells where the wearer was when the incident was opened."""
    history = PathHistory()
    for second in range(0, 40, 10):
        if second == 20:
            history.begin_incident(15 * NS_PER_S, 0)
        history.append(at(float(second), 1.0 * second), second * NS_PER_S, jumped=False)
    history.append(at(50.0, 0.0, boot_id=2), 50 * NS_PER_S, jumped=False)
    assert history.begin_ns == 0
    assert len(history.arrays()) == 5


def test_next_run_replaces_the_path_of_a_unit_without_incident() -> None:
    history = walked(20)
    history.begin_incident(30 * NS_PER_S, 25 * NS_PER_S)
    assert history.begin_ns is None
    assert history.append(at(40.0, 0.0, boot_id=2), 40 * NS_PER_S, jumped=False)
    assert history.begin_ns == 40 * NS_PER_S


def test_start_belongs_to_the_path_as_long_as_its_run_does() -> None:
    start, history, held = Start(1.0, 2.0, 0.0, 0.1, 0.5, 0.2), PathHistory(), []
    history.set_start(start)
    history.append(at(1.0, 0.0), NS_PER_S, jumped=False)
    history.begin_incident(2 * NS_PER_S, 2 * NS_PER_S)
    history.append(at(3.0, 1.0), 3 * NS_PER_S, jumped=False)
    held.append(history.start.in_path)
    history.append(at(4.0, 0.0, boot_id=2), 4 * NS_PER_S, jumped=False)
    held.append(history.start.in_path)
    history.begin_incident(5 * NS_PER_S, 2 * NS_PER_S)
    held.append(history.start.in_path)
    history.set_start(start)
    held.append(history.start.in_path)
    history.append(at(6.0, 0.0, boot_id=3), 6 * NS_PER_S, jumped=False)
    held.append(history.start.in_path)
    assert held == [start, start, None, start, None]
    assert history.start.position == start, (
        "a receiver that stays where it is stands there whatever runs"
    )


def test_run_that_seems_to_begin_before_the_last_one_ended_begins_behind_it() -> None:
    """The messages of the first were delayed, and its clock is estimated late."""
    history = PathHistory()
    for second in range(10):
        history.append(at(float(second), 1.0 * second), second * NS_PER_S, jumped=False)
    history.append(at(7.0, 0.0, boot_id=2), 7 * NS_PER_S, jumped=False)
    history.set_start(Start(1.0, 2.0, 0.0, 0.1, 0.5, 0.2))
    arrays = history.arrays()
    (restart,) = np.flatnonzero(arrays.flags & RESTART)
    assert arrays.t_ns[restart] == history.start.begin_ns == history.runs.begin_ns
    history.apply_start_correction(
        StartCorrection(history.runs.begin_ns, 50.0, -20.0, 1.0, 0.0, 0.0)
    )
    assert history.arrays().shown_m[restart - 1].tolist() == [0.0, 0.0]
