"""Place on the body of a simulated sensor: by its source, else by the unit's settings."""

from __future__ import annotations

import logging
from itertools import islice
from pathlib import Path

import pytest

from edge.app.opened_sources import open_sources
from edge.body_places import PLACES
from edge.config import EdgeConfig, SensorConfig
from edge.simulation.factory import SEGMENTS
from edge.sources.interface import Source
from edge.sources.simulated import SimulatedSource
from shared.errors import ConfigError

WALK = "straight?seed=3"


def samples(source: Source) -> bytes:
    """First five seconds: stands, and walks off."""
    imus = [batch.imu for batch in islice(source.batches(), 100)]
    return b"".join(imu.accel_mps2.tobytes() + imu.gyro_radps.tobytes() for imu in imus)


def unit(source: str, worn_on: str = "") -> bytes:
    return samples(open_sources(EdgeConfig(source, worn_on=worn_on)))


def at(segment: str) -> bytes:
    return samples(SimulatedSource(f"{WALK}&worn_on={segment}"))


@pytest.mark.parametrize("place", [place for place in PLACES if PLACES[place] in SEGMENTS])
def test_motion_is_that_of_the_place_that_is_set(
    place: str, caplog: pytest.LogCaptureFixture
) -> None:
    assert unit(f"simulated:{WALK}", place) == at(PLACES[place])
    assert not caplog.records


def test_motion_is_the_scenarios_where_no_place_is_set(tmp_path: Path) -> None:
    assert unit(f"simulated:{WALK}") == at("foot")
    scenario = tmp_path / "own.toml"
    scenario.write_text('worn_on = "hip"\nlegs = [{type = "walk", to = [[20.0, 0.0]]}]\n')
    own = f"simulated:{scenario}"
    of_hip, of_chest = unit(f"{own}?worn_on=hip"), unit(f"{own}?worn_on=chest")
    assert of_hip != of_chest
    assert unit(own) == of_hip
    assert unit(own, "chest") == of_chest


def test_contradicting_place_in_the_source_is_simulated_and_reported(
    caplog: pytest.LogCaptureFixture,
) -> None:
    with caplog.at_level(logging.WARNING):
        assert unit(f"simulated:{WALK}&worn_on=waist", "chest") == at("waist")
    (record,) = caplog.records
    assert "motion at waist" in record.getMessage()
    assert "one at chest" in record.getMessage()


def test_same_place_in_the_source_is_not_reported(caplog: pytest.LogCaptureFixture) -> None:
    assert unit(f"simulated:{WALK}&worn_on=waist", "lower_back") == at("waist")
    assert not caplog.records


def test_place_without_a_simulated_motion_is_refused_unless_the_source_has_one() -> None:
    with pytest.raises(ConfigError, match=r"can be simulated at hand.*worn_on=chest"):
        unit(f"simulated:{WALK}", "hand")
    in_hand = SensorConfig("hand", f"simulated:{WALK}")
    with pytest.raises(ConfigError, match="can be simulated at hand"):
        open_sources(EdgeConfig(sensors=(in_hand,)))
    assert unit(f"simulated:{WALK}&worn_on=chest", "hand") == at("chest")


def test_text_without_a_scenario_is_explained_as_before() -> None:
    with pytest.raises(ConfigError, match="nothing after simulated:"):
        unit("simulated:", "chest")


def test_other_sources_are_opened_as_they_are_named(tmp_path: Path) -> None:
    with pytest.raises(ConfigError) as caught:
        unit("recordin:walk", "chest")
    assert "recordin:walk" in str(caught.value)
    assert "worn_on" not in str(caught.value)
