"""Comparison of places on the body on simulated walks: every tracker at its places, and its
tables.
"""

from __future__ import annotations

import pytest
from rich.console import Console

from edge.simulation.legs import Walk
from edge.simulation.scenario import Scenario
from edge.tracker.interface import FOOT
from edge.tracker.registry import TRACKERS
from tests.bench.tracker.simulated_body_sensors import (
    ate_share,
    measure_simulated_elsewhere,
    scenarios_table,
    simulated_elsewhere_table,
)


@pytest.mark.slow
def test_every_tracker_without_a_foot_walks_with_a_sensor_at_each_place() -> None:
    out_and_back = Scenario("out-and-back", "", (Walk(((12.0, 0.0), (12.0, 4.0), (0.0, 0.0))),))
    results = measure_simulated_elsewhere([out_and_back], lasts_s=25.0)
    expected = {
        (entry.name, (place,))
        for entry in TRACKERS
        if FOOT not in entry.worn_on
        for place in entry.worn_on
    }
    assert {(one.tracker, one.places) for one in results} == {
        *expected,
        ("torso_shank", ("chest", "shank")),
    }
    assert all(0.0 < ate_share(one) < 0.15 for one in results)
    console = Console(width=300, record=True, quiet=False)
    console.print(simulated_elsewhere_table(results))
    console.print(scenarios_table(results))
    text = console.export_text()
    assert "chest, shank: torso_shank" in text
    assert "out-and-back" in text
