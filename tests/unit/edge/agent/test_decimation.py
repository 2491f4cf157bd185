"""What comes once a period is published whole, and what comes more often is thinned."""

from __future__ import annotations

import numpy as np
import pytest

from edge.agent.decimation import OncePerPeriod
from shared.clock import NS_PER_S


def taken(times: OncePerPeriod, t_s: np.ndarray) -> int:
    return sum(times.takes(round(t * NS_PER_S)) for t in t_s.tolist())


@pytest.mark.parametrize("first_s", [7.0, 7.25, 7.999])
def test_nothing_is_lost_of_what_comes_once_a_period_and_not_on_the_dot(first_s: float) -> None:
    late_s = np.random.default_rng(8).uniform(-0.2, 0.2, 300)
    assert taken(OncePerPeriod(1.0), first_s + np.arange(300) + late_s) == 300


@pytest.mark.parametrize("rate_hz", [2.0, 10.0, 60.0])
def test_of_what_comes_more_often_one_a_period_is_taken(rate_hz: float) -> None:
    t_s = 5.0 + np.arange(round(300 * rate_hz)) / rate_hz
    assert abs(taken(OncePerPeriod(1.0), t_s) - 300) <= 1


def test_after_a_clock_that_went_back_it_goes_on_at_once() -> None:
    times = OncePerPeriod(1.0)
    assert taken(times, 1000.0 + np.arange(10)) == 10
    assert taken(times, 3.0 + np.arange(10)) == 10
