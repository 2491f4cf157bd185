"""A device's clock laid onto this machine's."""

from __future__ import annotations

import numpy as np
import pytest

from edge.sources.device_clock import DeviceClock

MS = 1_000_000
S = 1000 * MS
STEP = 5 * MS


def placed(clock: DeviceClock, device_ns: np.ndarray, arrival_ns: np.ndarray) -> list[int | None]:
    pairs = zip(device_ns.tolist(), arrival_ns.tolist(), strict=True)
    return [clock.place(device, arrival) for device, arrival in pairs]


@pytest.mark.slow
@pytest.mark.parametrize("drift", [-1e-4, 0.0, 1e-4])
def test_clock_follows_drift_through_delays(drift: float) -> None:
    """Ten minutes on a radio that delays by up to 80 ms and once holds everything for 3 s."""
    rng = np.random.default_rng(3)
    device_ns = np.arange(0, 600 * S, STEP)
    meant_ns = 7000 * S + np.rint(device_ns * (1.0 + drift)).astype(np.int64)
    arrival_ns = meant_ns + (2 * MS + rng.exponential(15 * MS, len(meant_ns))).astype(np.int64)
    held = (meant_ns > 7300 * S) & (meant_ns < 7303 * S)
    arrival_ns[held] = 7303 * S
    clock = DeviceClock()
    got = np.array(placed(clock, device_ns, np.maximum.accumulate(arrival_ns)), dtype=np.int64)
    assert (np.diff(got) > 0).all()
    late_ns = got - meant_ns
    settled = device_ns > 60 * S
    assert np.abs(late_ns[settled]).max() < 10 * MS
    assert np.abs(np.diff(got) - STEP).max() <= 0.0025 * STEP
    assert not clock.take_events()


def test_a_restart_is_reported_and_time_goes_on() -> None:
    clock = DeviceClock()
    first = [clock.place(t, 50 * S + t) for t in range(0, 4 * S, STEP)]
    again = [clock.place(t, 60 * S + t) for t in range(0, 4 * S, STEP)]
    assert again[0] is None, "one message is not believed"
    assert clock.implausible == 1
    assert again[1] == 60 * S + STEP
    assert first[-1] is not None
    (reported,) = clock.take_events()
    assert "went back by 4.0 s" in reported
    assert not clock.take_events(), "it is told once"


def test_a_32_bit_clock_that_wraps_is_reported_and_leaves_no_gap() -> None:
    clock = DeviceClock()
    wrap_ns = 2**32 * 1000
    device_ns = [(t % wrap_ns) for t in range(wrap_ns - S, wrap_ns + S, STEP)]
    got = [clock.place(t, 9 * S + k * STEP) for k, t in enumerate(device_ns)]
    known = [t for t in got if t is not None]
    assert len(known) == len(got) - 1
    assert max(np.diff(known)) <= 2 * STEP
    assert len(clock.take_events()) == 1


def test_a_clock_set_ahead_is_reported() -> None:
    clock = DeviceClock()
    for t in range(0, S, STEP):
        clock.place(t, t)
    ahead = 3600 * S
    got = [clock.place(t + ahead, t) for t in range(S, 2 * S, STEP)]
    assert got[0] is None
    assert got[1:] == list(range(S + STEP, 2 * S, STEP))
    (reported,) = clock.take_events()
    assert "went ahead by 3600.0 s" in reported


def test_one_impossible_time_costs_one_sample() -> None:
    clock = DeviceClock()
    for t in range(0, S, STEP):
        clock.place(t, t)
    assert clock.place(10**15, S) is None
    assert clock.place(S + STEP, S + STEP) == S + STEP
    assert clock.place(0, S + 2 * STEP) is None
    assert clock.place(S + 2 * STEP, S + 2 * STEP) == S + 2 * STEP
    assert (clock.implausible, clock.repeated) == (2, 0)
    assert not clock.take_events()


def test_repeats_are_counted_and_left_out() -> None:
    clock = DeviceClock()
    assert clock.place(S, 5 * S) == 5 * S
    assert clock.place(S, 5 * S) is None
    assert clock.place(S - STEP, 5 * S) is None
    assert clock.repeated == 2


def test_lost_samples_leave_a_gap_as_long_as_they_were() -> None:
    clock = DeviceClock()
    assert clock.place(S, 5 * S) == 5 * S
    assert clock.place(9 * S, 13 * S) == 13 * S
    assert not clock.take_events()


def test_samples_that_stay_late_are_reported() -> None:
    clock = DeviceClock()
    for t in range(0, 60 * S, STEP):
        clock.place(t, t if t < 20 * S else t + 5 * S)
    reported = clock.take_events()
    assert len(reported) == 1
    assert "5.0 s late" in reported[0]


def test_after_a_cut_time_goes_on_where_it_is_now() -> None:
    """The device kept its clock, or had it started anew: either way it is now."""
    clock = DeviceClock()
    for t in range(0, S, STEP):
        clock.place(t, 100 * S + t)
    clock.reopened()
    assert clock.place(31 * S, 130 * S) == 130 * S
    assert not clock.take_events()


def test_after_a_cut_messages_may_come_sooner_and_time_goes_forward_all_the_same() -> None:
    clock = DeviceClock()
    late = [clock.place(t, 102 * S + t) for t in range(0, S, STEP)]
    clock.reopened()
    soon = [clock.place(t, 100 * S + t) for t in range(S, 2 * S, STEP)]
    times_ns = np.array([*late, *soon], dtype=np.int64)
    assert (np.diff(times_ns) > 0).all()
    assert np.diff(times_ns[len(late) :]) == pytest.approx(STEP, rel=0.002)
