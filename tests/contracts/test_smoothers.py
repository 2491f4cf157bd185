"""Contract of every smoother in ``SMOOTHERS``."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from base_station.fusion.interface import Start
from base_station.fusion.odometry.path_history import PathHistory
from base_station.fusion.smoothing import SMOOTHERS
from base_station.fusion.smoothing.interface import (
    EncounterConstraint,
    PositionConstraint,
    SmoothedPath,
    Smoother,
    UnitEvidence,
)
from tests.bench.fusion.simulated_walks import RATE_HZ, Receiver, Walk

CHI2_2_95 = 5.991
Floats = NDArray[np.float64]


@pytest.fixture(params=SMOOTHERS, ids=lambda smoother: smoother.name)
def smoother(request: pytest.FixtureRequest) -> Smoother:
    found: Smoother = request.param
    return found


def evidence_of(
    walk: Walk,
    seed: int,
    fixes_s: Sequence[tuple[float, float]] = (),
    restart_s: float = math.inf,
    **more: object,
) -> UnitEvidence:
    """Evidence that a station keeps of a walk; the unit's program restarts at ``restart_s``."""
    history, receiver = PathHistory(), Receiver(np.random.default_rng(seed))
    for row in range(len(walk)):
        t_s = float(walk.t_s[row])
        position = walk.position(row, boot_id=1 if t_s < restart_s else 2)
        history.append(position, position.header.t_mono_ns, jumped=False)
        if row % RATE_HZ == 0 and any(begin <= t_s < end for begin, end in fixes_s):
            fix = receiver.fix(t_s, walk.truth_m[row])
            history.fix(fix, fix.t_mono_ns)
    return UnitEvidence(history.arrays(), **({"start": None} | more))  # type: ignore[arg-type]


def truth_at(walk: Walk, t_ns: NDArray[np.int64]) -> Floats:
    own_t_ns = [walk.position(row).header.t_mono_ns for row in range(len(walk))]
    return np.column_stack([np.interp(t_ns, own_t_ns, walk.truth_m[:, axis]) for axis in (0, 1)])


def errors_of(walk: Walk, path: SmoothedPath) -> Floats:
    places = np.column_stack((path.north_m, path.east_m))
    errors: Floats = np.linalg.norm(places - truth_at(walk, path.t_ns), axis=1)
    return errors


def pin_at(walk: Walk, t_s: float, off_m: float = 0.0, name: str = "pin") -> PositionConstraint:
    row = int(np.searchsorted(walk.t_s, t_s))
    north_m, east_m = walk.truth_m[row]
    t_ns = walk.position(row).header.t_mono_ns
    return PositionConstraint(name, t_ns, float(north_m) + off_m, float(east_m), 0.5)


def a_walk(seed: int, lasts_s: float = 300.0) -> Walk:
    return Walk.wander(np.random.default_rng(seed), lasts_s)


def test_smoother_names_are_those_of_the_log_and_unique() -> None:
    names = [smoother.name for smoother in SMOOTHERS]
    assert len(set(names)) == len(names)
    assert all(re.fullmatch(r"[a-z]+(-[a-z]+)*", name) for name in names)


def test_same_evidence_gives_the_same_trails(smoother: Smoother) -> None:
    evidence = {"a": evidence_of(a_walk(1), 1, [(0.0, 60.0)])}
    one, two = smoother.smooth(evidence), smoother.smooth(evidence)
    assert np.array_equal(one.paths["a"].north_m, two.paths["a"].north_m)
    assert np.array_equal(one.paths["a"].std_north_m, two.paths["a"].std_north_m)


@pytest.mark.slow
def test_every_point_has_a_place_and_an_honest_uncertainty(smoother: Smoother) -> None:
    held = []
    for seed in range(20):
        walk = a_walk(seed)
        solution = smoother.smooth({"a": evidence_of(walk, seed, [(0.0, 90.0), (240.0, 300.0)])})
        path = solution.paths["a"]
        columns = (path.north_m, path.east_m, path.down_m, path.std_down_m, path.turn_rad)
        assert all(np.isfinite(column).all() for column in columns)
        assert min(path.std_north_m.min(), path.std_east_m.min()) > 0.0
        assert np.abs(path.correlation_ne).max() <= 1.0
        off = np.column_stack((path.north_m, path.east_m)) - truth_at(walk, path.t_ns)
        product = path.correlation_ne * path.std_north_m * path.std_east_m
        for row in range(0, len(off), 10):
            spread = np.array(
                [
                    [path.std_north_m[row] ** 2, product[row]],
                    [product[row], path.std_east_m[row] ** 2],
                ]
            )
            held.append(float(off[row] @ np.linalg.solve(spread, off[row])) < CHI2_2_95)
    assert np.mean(held) > 0.85


@pytest.mark.slow
def test_fixes_at_both_ends_correct_the_middle(smoother: Smoother) -> None:
    one_end: list[float] = []
    both_ends: list[float] = []
    for seed in range(5):
        walk = a_walk(seed, 400.0)
        for fixes_s, errors in (
            ([(0.0, 60.0)], one_end),
            ([(0.0, 60.0), (340.0, 400.0)], both_ends),
        ):
            path = smoother.smooth({"a": evidence_of(walk, seed, fixes_s)}).paths["a"]
            errors.append(float(errors_of(walk, path).mean()))
    assert np.mean(both_ends) < np.mean(one_end)


@pytest.mark.parametrize("heading_std_rad", [0.05, math.pi])
def test_start_and_pins_suffice(smoother: Smoother, heading_std_rad: float) -> None:
    walk = a_walk(3)
    north_m, east_m = (walk.truth_m[0] - _turned(walk.own_m[0], walk.turn_rad)).tolist()
    start = Start(north_m, east_m, 0.0, walk.turn_rad, 0.5, heading_std_rad)
    places = (pin_at(walk, 150.0), pin_at(walk, 290.0, name="other"))
    evidence = evidence_of(walk, 3, start=start, places=places)
    solution = smoother.solve({"a": evidence})
    assert errors_of(walk, solution.paths["a"]).mean() < 2.0
    assert {name: verdict.used for name, verdict in solution.verdicts.items()} == {
        "pin": True,
        "other": True,
    }


def test_contradicting_pin_is_reported_and_changes_nothing(smoother: Smoother) -> None:
    walk = a_walk(4)
    good = evidence_of(walk, 4, [(0.0, 60.0)], places=(pin_at(walk, 200.0),))
    bad = replace(good, places=(*good.places, pin_at(walk, 250.0, off_m=150.0, name="bad")))
    without, with_bad = smoother.solve({"a": good}), smoother.solve({"a": bad})
    assert np.allclose(without.paths["a"].north_m, with_bad.paths["a"].north_m)
    verdict = with_bad.verdicts["bad"]
    assert not verdict.used
    assert verdict.residual_m == pytest.approx(150.0, abs=15.0)
    assert verdict.sigmas > 4.0


def test_walls_of_the_live_estimate_are_used_and_a_pin_overrules_them(smoother: Smoother) -> None:
    """The live estimate was surer than the path alone can be; the second time, wrongly so."""
    walk = a_walk(10)
    plain = evidence_of(walk, 10, [(0.0, 40.0)])
    sure = {"shown_std_m": np.full(len(plain.path), 0.3)}
    truth = truth_at(walk, plain.path.t_ns)
    right = replace(plain, path=replace(plain.path, shown_m=truth, **sure))
    wrong = replace(plain, path=replace(plain.path, shown_m=truth + np.array([0.0, 3.0]), **sure))
    pinned = replace(wrong, places=(pin_at(walk, 200.0),))
    alone = replace(plain, places=pinned.places)
    reported = {"plain": plain, "right": right, "pinned": pinned, "alone": alone}
    errors = {
        name: errors_of(walk, smoother.solve({"a": evidence}).paths["a"])[-60:].mean()
        for name, evidence in reported.items()
    }
    assert errors["right"] < min(0.6, errors["plain"])
    assert errors["pinned"] == pytest.approx(errors["alone"], abs=0.1)


def test_encounter_with_a_well_known_place_improves_the_other(smoother: Smoother) -> None:
    lost, known = a_walk(5), a_walk(6)
    meets = int(np.searchsorted(lost.t_s, 200.0))
    known.truth_m += lost.truth_m[meets] - known.truth_m[meets]
    evidence = {
        "lost": evidence_of(lost, 5, [(0.0, 30.0)]),
        "known": evidence_of(known, 6, [(0.0, 300.0)]),
    }
    encounter = EncounterConstraint(
        "met", "lost", "known", lost.position(meets).header.t_mono_ns, 0.5
    )
    alone, together = smoother.smooth(evidence), smoother.smooth(evidence, [encounter])
    row = int(np.searchsorted(alone.paths["lost"].t_ns, encounter.t_ns))
    before, after = (errors_of(lost, one.paths["lost"])[row] for one in (alone, together))
    assert after < max(before, 2.0)
    assert together.verdicts["met"].used


def test_path_continues_over_a_restart_of_the_unit(smoother: Smoother) -> None:
    """The odometry begins anew; fixes behind the restart place it."""
    walk = a_walk(7)
    half = len(walk) // 2
    walk.own_m[half:] -= walk.own_m[half]
    fixes_s = [(0.0, 60.0), (200.0, 300.0)]
    evidence = evidence_of(walk, 7, fixes_s, restart_s=float(walk.t_s[half]))
    errors = errors_of(walk, smoother.smooth({"a": evidence}).paths["a"])
    assert errors[-20:].mean() < 6.0


@pytest.mark.parametrize("points", [1, 2, 3])
def test_path_of_few_points_is_placed(smoother: Smoother, points: int) -> None:
    walk = a_walk(8, points / RATE_HZ)
    pin = pin_at(walk, float(walk.t_s[0]))
    solution = smoother.solve({"a": evidence_of(walk, 8, places=(pin,))})
    assert errors_of(walk, solution.paths["a"]).max() < 3.0


def test_last_point_is_the_present(smoother: Smoother) -> None:
    walk = a_walk(9)
    path = smoother.solve({"a": evidence_of(walk, 9, [(0.0, 100.0)])}).paths["a"]
    present = path.posterior
    assert present.mean[:2] == pytest.approx([path.north_m[-1], path.east_m[-1]])
    spread = np.array(present.covariance)
    assert np.allclose(spread, spread.T)
    assert np.linalg.eigvalsh(spread).min() > 0.0
    assert math.atan2(present.mean[3], present.mean[2]) == pytest.approx(path.turn_rad[-1])


def _turned(vector: Floats, turn_rad: float) -> Floats:
    cosine, sine = math.cos(turn_rad), math.sin(turn_rad)
    return np.array([cosine * vector[0] - sine * vector[1], sine * vector[0] + cosine * vector[1]])
