"""The smoothing half of ``muster bench fusion``; targets are not asserted."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from base_station.fusion import FUSERS
from base_station.fusion.smoothing import SMOOTHERS
from tests.bench.fusion import smoothing_time
from tests.bench.fusion.command import WITHOUT
from tests.bench.fusion.kept_paths import PathKeeping, engine_evidence
from tests.bench.fusion.smoothing import SmoothingScores, tables_of
from tests.rig.incident.run import Timing, draw_incident, fuse

SHIFTED = "shown 5 m aside, everybody alike"
SHIFT_M = (3.0, -4.0)


@pytest.fixture(autouse=True)
def few_hours(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(smoothing_time, "UNITS", 1)  # an hour of each is timed


@pytest.fixture(scope="module")
def scores() -> SmoothingScores:
    rng = np.random.default_rng(11)
    people = draw_incident(rng)[:2]
    kind = PathKeeping(FUSERS[0])
    runs = [fuse(kind, person, Timing(), with_plan=False) for person in people]
    evidence = kind.evidence(runs) | engine_evidence(people[0])
    scores = SmoothingScores(SMOOTHERS[0])
    scores.note(WITHOUT, people, runs, evidence, rng)
    for person, run in zip(people, runs, strict=True):
        run.places_m = person.truth.place_m[:, :2] + SHIFT_M
    scores.note(SHIFTED, people, runs, evidence, rng)
    return scores


@pytest.mark.slow
def test_recording_changes_nothing(scores: SmoothingScores) -> None:
    person = draw_incident(np.random.default_rng(11))[0]
    plain = fuse(FUSERS[0], person, Timing(), with_plan=False)
    recorded = fuse(PathKeeping(FUSERS[0]), person, Timing(), with_plan=False)
    assert np.array_equal(plain.places_m, recorded.places_m)


@pytest.mark.slow
def test_smoothed_trail_is_better_and_pins_help(scores: SmoothingScores) -> None:
    report = scores.report(seed=1)
    live, smoothed = report.live_mean_m[WITHOUT], report.smoothed_mean_m[WITHOUT]
    assert smoothed["inside"] < live["inside"]
    after_m = list(report.pin_after_m[WITHOUT].values())
    assert after_m == sorted(after_m, reverse=True)
    assert max(after_m) < report.pin_before_m[WITHOUT]
    assert 0.5 < report.held_95[WITHOUT]["inside"] <= 1.0
    assert min(report.times_s.values()) > 0.0
    assert len(tables_of(report)) == 2


@pytest.mark.slow
def test_relative_errors_exclude_the_common_part(scores: SmoothingScores) -> None:
    report = scores.report(seed=1)
    assert report.live_mean_m[SHIFTED]["inside"] == pytest.approx(5.0)
    assert report.live_relative_m[SHIFTED]["inside"] == pytest.approx(0.0, abs=1e-9)
    assert report.live_relative_m[WITHOUT]["inside"] > 0.1
    relative_m = report.smoothed_relative_m[WITHOUT]["inside"]
    assert 0.05 < relative_m < report.smoothed_mean_m[WITHOUT]["inside"]


@pytest.mark.slow
def test_scores_added_to_none_are_the_same(scores: SmoothingScores) -> None:
    added = SmoothingScores(SMOOTHERS[0])
    added.add(scores)
    plain, copied = scores.report(seed=1), added.report(seed=1)
    assert copied == replace(plain, times_s=copied.times_s)
