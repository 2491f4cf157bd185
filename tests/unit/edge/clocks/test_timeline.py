"""Mapping of recorded time to the unit's clock."""

from __future__ import annotations

import pytest

from edge.clocks.timeline import Follower, Pacer, Timeline
from shared.clock import NS_PER_S


def test_a_live_source_is_already_on_the_clock():
    assert Timeline().to_mono_ns(123_456_789_012_345_678) == 123_456_789_012_345_678


@pytest.mark.parametrize("speed", [0.5, 1.0, 4.0])
def test_a_recording_runs_at_its_speed_from_the_first_sample(speed):
    pacer = Pacer(speed)
    first = pacer.place(5 * NS_PER_S, 6 * NS_PER_S, now_mono_ns=1000)
    later = pacer.place(9 * NS_PER_S, 10 * NS_PER_S, now_mono_ns=99 * NS_PER_S)
    assert first == later
    assert later.to_mono_ns(5 * NS_PER_S) == 1000
    assert later.to_mono_ns(9 * NS_PER_S) == 1000 + round(4 * NS_PER_S / speed)


@pytest.mark.parametrize("jump_s", [86_400, -86_400, -2, 11])
def test_a_clock_that_jumped_is_no_wait(jump_s):
    pacer = Pacer(1.0)
    pacer.place(0, 100 * NS_PER_S, now_mono_ns=0)
    t_ns = (100 + jump_s) * NS_PER_S
    timeline = pacer.place(t_ns, t_ns, now_mono_ns=100 * NS_PER_S)
    assert timeline.to_mono_ns(t_ns) == 100 * NS_PER_S


def test_a_gap_is_a_wait():
    pacer = Pacer(1.0)
    pacer.place(0, NS_PER_S, now_mono_ns=0)
    timeline = pacer.place(8 * NS_PER_S, 8 * NS_PER_S, now_mono_ns=NS_PER_S)
    assert timeline.to_mono_ns(8 * NS_PER_S) == 8 * NS_PER_S


BATCH_NS = NS_PER_S // 20


def followed(follower: Follower, t_s: float, now_s: float) -> float:
    """Time in seconds that a batch arriving now gets."""
    t_ns = round(t_s * NS_PER_S)
    timeline = follower.place(t_ns - BATCH_NS, t_ns, round(now_s * NS_PER_S))
    return timeline.to_mono_ns(t_ns) / NS_PER_S


def test_another_machine_s_time_is_laid_by_what_came_quickest():
    follower = Follower()
    assert followed(follower, 100.0, 7.0) == 7.0
    assert followed(follower, 100.1, 5.1) == 5.1, "the first one had been held up"
    for late_s in (0.5, 3.0, 60.0):
        assert followed(follower, 100.0 + late_s, 5.0 + 2.0 * late_s) == pytest.approx(
            5.0 + late_s, abs=0.02
        )


@pytest.mark.parametrize("drift", [5e-5, -5e-5])
def test_two_clocks_that_drift_apart_are_followed_for_a_shift(drift):
    follower = Follower()
    for minute in range(12 * 60):
        now_s = 60.0 * minute
        delay_s = 2.0 if minute % 3 else 0.02
        laid_s = followed(follower, now_s * (1.0 + drift) + 100.0, now_s + delay_s)
        assert laid_s == pytest.approx(now_s + 0.02, abs=0.05)


def test_a_backlog_after_an_outage_is_laid_where_it_belongs():
    follower = Follower()
    followed(follower, 10.0, 10.0)
    for number in range(20 * 600):  # ten minutes of it come in five seconds
        t_s = 10.05 + number / 20
        assert followed(follower, t_s, 610.0 + number / 2400) == pytest.approx(t_s, abs=0.13)


def test_a_clock_that_was_set_back_is_laid_anew():
    follower = Follower()
    followed(follower, 1000.0, 5.0)
    assert followed(follower, 999.5, 6.0) == 4.5, "a message that was overtaken"
    assert followed(follower, 3.0, 7.0) == 7.0
