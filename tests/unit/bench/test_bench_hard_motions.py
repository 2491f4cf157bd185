"""The bench of simulated hard motions, on a short walk."""

from __future__ import annotations

import pytest

from edge.simulation.hard_motions import HARD_MOTIONS
from edge.simulation.legs import Stand, Walk
from edge.simulation.scenario import Scenario
from tests.bench.tracker.hard_motions import hard_motions_table, measure_hard_motions
from tests.conftest import PROJECT_ROOT
from tests.golden.documented_figures import read_table

SHORT = Scenario("short", "walks 8 m", (Stand(4.0), Walk(((8.0, 0.0),)), Stand(3.0)))


def test_ordinary_walk_ends_at_its_place_and_states_its_error():
    (found,) = measure_hard_motions("eskf", (SHORT,), range(2))
    assert (found.scenario, found.walks) == ("short", 2)
    assert 0.0 < found.horizontal_m < 0.3
    assert found.vertical_m < 0.1
    assert found.horizontal_m < 3.0 * found.horizontal_stated_m
    assert found.stated_by_error > 0.3
    assert found.silently_wrong == found.lost == 0.0
    assert hard_motions_table([found]).row_count == 1


def test_walk_that_the_tracker_misses_is_off_by_its_length():
    """``huang`` takes a leg in a brace for one that stands."""
    dragged = Scenario("drag", "", (Stand(4.0), Walk(((8.0, 0.0),), "drag"), Stand(3.0)))
    (found,) = measure_hard_motions("huang", (dragged,), range(1))
    assert found.horizontal_m > 2.0


@pytest.mark.parametrize("page", ["benchmarks.md"])
def test_every_hard_motion_is_documented(page):
    rows = read_table(PROJECT_ROOT / "docs" / page, "hard motion")
    assert [row["hard motion"].strip("`") for row in rows] == [one.name for one in HARD_MOTIONS]
