"""Learning over walks: what they show of a person adds up, and never to more than a walk tells."""

from __future__ import annotations

import pytest

from edge.agent.step_learning import (
    UNKNOWN,
    WALK_STD,
    is_of_a_walk,
    learn,
    scale_by_length,
    start_scale,
)
from edge.tracker.body.config import BodyConfig
from edge.tracker.interface import StepScale
from shared.path_noise import PathNoise

EXACT = StepScale(1.15, 0.01)


def test_a_person_who_is_not_known_has_the_deviation_of_people():
    assert start_scale(UNKNOWN).std == pytest.approx(BodyConfig().scale_std, abs=0.001)
    assert start_scale(UNKNOWN).factor == 1.0


def test_a_walk_moves_the_scale_towards_what_it_shows():
    learnt = learn(None, EXACT)
    assert 1.1 < learnt.factor < 1.15
    assert learnt.std < UNKNOWN.std


def test_the_next_walk_is_never_known_better_than_walks_of_one_person_are_alike():
    learnt = None
    for _ in range(100):
        learnt = learn(learnt, EXACT)
    assert learnt is not None
    assert learnt.factor == pytest.approx(1.15, abs=0.001)
    assert start_scale(learnt).std > WALK_STD


def test_a_longer_walk_of_known_length_shows_more():
    short = scale_by_length(20.0, 18.0, None)
    long = scale_by_length(200.0, 180.0, None)
    assert short.factor == pytest.approx(long.factor)
    assert long.std < short.std < 0.06
    assert scale_by_length(20.0, 18.0, PathNoise(None, 0.05)).std < short.std


def test_a_poor_measurement_changes_little():
    assert abs(learn(None, StepScale(1.4, 0.5)).factor - 1.0) < 0.02


@pytest.mark.parametrize(("factor", "is_one"), [(0.2, False), (0.8, True), (1.2, True), (9, False)])
def test_scales_of_no_walk_are_known_as_such(factor, is_one):
    assert is_of_a_walk(factor) is is_one
