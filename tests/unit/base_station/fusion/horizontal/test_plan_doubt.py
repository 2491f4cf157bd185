"""Estimate without walls joins that of the cloud as far as walls speak against the plan."""

from __future__ import annotations

import math

import numpy as np
import pytest

from base_station.fusion.horizontal.plan_doubt import (
    PRIOR_WITHOUT_PLAN,
    mixture,
    part_without_plan,
)


def test_plan_that_costs_nothing_is_not_doubted() -> None:
    assert part_without_plan(0.0) == 0.0
    assert part_without_plan(0.01) == 0.0


def test_doubt_grows_with_the_likelihood_that_walls_cost() -> None:
    parts = [part_without_plan(loss) for loss in (0.5, 1.0, 2.0, 4.0, 8.0, 300.0)]
    assert parts == sorted(parts)
    assert parts[0] < 0.02
    assert parts[-1] == pytest.approx(1.0)
    odds = PRIOR_WITHOUT_PLAN / (1.0 - PRIOR_WITHOUT_PLAN) * math.exp(4.0)
    posterior = odds / (1.0 + odds)
    assert parts[3] == pytest.approx((posterior - 0.02) / 0.98)


def test_mixture_has_the_moments_of_what_is_drawn_from_both() -> None:
    rng = np.random.default_rng(2)
    one = np.array([1.0, 2.0]), np.array([[1.0, 0.3], [0.3, 0.5]])
    other = np.array([-2.0, 0.5]), np.array([[0.1, 0.0], [0.0, 0.2]])
    drawn = np.concatenate(
        [rng.multivariate_normal(*one, 60_000), rng.multivariate_normal(*other, 140_000)]
    )
    mean, covariance = mixture(0.3, one, other)
    assert mean == pytest.approx(drawn.mean(axis=0), abs=0.02)
    assert covariance == pytest.approx(np.cov(drawn.T), abs=0.04)
