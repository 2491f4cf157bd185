"""People of simulated incidents whose units track them, by published positions."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from edge.simulation.scenario import read_scenario
from edge.simulation.simulation import Simulation
from shared.errors import UserError
from shared.messages import Header
from shared.published_walk import PublishedWalk, read_walk, write_walk
from shared.quality import Reason
from tests.bench.tracker.published import bench_published
from tests.rig import message_factory
from tests.rig.incident.building import draw_building
from tests.rig.incident.people import RATE_HZ, WALK_MPS, Script, draw_engine, live_through
from tests.rig.incident.tracked import scenario_of, tracked_walks


def test_a_walk_is_read_as_it_was_written(tmp_path: Path) -> None:
    positions = [
        message_factory.position(
            Header("", 1, row + 1, 0), north_m=0.5 * row, reasons=Reason.NO_STANCE
        )
        for row in range(3)
    ]
    walk = PublishedWalk(np.array([0.0, 0.5, 1.0]), np.arange(9.0).reshape(3, 3), positions)
    write_walk(tmp_path / "walk.csv", walk)
    again = read_walk(tmp_path / "walk.csv")
    assert np.array_equal(again.t_s, walk.t_s)
    assert np.array_equal(again.truth_m, walk.truth_m)
    for one, other in zip(again.positions, positions, strict=True):
        assert (one.north_m, one.std_north_m) == (other.north_m, other.std_north_m)
        assert (one.quality, one.reasons) == (other.quality, other.reasons)


def test_a_script_is_a_scenario_of_the_simulator_that_comes_to_the_same_places(
    tmp_path: Path,
) -> None:
    rng = np.random.default_rng(5)
    building = draw_building(rng)
    script = live_through(rng, building, draw_engine(rng, building), from_engine=False)
    (tmp_path / "one.toml").write_text(scenario_of(script, rng), encoding="utf-8")
    simulation = Simulation(read_scenario(tmp_path / "one.toml"), 1)
    place_m = simulation.truth(np.arange(0.0, simulation.duration_s, 0.5)).position_n_m
    for move in script.moves[::20]:
        assert np.linalg.norm(place_m - np.array(move.to_m), axis=1).min() < 1.0
    assert place_m[:, 2].min() == pytest.approx(min(m.to_m[2] for m in script.moves), abs=0.3)


@pytest.mark.slow
def test_people_are_tracked_by_their_units(tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    building = draw_building(rng)
    scripts = []
    for from_engine in (True, False, True):
        script = Script(rng, (-20.0, building.entrance_east_m), from_engine=from_engine)
        script.go((4.0, building.entrance_east_m), WALK_MPS)
        script.go((-10.0, building.entrance_east_m), WALK_MPS)
        scripts.append(script)
    walks = tracked_walks(rng, scripts, building)
    assert len({len(walk.published) for walk in walks}) == 1
    for walk, script in zip(walks, scripts, strict=True):
        truth = walk.truth
        assert truth.from_engine is script.from_engine
        assert truth.goes_in_s < truth.comes_out_s
        assert np.allclose(np.diff(truth.t_s), 1.0 / RATE_HZ)
        own = np.array([complex(one.north_m, one.east_m) for one in walk.published])
        true = truth.place_m[:, 0] + 1j * truth.place_m[:, 1]
        off_m = np.abs((own - own[0]) * np.exp(1j * walk.turn_rad) - (true - true[0]))
        assert off_m.max() < 1.5


def test_a_folder_that_is_missing_is_named(tmp_path: Path) -> None:
    scenario = tmp_path / "one.toml"
    scenario.write_text('[[legs]]\ntype = "stand"\nduration_s = 1.0\n', encoding="utf-8")
    with pytest.raises(UserError, match="is no folder"):
        bench_published([scenario], tmp_path / "missing")
