"""Decimation: values of one a period are published all, more frequent ones are thinned."""

from __future__ import annotations

import numpy as np
import pytest

from edge.agent.decimation import OncePerPeriod
from shared.clock import NS_PER_S


def taken(times: OncePerPeriod, t_s: np.ndarray) -> int:
    return sum(times.takes(round(t * NS_PER_S)) for t in t_s.tolist())


@pytest.mark.parametrize("first_s", [7.0, 7.25, 7.999])
def test_nothing_is_lost_of_one_value_a_period_with_jitter(first_s: float) -> None:
    late_s = np.random.default_rng(8).uniform(-0.2, 0.2, 300)
    assert taken(OncePerPeriod(1.0), first_s + np.arange(300) + late_s) == 300


@pytest.mark.parametrize("rate_hz", [2.0, 10.0, 60.0])
def test_one_value_a_period_is_taken_of_more_frequent_ones(rate_hz: float) -> None:
    t_s = 5.0 + np.arange(round(300 * rate_hz)) / rate_hz
    assert abs(taken(OncePerPeriod(1.0), t_s) - 300) <= 1


def test_decimation_continues_at_once_after_a_clock_that_went_back() -> None:
    times = OncePerPeriod(1.0)
    assert taken(times, 1000.0 + np.arange(10)) == 10
    assert taken(times, 3.0 + np.arange(10)) == 10
