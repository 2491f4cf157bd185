"""Strides that are none of a usual walk are doubted, and the stated region holds them."""

from __future__ import annotations

import pytest

from edge.simulation.scenarios import SCENARIOS
from tests.bench.tracker import simulated_body_sensors
from tests.bench.tracker.simulated_body_sensors import measure_simulated_elsewhere

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("name", ["careful-steps", "changing-gaits", "straight"])
def test_stated_region_holds_what_is_no_usual_walk(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(simulated_body_sensors, "TRACKERS", ())
    monkeypatch.setattr(simulated_body_sensors, "PLACES", ("chest", "shank"))
    (scenario,) = (one for one in SCENARIOS if one.name == name)
    (scored,) = measure_simulated_elsewhere([scenario])
    assert scored.tracker == "torso_shank"
    assert (scored.score.coverage_95_from_start or 0.0) > 0.92
