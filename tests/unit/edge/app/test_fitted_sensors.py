"""Settings of a unit take the place of what the source knows of its sensors."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

import pytest

from edge.app.fitted_sensors import fitted_sensors
from edge.config import EdgeConfig
from edge.samples import SensorDescription
from edge.sources.interface import Source


@dataclass(frozen=True)
class DescribedSource:
    """Source of one sensor, of which only the description is asked for."""

    description: SensorDescription


@pytest.mark.parametrize(
    ("described", "setting", "used"),
    [(None, None, None), (0.01, None, 0.01), (None, 0.002, 0.002), (0.01, 0.0, 1e-6)],
)
@pytest.mark.parametrize("name", ["gain_std", "gyro_bias_std_radps"])
def test_deviation_is_that_of_the_setting_else_of_the_source(
    name: str,
    described: float | None,
    setting: float | None,
    used: float | None,
    tmp_path: Path,
) -> None:
    of_source: dict[str, Any] = {name: described}
    of_settings: dict[str, Any] = {name: setting}
    source = DescribedSource(SensorDescription("telephone", 50.0, **of_source))
    config = EdgeConfig(source="x", **of_settings)
    (sensor,) = fitted_sensors(config, cast("Source", source), "u1", tmp_path)
    assert getattr(sensor.description, name) == used
