"""Recorded time is laid on the unit's clock."""

from __future__ import annotations

import pytest

from edge.timeline import Pacer, Timeline
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
