"""A receiver's UTC laid onto the unit's monotonic clock."""

from __future__ import annotations

import numpy as np
import pytest

from edge.sources.gnss.fix_clock import FixClock
from shared.clock import NS_PER_S

MS = NS_PER_S // 1000
DAY = 86_400 * NS_PER_S
BEGAN = 7_000 * NS_PER_S  # of the unit, on its own clock
LATENCY_S = 0.1


def errors_s(
    utc_s: np.ndarray, late_s: np.ndarray, stated_s: np.ndarray | None = None, drift: float = 0.0
) -> np.ndarray:
    """By how much fixes are placed too late; NaN of those that are not placed.

    ``utc_s``: the instants since midnight; ``said_s``: what the receiver calls them.
    """
    stated_s = utc_s if stated_s is None else stated_s
    clock = FixClock(LATENCY_S)
    found = []
    for utc, reported, late in zip(utc_s.tolist(), stated_s.tolist(), late_s.tolist(), strict=True):
        meant_ns = BEGAN + round((utc - utc_s[0]) * (1.0 + drift) * NS_PER_S)
        t_ns = clock.place(round(reported * NS_PER_S) % DAY, meant_ns + round(late * NS_PER_S))
        found.append(np.nan if t_ns is None else (t_ns - meant_ns) / NS_PER_S)
    return np.array(found)


def late_by(count: int, seed: int = 1, jitter_s: float = 0.08) -> np.ndarray:
    """Delay by the receiver's latency and by the line, which mostly adds little."""
    return LATENCY_S + np.random.default_rng(seed).exponential(jitter_s, count).clip(0.0, 0.4)


@pytest.mark.parametrize("rate_hz", [1.0, 10.0])
@pytest.mark.parametrize("drift", [-1e-4, 0.0, 1e-4])
def test_the_quickest_fix_tells_when_the_others_were(rate_hz: float, drift: float) -> None:
    """Ten minutes over midnight, on a line that adds up to 0.4 s."""
    utc_s = 86_200.0 + np.arange(0.0, 600.0, 1.0 / rate_hz)
    errors = errors_s(utc_s, late_by(len(utc_s)), drift=drift)[round(20 * rate_hz) :]
    assert errors.min() > -0.01
    assert errors.max() < 0.05
    assert np.diff(errors).max() < 0.05


def test_fixes_delayed_by_the_line_keep_their_times() -> None:
    """For four seconds nothing comes, then everything at once."""
    utc_s = np.arange(1000.0, 1100.0)
    late_s = np.full(100, LATENCY_S)
    late_s[40:44] += [4.0, 3.0, 2.0, 1.0]
    assert errors_s(utc_s, late_s) == pytest.approx(np.zeros(100), abs=1e-6)


def test_a_line_that_is_slower_for_two_seconds_is_no_other_clock() -> None:
    """However many fixes that are."""
    utc_s = np.arange(1000.0, 1030.0, 0.1)
    late_s = np.full(300, LATENCY_S)
    late_s[100:120] += 1.0
    assert errors_s(utc_s, late_s) == pytest.approx(np.zeros(300), abs=1e-6)


def test_a_line_that_stops_now_and_then_for_as_long_is_no_other_clock() -> None:
    utc_s = np.arange(1000.0, 1060.0)
    late_s = np.full(60, LATENCY_S)
    late_s[10::5] += 1.0
    assert errors_s(utc_s, late_s) == pytest.approx(np.zeros(60), abs=1e-6)


@pytest.mark.parametrize(
    "more_s", [np.arange(1.0, 9.0), np.arange(8.0, 0.6, -0.6)], ids=["slower", "quicker"]
)
def test_a_line_that_gets_slower_or_quicker_is_no_other_clock(more_s: np.ndarray) -> None:
    utc_s = np.arange(1000.0, 1060.0)
    late_s = np.full(60, LATENCY_S)
    late_s[20 : 20 + len(more_s)] += more_s
    assert errors_s(utc_s, late_s) == pytest.approx(np.zeros(60), abs=1e-6)


@pytest.mark.parametrize("apart_h", [-12, -6, 6, 12])
def test_offset_of_the_two_clocks_is_irrelevant(apart_h: int) -> None:
    """Their difference is known to a day, and may be anything in it."""
    utc_s = BEGAN / NS_PER_S + 3600.0 * apart_h + LATENCY_S + 0.02 + np.arange(0.0, 120.0)
    errors = errors_s(utc_s, late_by(120))[20:]
    assert errors.min() > -0.01
    assert errors.max() < 0.05


@pytest.mark.parametrize("jump_s", [-3600.0, -18.0, -2.0, -1.0, 1.0, 3.0, 18.0, 3600.0])
def test_utc_that_jumps_is_believed_after_three_seconds(jump_s: float) -> None:
    """Leap seconds that were learnt late, or a receiver started anew."""
    utc_s = np.arange(1000.0, 1060.0)
    stated_s = utc_s + np.where(utc_s >= 1030.0, jump_s, 0.0)
    errors = errors_s(utc_s, late_by(60, jitter_s=0.02), stated_s)
    assert np.nanmax(errors) < 0.1, "never in the future"
    assert errors[35:] == pytest.approx(np.zeros(25), abs=0.1)
    if jump_s > 0.0:
        assert errors[30:34] == pytest.approx(np.zeros(4), abs=0.2)
    elif jump_s < -10.0:
        assert np.isnan(errors[30:33]).all(), "that a line held them so long is not believed"


def test_one_time_that_is_wrong_moves_nothing() -> None:
    utc_s = np.arange(1000.0, 1060.0)
    stated_s = utc_s.copy()
    stated_s[[20, 40]] += [7000.0, -7000.0]
    errors = errors_s(utc_s, np.full(60, LATENCY_S), stated_s)
    assert np.isnan(errors[40])
    assert np.delete(errors, 40) == pytest.approx(np.zeros(59), abs=1e-6)


def test_an_instant_counts_once_and_none_is_by_its_arrival() -> None:
    clock = FixClock(LATENCY_S)
    assert clock.place(5 * NS_PER_S, BEGAN) == BEGAN - 100 * MS
    assert clock.place(5 * NS_PER_S, BEGAN + NS_PER_S) is None
    assert (clock.repeated, clock.implausible) == (1, 0)
    assert clock.place(None, BEGAN + 2 * NS_PER_S) == BEGAN + 1900 * MS


def test_after_long_without_fixes_it_begins_anew() -> None:
    """Half an hour indoors, in which the unit's clock drifted by 0.2 s."""
    clock = FixClock(0.0)
    for second in range(10):
        clock.place(second * NS_PER_S, BEGAN + second * NS_PER_S)
    late_ns = BEGAN + 1800 * NS_PER_S + 200 * MS
    assert clock.place(1800 * NS_PER_S, late_ns) == late_ns
