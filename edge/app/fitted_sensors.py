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
            gain_std=_first_given(settings.gain_std, found.gain_std),
            gyro_bias_std_radps=_first_given(
                settings.gyro_bias_std_radps, found.gyro_bias_std_radps
            ),
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
    if len(names) > 1 and not config.sensors and config.has_settings_of_one_sensor:
        raise ConfigError(
            f"{config.source_text} has several sensors ({', '.join(names)}): give worn_on, mount, "
            "calibration, gain_std and gyro_bias_std_radps in a [[sensors]] of each name"
        )


def _first_given(setting: float | None, described: float | None) -> float | None:
    return described if setting is None else setting
