"""Sensors of a unit with their settings and calibrations."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from edge.agent.fitted_sensor import FittedSensor
from edge.app.calibration_in_use import calibration_in_use
from edge.config import EdgeConfig
from edge.sample_codec.descriptions import sensor_of, unit_sensor
from edge.sources.interface import Source, sensors_in
from shared.errors import ConfigError


def fitted_sensors(
    config: EdgeConfig, source: Source, unit_id: str, used: Path
) -> tuple[FittedSensor, ...]:
    """Return the sensors of ``source`` as the wire gives their descriptions back.

    A copy of each calibration is kept with those that were ``used``.  Raises ConfigError.
    """
    sensors = sensors_in(source)
    _check_settings(config, tuple(sensors))
    fitted = []
    for name, found in sensors.items():
        settings = config.sensor(name)
        description = replace(
            found,
            place=settings.place or found.place,
            mount=settings.mount or found.mount,
            gain_std=found.gain_std if settings.gain_std is None else settings.gain_std,
        )
        calibration = calibration_in_use(settings.calibration, unit_id, description, used)
        fitted.append(FittedSensor(sensor_of(unit_sensor(name, description)), calibration, name))
    return tuple(fitted)


def _check_settings(config: EdgeConfig, names: tuple[str, ...]) -> None:
    """Raise ConfigError for settings of sensors that the source does not have."""
    unknown = [sensor.name for sensor in config.sensors if sensor.name not in names]
    if unknown:
        raise ConfigError(
            f"{config.source_text} has no sensor {unknown[0]!r}; it has "
            f"{', '.join(name or 'one without a name' for name in names)}"
        )
    if len(names) > 1 and not config.sensors and _has_settings_of_one(config):
        raise ConfigError(
            f"{config.source_text} has several sensors ({', '.join(names)}): give worn_on, mount, "
            "calibration and gain_std in a [[sensors]] of each name"
        )


def _has_settings_of_one(config: EdgeConfig) -> bool:
    given = config.worn_on, config.mount, config.calibration
    return any(given) or config.gain_std is not None
