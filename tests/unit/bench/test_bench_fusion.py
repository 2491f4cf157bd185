"""``muster bench fusion`` measures the fuser beside simpler ones; targets are not asserted."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from base_station.fusion import FUSERS
from base_station.site.floor_grid import FloorGrid
from base_station.site.plan import read_plan
from base_station.site.wall_crossing import WALL
from shared.errors import UserError
from tests.bench.fusion import smoothing_time
from tests.bench.fusion.command import WITH_PLAN, bench_fusion
from tests.rig.incident.people import LASTS_S
from tests.rig.incident.run import Timing, draw_incident, fuse
from tests.rig.incident.scores import ASTRAY, ERROR_STAGES, HELD_STAGES, Scores


@pytest.fixture(scope="module")
def figures(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    file = tmp_path_factory.mktemp("bench") / "figures.json"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(smoothing_time, "UNITS", 1)  # an hour of each is timed
        bench_fusion(incidents=1, seed=3, json_file=file)
    found: dict[str, Any] = json.loads(file.read_text())
    return found


@pytest.mark.slow
def test_bench_writes_the_figures(figures: dict[str, Any]) -> None:
    assert figures["incidents"] == 1
    assert figures["ce50_m"][WITH_PLAN]["outside"] < figures["ce95_m"][WITH_PLAN]["outside"]


@pytest.mark.slow
def test_fuser_is_better_than_each_simpler_one(figures: dict[str, Any]) -> None:
    """The fuser is worth its cost only where the simpler ones are worse at all stages."""
    for way in ("fixes alone", "switching"):
        for stage, error_m in figures["ce95_m"][way].items():
            assert figures["ce95_m"][WITH_PLAN][stage] < error_m, f"{way}, {stage}"


@pytest.mark.slow
def test_same_seed_gives_the_same_errors() -> None:
    runs = []
    for _ in range(2):
        person = draw_incident(np.random.default_rng(3))[1]
        runs.append(fuse(FUSERS[0], person, Timing(), with_plan=True).places_m)
    assert np.array_equal(runs[0], runs[1])


def test_added_scores_are_those_of_all_people_together() -> None:
    people = draw_incident(np.random.default_rng(3))[:2]
    all_of_them, added = Scores(), Scores()
    for number, person in enumerate(people):
        truth, one = person.truth, Scores()
        off_m = np.linspace(0.0, 6.0 + number, len(truth.t_s))
        for scores in (all_of_them, one):
            scores.note(truth, truth.place_m[:, :2] + off_m[:, None], off_m**2)
        added.add(one)
    assert added.seams_m == all_of_them.seams_m
    for stage in ERROR_STAGES:
        assert added.ce_m(stage, 50.0) == all_of_them.ce_m(stage, 50.0)
    for stage in HELD_STAGES:
        assert added.held_95(stage) == all_of_them.held_95(stage)
    for how in ASTRAY:
        assert added.part_astray(how) == all_of_them.part_astray(how)


def test_simulated_people_walk_twenty_minutes_and_through_no_wall() -> None:
    for person in draw_incident(np.random.default_rng(4)):
        truth, building = person.truth, person.building
        assert truth.t_s[-1] == pytest.approx(LASTS_S, abs=1.0)
        assert truth.goes_in_s + 600.0 < truth.comes_out_s
        exact = replace(building, drawn_walls=building.walls, plan_off_m=(0.0, 0.0))
        grid = FloorGrid.of(read_plan(exact.geojson()))
        assert grid is not None
        floors = -truth.place_m[:, 2] / building.storey_m
        level = np.abs(floors - np.rint(floors)) < 0.05
        for floor in range(4):
            rows = np.flatnonzero(level[1:] & (np.rint(floors[1:]) == floor))
            from_m, to_m = truth.place_m[rows, :2], truth.place_m[rows + 1, :2]
            assert (grid.crossings(floor, from_m, to_m) < WALL).all()


def test_trials_without_their_tracks_are_an_error(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="--tracks"):
        bench_fusion(walks=tmp_path)
    with pytest.raises(UserError, match="--walks"):
        bench_fusion(tracks=tmp_path)
