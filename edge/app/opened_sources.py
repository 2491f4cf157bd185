"""Sources of a unit's inertial sensors, opened as its settings say."""

from __future__ import annotations

from edge.config import EdgeConfig
from edge.sources.interface import Quantity, Source
from edge.sources.registry import open_sensor, open_sensors, source_kind


def open_sources(config: EdgeConfig) -> Source:
    """Open the source, or those of several sensors as one.  Raises ConfigError."""
    if config.source:
        return open_sensor(config.source, config.worn_on)
    return open_sensors(
        {sensor.name: sensor.source for sensor in config.sensors},
        {sensor.name: sensor.place for sensor in config.sensors},
    )


def provided_quantities(config: EdgeConfig) -> frozenset[Quantity]:
    """Return what the sources may give at most.  Raises ConfigError."""
    texts = [config.source] if config.source else [sensor.source for sensor in config.sensors]
    return frozenset().union(*(source_kind(text).gives for text in texts))
