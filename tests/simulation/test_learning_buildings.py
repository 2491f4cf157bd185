"""A building learnt from all paths improves all, and harms none elsewhere."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
import pytest

from base_station.fusion.building_model.building import LearntBuilding
from base_station.fusion.interface import Estimate, Fuser, FuserKind, PlaceFix, Start
from shared.geo import wrap_pi
from shared.messages import Header
from tests.bench.fusion.simulated_walks import Floats, Receiver, Scores, Walk
from tests.rig import message_factory
from tests.rig.incident.run import (
    Known,
    Person,
    Run,
    Timing,
    draw_incident,
    fuse,
    fuse_all,
)
from tests.rig.incident.scores import CHI2_95_2DOF

SEEDS = range(12)
INCIDENTS = range(8001, 8007)


def test_shared_building_model_corrects_every_unit(kind: FuserKind) -> None:
    """Over several incidents: the errors of all who learn together are largely one error, so
    one incident says of what is stated hardly more than one person at one moment would.
    """
    alone, together, held = [], [], []
    for seed in INCIDENTS:
        people = draw_incident(np.random.default_rng(seed))
        apart = [fuse(kind, person, Timing(), with_plan=False) for person in people]
        alone.append(_inside(people, apart)[0])
        off_m, normalised2 = _inside(people, fuse_all(kind, people, Timing(), Known(plan=False)))
        together.append(off_m)
        held.append(normalised2 < CHI2_95_2DOF)
    assert np.concatenate(together).mean() < 0.8 * np.concatenate(alone).mean()
    assert np.percentile(np.concatenate(together), 95) < 5.0
    assert np.concatenate(held).mean() > 0.85


def test_building_without_right_angles_costs_no_accuracy(kind: FuserKind) -> None:
    """People wander about; for two minutes with fixes, then for three without."""
    with_it, without, held = [], [], []
    for seed in SEEDS:
        rng = np.random.default_rng(seed)
        walk, receiver = Walk.wander(rng, 300.0), Receiver(rng)
        learning, plain, learnt = kind.new(), kind.new(), LearntBuilding()
        scores = Scores()
        for index in range(len(walk)):
            t_s = float(walk.t_s[index])
            position = walk.position(index)
            learning.predict(position)
            plain.predict(position)
            learnt = learning.match_building(learnt)
            if index % 5 == 0 and t_s < 120.0:
                fix = receiver.fix(t_s, walk.truth_m[index])
                learning.update_gnss(fix)
                plain.update_gnss(fix)
            scores.note(learning, walk.truth_m[index])
        with_it.append(scores.error_m[-1])
        held += scores.normalised2[-500:]
        without.append(_off_m(plain, walk))
    assert np.mean(with_it) < 1.2 * np.mean(without)
    assert np.mean(np.array(held) < CHI2_95_2DOF) > 0.9


@pytest.mark.parametrize("seed", [62014, 91052])
def test_heading_is_not_turned_to_walls_that_the_path_does_not_follow(
    kind: FuserKind, seed: int
) -> None:
    """Incidents in which somebody crosses rooms as often as not, and somebody is long without a
    known heading: legs that fitted a wrong wall led them 10 m astray, and surely.
    """
    people = draw_incident(np.random.default_rng(seed))
    for person, run in zip(
        people, fuse_all(kind, people, Timing(), Known(plan=False)), strict=True
    ):
        errors_m, normalised2 = _inside([person], [run])
        assert np.percentile(errors_m, 95) < 6.0
        assert np.median(normalised2) < 10.6  # chi-square of 2 degrees of freedom, 99.5 %


@pytest.mark.parametrize("angle_deg", [10.0, 20.0, 30.0, 45.0])
def test_walls_of_another_building_turn_no_heading(kind: FuserKind, angle_deg: float) -> None:
    """Fixes on the way there told the heading, which is right to the last digit."""
    estimates = list(_through_two_buildings(kind.new(), 60, math.radians(angle_deg)))
    off_rad = [abs(wrap_pi(one.heading_rad)) for one in estimates]
    assert max(off_rad) < math.radians(4.0)
    assert estimates[-1].heading_std_rad < math.radians(6.0), "these walls hold it, too"


@pytest.mark.parametrize("angle_deg", [30.0, 45.0])
def test_walls_of_a_rotated_wing_increase_the_heading_uncertainty(
    kind: FuserKind, angle_deg: float
) -> None:
    """Nothing else tells that it is not the heading that was turned."""
    estimates = list(_through_two_buildings(kind.new(), 0, math.radians(angle_deg)))
    off_rad = [abs(wrap_pi(one.heading_rad)) for one in estimates]
    assert max(off_rad) < math.radians(4.0)
    assert estimates[-1].heading_std_rad > math.radians(0.4 * angle_deg)


@pytest.mark.parametrize("is_stated", [True, False], ids=["a start is said", "nothing is"])
def test_unit_without_a_known_frame_teaches_no_axis(kind: FuserKind, is_stated: bool) -> None:
    """Rooms round and round, and nothing says where the own frame lies."""
    fuser, learnt, place = kind.new(), LearntBuilding(), 0j
    if is_stated:
        fuser.start(Start(0.0, 0.0, 0.0, 0.0, 0.5, 0.03))
    for row in range(600):
        place += 0.5 * 1j ** (row // 12)
        header = Header("FF-01", 1, row + 1, message_factory.mono_ns(0.5 * row))
        north_m, east_m, way_m = place.real, place.imag, 0.5 * row
        fuser.predict(
            message_factory.position(header, north_m=north_m, east_m=east_m, distance_m=way_m)
        )
        learnt = fuser.match_building(learnt)
    assert (learnt.axis is not None) is is_stated


def _through_two_buildings(fuser: Fuser, outside_m: int, angle_rad: float) -> Iterator[Estimate]:
    """Estimates of a path round rooms in one building, outside, and round rooms in another whose
    walls stand at an angle; the own heading is given as 0, so that the fused one is how far off it
    is believed to be.
    """
    rounds = [side * math.pi / 2.0 for side in range(4)] * 8
    ways = [(direction_rad, 12, False) for direction_rad in rounds]
    ways += [(0.0, 2 * outside_m, True)] if outside_m else []
    ways += [(direction_rad + angle_rad, 12, False) for direction_rad in rounds]
    fuser.start(Start(0.0, 0.0, 0.0, 0.0, 0.5, 0.03))
    place, learnt, row = 0j, LearntBuilding(), 0
    for direction_rad, steps, fixed in ways:
        for _ in range(steps):
            place, row = place + 0.5 * np.exp(1j * direction_rad), row + 1
            header = Header("FF-01", 1, row, message_factory.mono_ns(0.5 * row))
            north_m, east_m, way_m = float(place.real), float(place.imag), 0.5 * row
            position = message_factory.position(
                header, north_m=north_m, east_m=east_m, distance_m=way_m, heading_std_rad=0.03
            )
            fuser.predict(position)
            learnt = fuser.match_building(learnt)
            if fixed:
                fuser.update_gnss(PlaceFix(header.t_mono_ns, north_m, east_m, 0.0, 1.5, None))
            estimate = fuser.estimate()
            assert estimate is not None
            yield estimate


def _inside(people: Sequence[Person], runs: Sequence[Run]) -> tuple[Floats, Floats]:
    """Errors, m, and squared normalised ones, of all who have been inside for five minutes."""
    errors, normalised2 = [], []
    for person, run in zip(people, runs, strict=True):
        truth = person.truth
        rows = (truth.t_s > truth.goes_in_s + 300.0) & (truth.t_s < truth.comes_out_s)
        off_m = run.places_m[rows] - truth.place_m[rows, :2]
        errors.append(np.hypot(off_m[:, 0], off_m[:, 1]))
        normalised2.append(run.normalised2[rows])
    return np.concatenate(errors), np.concatenate(normalised2)


def _off_m(fuser: Fuser, walk: Walk) -> float:
    scores = Scores()
    scores.note(fuser, walk.truth_m[-1])
    return scores.error_m[-1]
