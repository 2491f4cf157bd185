"""``muster bench motions``: no kind of motion is used to choose the constants it is scored by."""

from __future__ import annotations

import pytest

from tests.bench.tracker.motions import (
    MOST_CHANGES,
    TUNED,
    LeftOutMotion,
    Outcome,
    Study,
    changed_config,
    leave_each_out,
    left_out_table,
    tune,
)

FIRST, SECOND, THIRD = TUNED[:3]


class KnownStudy(Study):
    """Errors (m) by constant, factor and motion; those of several constants multiply."""

    def __init__(self, factors, *, silent=()):
        super().__init__({"walking": (), "running": (), "crawling": ()})
        self._factors = factors
        self._silent = silent

    def outcomes(self, changes, motion):
        error_m = 1.0
        for change in changes.items():
            error_m *= self._factors.get((*change, motion), 1.0)
        silent = any(change in self._silent for change in changes.items())
        return [Outcome(error_m, 0.95, 1.0, silent)]


def test_motion_is_scored_with_the_choice_of_the_others():
    good_for_runs = {(FIRST, 2.0, "running"): 0.1, (FIRST, 2.0, "walking"): 1.5}
    good_for_all = {(SECOND, 0.5, motion): 0.8 for motion in ("walking", "running", "crawling")}
    results = {one.motion: one for one in leave_each_out(KnownStudy(good_for_runs | good_for_all))}
    assert results["running"].changes == {SECOND: 0.5}
    assert results["walking"].changes == {FIRST: 2.0, SECOND: 0.5}
    assert results["walking"].tuned[0].error_m == pytest.approx(1.2)
    assert results["walking"].shipped[0].error_m == 1.0


def test_constant_with_silent_failures_is_not_chosen():
    better = {(FIRST, 2.0, "running"): 0.1, (SECOND, 2.0, "running"): 0.5}
    study = KnownStudy(better, silent={(FIRST, 2.0)})
    assert tune(study, ["running", "walking"]) == {SECOND: 2.0}


def test_errors_below_a_centimetre_choose_nothing_and_few_constants_change():
    tiny = {(THIRD, 2.0, "walking"): 1e-4}
    assert tune(KnownStudy(tiny | {(FIRST, 0.5, "walking"): 0.01}), ["walking"]) == {FIRST: 0.5}
    many = {(name, 2.0, "walking"): 0.9 for name in TUNED}
    assert len(tune(KnownStudy(many), ["walking"])) == MOST_CHANGES


def test_changes_are_applied_together_and_shown():
    config = changed_config({FIRST: 2.0, SECOND: 0.5})
    shipped = changed_config({})
    for name, factor in ((FIRST, 2.0), (SECOND, 0.5), (THIRD, 1.0)):
        part, parameter = name.split(".")
        value = getattr(getattr(shipped, part), parameter)
        assert getattr(getattr(config, part), parameter) == pytest.approx(factor * value)
    outcomes = [Outcome(0.2, None, None, silent=False)]
    table = left_out_table([LeftOutMotion("walking", 1, {}, outcomes, outcomes)])
    assert [next(iter(column.cells)) for column in table.columns][2:4] == [
        "the shipped",
        "0.200 -> 0.200",
    ]
